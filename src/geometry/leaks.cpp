#include "geometry/leaks.h"

#include <algorithm>
#include <unordered_map>

#include "evenmesh/repair.h"
#include "geometry/hole_fills.h"
#include "geometry/hole_room.h"
#include "geometry/shared_edges.h"
#include "geometry/triangle.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

constexpr double small_holes = 0.25;   ///< of a patch's area
constexpr double least_room = 1.35;    ///< behind a hole
constexpr double worth_asking = 0.01;  ///< of all area: patches of which rays are asked
constexpr double widest_holes = 0.5;   ///< of a patch's area, for rays to be asked
constexpr std::uint32_t none = 0xffffffffu;

using OpenEdges = std::unordered_map<std::uint64_t, std::uint32_t>;  // of one triangle: which

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

OpenEdges open_edges(const Mesh& mesh) {
  OpenEdges open;
  for_each_edge(edge_uses(mesh.triangles), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) open[key_of(edge[0].low, edge[0].high)] = edge[0].triangle;
  });
  return open;
}

/// Patches joined by the rims of their holes.
struct OpenPatch {
  std::vector<std::uint32_t> triangles;
  std::vector<std::vector<Triangle>> fills;
  std::size_t open_edges = 0, rim_edges = 0;
  double area = 0, fill_area = 0;
};

double area_of(const std::vector<Vec3>& vertices, const Triangle& t) {
  return triangle_area(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
}

/// Those with open edges.
std::vector<OpenPatch> open_patches(const Mesh& mesh, const std::vector<std::uint32_t>& patch, const OpenEdges& open) {
  UnionFind joined(1 + *std::max_element(patch.begin(), patch.end()));
  std::vector<std::vector<Triangle>> fills = hole_fills(mesh);
  std::vector<std::uint32_t> patch_of_fill(fills.size(), none);
  for (std::size_t i = 0; i < fills.size(); ++i)
    for (const Triangle& t : fills[i])
      for (std::size_t c = 0; c < 3; ++c) {
        const auto rim = open.find(key_of(t[c], t[(c + 1) % 3]));
        if (rim == open.end()) continue;
        const std::uint32_t here = patch[rim->second];
        if (patch_of_fill[i] == none) patch_of_fill[i] = here;
        joined.unite(patch_of_fill[i], here);
      }
  std::vector<OpenPatch> all(joined.size());
  for (const auto& [edge, triangle] : open) ++all[joined.find(patch[triangle])].open_edges;
  for (std::uint32_t t = 0; t < patch.size(); ++t) {
    OpenPatch& own = all[joined.find(patch[t])];
    own.area += area_of(mesh.vertices, mesh.triangles[t]);
    if (own.open_edges > 0) own.triangles.push_back(t);
  }
  for (std::size_t i = 0; i < fills.size(); ++i) {
    OpenPatch& own = all[joined.find(patch_of_fill[i])];
    own.rim_edges += fills[i].size() + 2;
    for (const Triangle& t : fills[i]) own.fill_area += area_of(mesh.vertices, t);
    own.fills.push_back(std::move(fills[i]));
  }
  std::erase_if(all, [](const OpenPatch& p) { return p.open_edges == 0; });
  return all;
}

/// Above zero where it faces outward, once its holes are filled.
double volume_of(const Mesh& mesh, const OpenPatch& patch) {
  const Vec3 middle = mesh.vertices[mesh.triangles[patch.triangles[0]][0]];
  double volume = 0;
  const auto add = [&](const Triangle& t) {
    volume += dot(mesh.vertices[t[0]] - middle, cross(mesh.vertices[t[1]] - middle, mesh.vertices[t[2]] - middle));
  };
  for (const std::uint32_t t : patch.triangles) add(mesh.triangles[t]);
  for (const auto& fill : patch.fills) std::for_each(fill.begin(), fill.end(), add);
  return volume;
}

bool has_small_holes_only(const Mesh& mesh, const OpenPatch& patch, const Mesh& alone, ExecutionContext& context) {
  if (patch.rim_edges != patch.open_edges || patch.fill_area > small_holes * patch.area) return false;
  const EmbreeScene scene(alone, context);
  const double outward = volume_of(mesh, patch) < 0 ? -1 : 1;
  return std::all_of(patch.fills.begin(), patch.fills.end(),
                     [&](const auto& fill) { return room_behind(scene, mesh.vertices, fill, outward) >= least_room; });
}

}  // namespace

Mesh packed(const std::vector<Vec3>& vertices, std::vector<Triangle> triangles) {
  Mesh mesh{{}, std::move(triangles)};
  std::vector<std::uint32_t> index(vertices.size(), none);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) {
      if (index[v] == none) {
        index[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(vertices[v]);
      }
      v = index[v];
    }
  return mesh;
}

Leaks find_leaks(const Mesh& mesh, const std::vector<std::uint32_t>& patch, const AskRays& solidity,
                 ExecutionContext& context) {
  Leaks leaks;
  leaks.leaking.assign(mesh.triangles.size(), 0);
  const OpenEdges open = open_edges(mesh);
  if (open.empty()) return leaks;
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += area_of(mesh.vertices, t);
  for (OpenPatch& own : open_patches(mesh, patch, open)) {
    const bool asked = own.area >= worth_asking * area && own.fill_area <= widest_holes * own.area;
    if (!asked && (own.rim_edges != own.open_edges || own.fill_area > small_holes * own.area)) continue;
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : own.triangles) triangles.push_back(mesh.triangles[t]);
    const Mesh alone = packed(mesh.vertices, std::move(triangles));
    std::vector<char> filled(own.fills.size(), 1);
    if (!has_small_holes_only(mesh, own, alone, context)) {
      if (!asked || solidity(alone) < min_solidity) continue;
      filled = lie_half_way(mesh.vertices, own.fills);
    }
    const bool closed = own.rim_edges == own.open_edges && std::count(filled.begin(), filled.end(), 0) == 0;
    if (!closed)
      for (const std::uint32_t t : own.triangles) leaks.leaking[t] = 1;
    for (std::size_t i = 0; i < filled.size(); ++i)
      if (filled[i]) leaks.fills.push_back(std::move(own.fills[i]));
  }
  return leaks;
}

}  // namespace evenmesh
