#include "evenmesh/repaired.h"

#include <fmt/format.h>

#include <utility>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "geometry/mesh_parts.h"
#include "geometry/triangle.h"

namespace evenmesh {
namespace {

/// The hull, decided: closed parts are a solid, whatever lies beside them, unless that is more.
Hull decide(Hull hull, const Mesh& mesh, const MeshParts& parts, Repaired& r, ExecutionContext& context) {
  if (hull != Hull::automatic) return hull;
  const bool closed = !parts.solid.triangles.empty() && area_of(parts.solid) >= area_of(parts.sheets);
  r.solidity = solidity(closed ? parts.solid : mesh, context);
  r.wrapped_sheets = *r.solidity < min_solidity;
  return r.wrapped_sheets ? Hull::wrap : Hull::outer;
}

void fill(Mesh& mesh, const MeshParts& parts, Repaired& r) {
  if (!parts.solid.triangles.empty()) mesh = parts.solid;
  mesh = holes_filled(mesh, r.filled_holes);
  r.filled_holes += parts.filled_holes.size();
  if (!parts.filled_holes.empty()) r.largest_hole = {parts.filled_holes[0].middle, parts.filled_holes[0].size};
  if (parts.solid.triangles.empty()) return;
  // They are left out, and named, by mesh_shape().
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), parts.sheets.vertices.begin(), parts.sheets.vertices.end());
  for (const Triangle& t : parts.sheets.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

Repaired repair(const Shape& shape, Hull asked, const MeshOptions& options, ExecutionContext& context) {
  context.throw_if_cancelled();
  Repaired r;
  r.options = options;
  Mesh mesh = cleaned(*shape.mesh(), r.defects);
  if (mesh.triangles.empty()) throw UnusableInput(shape.name + " has no triangle with an area");
  context.throw_if_cancelled();
  const auto ask = [&](const Mesh& m) { return solidity(m, context); };
  const MeshParts parts = asked == Hull::wrap ? MeshParts{} : parts_of(mesh, false, ask, context);
  context.throw_if_cancelled();
  const Hull hull = decide(asked, mesh, parts, r, context);
  context.throw_if_cancelled();
  if (hull == Hull::wrap) {
    r.shape = shape_from_mesh(std::move(mesh), shape.name);
    r.options.wrap = true;
    r.options.method = Method::shell;
    r.options.fill_cavities = true;
    return r;
  }
  fill(mesh, parts, r);
  r.shape = shape_from_mesh(std::move(mesh), shape.name);
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
  add(d.wall_triangles, "triangles of walls between touching parts left out");
  add(d.turned_triangles, "triangles turned");
  add(d.boundary_edges, "boundary edges");
  add(d.non_manifold_edges, "non-manifold edges");
  return text.empty() ? "no defects of connection" : text;
}

}  // namespace evenmesh
