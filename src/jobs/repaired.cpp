#include "evenmesh/repaired.h"

#include <fmt/format.h>

#include <utility>

#include "core/parallel.h"
#include "evenmesh/error.h"

namespace evenmesh {
namespace {

/// The hull, decided.
Hull decide(Hull hull, Repaired& r, ExecutionContext& context) {
  if (hull != Hull::automatic) return hull;
  r.solidity = solidity(*r.shape.mesh(), context);
  r.wrapped_sheets = *r.solidity < min_solidity;
  return r.wrapped_sheets ? Hull::wrap : Hull::outer;
}

Repaired repair(const Shape& shape, Hull asked, const MeshOptions& options, ExecutionContext& context) {
  context.throw_if_cancelled();
  Repaired r;
  r.options = options;
  Mesh mesh = cleaned(*shape.mesh(), r.defects);
  if (mesh.triangles.empty()) throw UnusableInput(shape.name + " has no triangle with an area");
  r.shape = shape_from_mesh(std::move(mesh), shape.name);
  context.throw_if_cancelled();
  const Hull hull = decide(asked, r, context);
  context.throw_if_cancelled();
  if (hull == Hull::wrap) {
    r.options.wrap = true;
    r.options.method = Method::shell;
    return r;
  }
  r.shape = shape_from_mesh(holes_filled(*r.shape.mesh(), r.filled_holes), shape.name);
  r.options.method = Method::raster;
  r.options.fill_cavities = hull != Hull::all;
  if (hull == Hull::oriented) r.shape.winding = Winding::positive;
  return r;
}

}  // namespace

Repaired repaired(const Shape& shape, Hull hull, const MeshOptions& options, ExecutionContext& context) {
  if (!shape.mesh()) throw InvalidInput("repair takes a triangle mesh; other inputs have nothing to repair: use mesh");
  Repaired r = with_threads(context, [&] { return repair(shape, hull, options, context); });
  r.shape.unit = shape.unit;
  r.shape.findings = shape.findings;
  return r;
}

std::string summary_of(const MeshDefects& d) {
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(d.welded_vertices, "vertices welded");
  add(d.degenerate_triangles, "degenerate triangles left out");
  add(d.repeated_triangles, "repeated triangles left out");
  add(d.turned_triangles, "triangles turned");
  add(d.boundary_edges, "boundary edges");
  add(d.non_manifold_edges, "non-manifold edges");
  return text.empty() ? "no defects of connection" : text;
}

}  // namespace evenmesh
