#include <algorithm>
#include <cmath>
#include <limits>

#include "connect/dual_polygons.h"
#include "evenmesh/error.h"
#include "geometry/half_edges.h"
#include "geometry/separate_umbrellas.h"
#include "pipeline/draft.h"
#include "refine/placement.h"

namespace evenmesh {
namespace {

/// Numbers the labels that triangles use, and places a vertex for each.
void make_vertices(const Tessellation& cells, const std::vector<Triangle>& triangles, const MeshOptions& options,
                   ExecutionContext& context, Draft& draft) {
  const auto shapes = cell_shapes(cells.sampling.surface(), cells.labels, cells.seeds, context);
  std::vector<std::uint32_t>& index = draft.vertex_of_label;
  index.assign(cells.seeds.size(), Draft::none);
  for (const Triangle& t : triangles)
    for (const std::uint32_t l : t) index[l] = 0;
  for (std::size_t l = 0; l < index.size(); ++l) {
    if (index[l] == Draft::none) continue;
    index[l] = static_cast<std::uint32_t>(draft.mesh.vertices.size());
    draft.planes.push_back({cells.seeds.positions[l], shapes[l].planes});
    draft.mesh.vertices.push_back(cells.seeds_are_vertices                  ? cells.seeds.positions[l]
                                  : options.placement == Placement::quadric ? shapes[l].vertex
                                                                            : shapes[l].centroid);
  }
  draft.mesh.triangles.reserve(triangles.size());
  for (const Triangle& t : triangles) draft.mesh.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
}

/// By vertex, before umbrellas were separated: whether it lies on the boundary.
std::vector<char> boundary_vertices(const Mesh& mesh, const std::vector<std::uint32_t>& source,
                                    ExecutionContext& context) {
  std::vector<char> on_boundary(mesh.vertices.size(), 0);
  const HalfEdges edges(mesh.triangles, mesh.vertices.size(), context);
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    if (edges.opposite(h) != HalfEdges::none) continue;
    const Triangle& t = mesh.triangles[h / 3];
    on_boundary[source[t[h % 3]]] = 1;
    on_boundary[source[t[(h + 1) % 3]]] = 1;
  }
  return on_boundary;
}

/// Places for the vertices of cells at the rim of sheets: the sample of the rim nearest to the mean of the cell's.
void find_boundary(const Tessellation& cells, const std::vector<char>& on_boundary, Draft& draft) {
  struct Rim {
    Vec3 sum, nearest;
    double count = 0, distance = std::numeric_limits<double>::infinity();
  };
  const SheetSampling& sheet = *cells.sampling.sheet;
  const SampleSet& set = sheet.on_surface;
  std::vector<Rim> rims(cells.seeds.size());
  const auto each = [&](const auto& use) {
    for (const SampleBlock& block : set.blocks)
      for (std::uint32_t i = block.begin; i < block.end; ++i)
        if (sheet.sheets.border[sheet.chosen[i]])
          use(rims[cells.labels[i]], set.block_center(block) + Vec3{set.x[i], set.y[i], set.z[i]});
  };
  each([](Rim& rim, const Vec3& p) {
    rim.sum += p;
    rim.count += 1;
  });
  each([](Rim& rim, const Vec3& p) {
    const double d = squared_norm(p - rim.sum / rim.count);
    if (d >= rim.distance) return;
    rim.distance = d;
    rim.nearest = p;
  });
  for (std::uint32_t l = 0; l < rims.size(); ++l) {
    const std::uint32_t v = draft.vertex_of_label[l];
    if (rims[l].count > 0 && v != Draft::none && on_boundary[v]) draft.boundary.push_back({v, rims[l].nearest});
  }
}

/// Vertices of seeds on feature curves go there, except where the solid was changed.
void constrain(const Tessellation& cells, Draft& draft) {
  const Seeds& fixed = cells.feature_seeds.seeds;
  if (fixed.size() == 0 && cells.features.apexes.empty()) return;
  VertexConstraints& constraints = draft.constraints;
  constraints.curve.assign(draft.mesh.vertices.size(), VertexConstraints::free);
  for (std::size_t l = 0; l < fixed.size(); ++l) {
    const Vec3& place = fixed.positions[l];
    const std::uint32_t v = draft.vertex_of_label[l];
    if (v == Draft::none || cells.balls.covers(place)) continue;
    const Attachment& on = fixed.fixed[l];
    constraints.curve[v] = on.kind == Attachment::Kind::corner ? VertexConstraints::corner : on.index;
    draft.mesh.vertices[v] = place;
  }
  for (const auto& [a, b] : cells.feature_seeds.edges) {
    const auto [v, w] = std::minmax(draft.vertex_of_label[a], draft.vertex_of_label[b]);
    if (w != Draft::none) constraints.edges.push_back({v, w});
  }
  std::sort(constraints.edges.begin(), constraints.edges.end());
  constraints.features = cells.features;
  constraints.max_chordal_deviation = feature_deviation * draft.sizing.mean();
}

/// To an apex goes the vertex nearest to it, which relaxed seeds leave not far from there.
void constrain_to_apexes(const Tessellation& cells, Draft& draft) {
  std::vector<Vec3> apexes;
  for (const Vec3& apex : cells.features.apexes)
    if (!cells.was_changed_at(apex)) apexes.push_back(apex);
  constrain_apexes(draft.mesh, draft.constraints, apexes, draft.sizing.mean());
}

}  // namespace

std::size_t annealing_work(Quality quality, std::size_t vertices) {
  constexpr std::size_t vertices_per_work = 15000, most = 10, thorough = 100;
  if (quality == Quality::fast) return 0;
  if (quality == Quality::high) return thorough;
  return std::min(1 + vertices / vertices_per_work, most);
}

Draft extract(const Tessellation& cells, const MeshOptions& options, ExecutionContext& context) {
  Draft draft;
  std::vector<Triangle> triangles = cells.complex.triangles;
  const bool closed = cells.sampling.closed();
  if (closed) draft.two_triangle_spheres = remove_two_triangle_spheres(triangles, cells.seeds.size());
  if (triangles.empty())
    throw UnusableInput("no piece of the surface is large enough for this fineness: ask for more vertices");
  make_vertices(cells, triangles, options, context, draft);
  if (!closed || options.connect == Connect::fragments) {
    std::vector<std::uint32_t> source;
    draft.cuts = separate_umbrellas(draft.mesh, source);
    if (!closed) find_boundary(cells, boundary_vertices(draft.mesh, source, context), draft);
  }
  const auto vertices = static_cast<double>(std::max<std::size_t>(4, draft.mesh.vertices.size()));
  draft.sizing = cells.sampling.sizing.with_mean(edge_length_of(cells.sampling.samples.total_area, vertices));
  constrain(cells, draft);
  constrain_to_apexes(cells, draft);
  return draft;
}

}  // namespace evenmesh
