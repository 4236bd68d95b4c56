#include "geometry/mesh_parts.h"

#include <algorithm>

#include "core/parallel.h"
#include "evenmesh/repair.h"
#include "geometry/clean.h"
#include "geometry/mesh_bodies.h"
#include "geometry/shared_edges.h"
#include "geometry/triangle.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

constexpr int most_partitions = 100;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Every edge is used as often one way as the other: a random antisymmetric function of the edges sums to 0.
bool is_balanced(const std::vector<Triangle>& triangles) {
  std::uint64_t sum = 0;
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t[c], b = t[(c + 1) % 3];
      if (a == b) continue;
      const std::uint64_t value = mix(key_of(a, b) + 0x9e3779b97f4a7c15ull);
      sum += a < b ? value : 0 - value;
    }
  return sum == 0;
}

bool has_coincident(const std::vector<Triangle>& triangles, const ExecutionContext& context) {
  std::vector<std::uint64_t> keys(triangles.size());
  parallel_for(context, keys.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Triangle t = triangles[i];
      std::sort(t.begin(), t.end());
      keys[i] = mix(mix(key_of(t[0], t[1]) + 0x9e3779b97f4a7c15ull) + t[2]);
    }
  });
  parallel_sort(context, keys);
  return std::adjacent_find(keys.begin(), keys.end()) != keys.end();
}

/// Connected across vertices.
std::vector<std::uint32_t> components_of(const Mesh& mesh) {
  UnionFind sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[1], t[2]);
  }
  std::vector<std::uint32_t> number(mesh.vertices.size(), 0xffffffffu), component;
  std::uint32_t next = 0;
  for (const Triangle& t : mesh.triangles) {
    std::uint32_t& n = number[sets.find(t[0])];
    if (n == 0xffffffffu) n = next++;
    component.push_back(n);
  }
  return component;
}

/// Closed by its indices, nothing twice, and all bodies face one way.
bool is_in_order(const Mesh& mesh, const ExecutionContext& context) {
  if (!is_balanced(mesh.triangles) || has_coincident(mesh.triangles, context)) return false;
  const std::vector<MeshBody> bodies = bodies_of(mesh, components_of(mesh));
  const auto inward = std::count_if(bodies.begin(), bodies.end(), [](const MeshBody& b) { return b.volume < 0; });
  return inward == 0 || static_cast<std::size_t>(inward) == bodies.size();
}

MeshPiece piece_of(const std::vector<Vec3>& vertices, std::span<const Triangle> triangles) {
  MeshPiece piece;
  Box box;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) box.add(vertices[v]);
    piece.area += triangle_area(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  }
  piece.middle = box.center();
  piece.size = box.diagonal();
  return piece;
}

void sort_largest_first(std::vector<MeshPiece>& pieces) {
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const MeshPiece& a, const MeshPiece& b) { return a.size > b.size; });
}

class Splitter {
 public:
  Splitter(const Mesh& mesh, const AskRays& solidity, ExecutionContext& context)
      : solidity_(solidity), context_(context) {
    MeshDefects defects;
    CleanMesh clean = evenmesh::clean(mesh, defects);
    turned_triangles_ = defects.turned_triangles;
    repeated_ = defects.repeated_triangles;
    mesh_ = std::move(clean.mesh);
    patch_ = std::move(clean.patch);
    beside_ = std::move(clean.walls);
    changed_ = !beside_.empty();
    leaking_.assign(mesh_.triangles.size(), 0);
  }

  MeshParts result(bool turn) {
    fill_holes();
    while (take_open_patches()) {
    }
    for (int i = 0; i < most_partitions && take_partition(); ++i) {
    }
    take_sheets();
    if (turn) turn_bodies();
    sort_largest_first(result_.filled_holes);
    sort_largest_first(result_.turned_bodies);
    sort_largest_first(result_.sheet_pieces);
    result_.turned_triangles = turned_triangles_;
    const bool same = result_.filled_holes.empty() && result_.sheet_pieces.empty() && result_.turned_bodies.empty();
    result_.as_given = same && turned_triangles_ == 0 && repeated_ == 0 && !changed_ && !mesh_.triangles.empty();
    if (!result_.as_given) result_.solid = packed(mesh_.vertices, std::move(mesh_.triangles));
    return std::move(result_);
  }

 private:
  void fill_holes() {
    Leaks leaks = find_leaks(mesh_, patch_, solidity_, context_);
    leaking_ = std::move(leaks.leaking);
    if (leaks.fills.empty()) return;
    for (const auto& fill : leaks.fills) {
      result_.filled_holes.push_back(piece_of(mesh_.vertices, fill));
      mesh_.triangles.insert(mesh_.triangles.end(), fill.begin(), fill.end());
    }
    leaking_.resize(mesh_.triangles.size(), 0);
    orient_again();
  }

  void orient_again() {
    MeshDefects defects;
    patch_ = orient(mesh_, defects);
    turned_triangles_ += defects.turned_triangles;
  }

  std::size_t patches() const { return patch_.empty() ? 0 : 1 + *std::max_element(patch_.begin(), patch_.end()); }

  /// Moves patches beside; returns whether there are any.
  bool take(const std::vector<char>& gone) {
    if (std::find(gone.begin(), gone.end(), 1) == gone.end()) return false;
    changed_ = true;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < patch_.size(); ++t) {
      if (gone[patch_[t]]) {
        beside_.push_back(mesh_.triangles[t]);
        continue;
      }
      leaking_[kept] = leaking_[t];
      mesh_.triangles[kept++] = mesh_.triangles[t];
    }
    mesh_.triangles.resize(kept);
    leaking_.resize(kept);
    orient_again();
    return true;
  }

  /// What has a free boundary bounds nothing; what it was attached to becomes whole without it.
  bool take_open_patches() {
    std::vector<char> open(patches(), 0);
    for_each_edge(edge_uses(mesh_.triangles), [&](std::span<const EdgeUse> edge) {
      if (edge.size() == 1) open[patch_[edge[0].triangle]] = 1;
    });
    for (std::size_t t = 0; t < patch_.size(); ++t)
      if (leaking_[t]) open[patch_[t]] = 0;
    return take(open);
  }

  /// A wall of one triangle for both sides: where its rim meets others, an even number of triangles is left without it.
  /// Of those that could go, the smallest.
  bool take_partition() {
    std::vector<char> could(patches(), 1), has_rim(patches(), 0);
    for_each_edge(edge_uses(mesh_.triangles), [&](std::span<const EdgeUse> edge) {
      if (edge.size() == 2) return;
      for (const EdgeUse& use : edge) {
        has_rim[patch_[use.triangle]] = 1;
        if (edge.size() % 2 == 0 || edge.size() == 1) could[patch_[use.triangle]] = 0;
      }
    });
    std::vector<double> area(patches(), 0);
    for (std::size_t t = 0; t < patch_.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh_, t);
      area[patch_[t]] += triangle_area(a, b, c);
    }
    std::size_t smallest = area.size();
    for (std::size_t p = 0; p < area.size(); ++p)
      if (could[p] && has_rim[p] && (smallest == area.size() || area[p] < area[smallest])) smallest = p;
    if (smallest == area.size()) return false;
    std::vector<char> gone(area.size(), 0);
    gone[smallest] = 1;
    return take(gone);
  }

  /// Of what bounds nothing, that which does not lie within the solid.
  void take_sheets() {
    if (beside_.empty()) return;
    Mesh sheets{mesh_.vertices, std::move(beside_)};
    MeshDefects defects;
    const std::vector<std::uint32_t> patch = orient(sheets, defects);
    const std::vector<char> hidden = hidden_patches(sheets, patch, mesh_.triangles);
    std::vector<std::vector<Triangle>> seen(hidden.size());
    std::vector<Triangle> all;
    for (std::size_t t = 0; t < patch.size(); ++t)
      if (!hidden[patch[t]]) {
        seen[patch[t]].push_back(sheets.triangles[t]);
        all.push_back(sheets.triangles[t]);
      }
    for (const auto& triangles : seen)
      if (!triangles.empty()) result_.sheet_pieces.push_back(piece_of(sheets.vertices, triangles));
    result_.sheets = packed(sheets.vertices, std::move(all));
  }

  /// Patches that are not closed by themselves are one body with those that they share edges with.
  std::vector<std::uint32_t> body_of_triangles() const {
    UnionFind bodies(patches());
    for_each_edge(edge_uses(mesh_.triangles), [&](std::span<const EdgeUse> edge) {
      std::optional<std::uint32_t> first;  // of the patches that are not closed here
      for (const EdgeUse& own : edge) {
        int sum = 0;
        for (const EdgeUse& use : edge)
          if (patch_[use.triangle] == patch_[own.triangle]) sum += use.up ? 1 : -1;
        if (sum == 0) continue;
        if (!first) first = patch_[own.triangle];
        bodies.unite(*first, patch_[own.triangle]);
      }
    });
    std::vector<std::uint32_t> number(patches(), 0xffffffffu), body;
    std::uint32_t next = 0;
    for (const std::uint32_t p : patch_) {
      std::uint32_t& n = number[bodies.find(p)];
      if (n == 0xffffffffu) n = next++;
      body.push_back(n);
    }
    return body;
  }

  void turn_bodies() {
    const std::vector<MeshBody> bodies = bodies_of(mesh_, body_of_triangles());
    for (const std::size_t b : inverted_bodies(mesh_, bodies)) {
      std::vector<Triangle> triangles;
      for (const std::uint32_t t : bodies[b].triangles) {
        std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
        triangles.push_back(mesh_.triangles[t]);
      }
      result_.turned_bodies.push_back(piece_of(mesh_.vertices, triangles));
    }
  }

  const AskRays& solidity_;
  ExecutionContext& context_;
  Mesh mesh_;                         // what may bound a solid
  std::vector<std::uint32_t> patch_;  // of its triangles
  std::vector<char> leaking_;         // triangles of patches that have an inside, though they are open
  std::vector<Triangle> beside_;      // what bounds nothing
  std::size_t turned_triangles_ = 0, repeated_ = 0;
  bool changed_ = false;  // something was moved beside
  MeshParts result_;
};

}  // namespace

MeshParts parts_of(const Mesh& mesh, bool turn, const AskRays& solidity, ExecutionContext& context) {
  if (is_in_order(mesh, context)) {
    MeshParts whole;
    whole.as_given = true;
    return whole;
  }
  return Splitter(mesh, solidity, context).result(turn);
}

}  // namespace evenmesh
