#include "refine/fit_attempt.h"

#include <algorithm>
#include <limits>

#include "geometry/triangle.h"
#include "refine/give_way.h"
#include "refine/piercing.h"

namespace evenmesh {
namespace {

constexpr double better = 0.8;    ///< of a squared deviation: less is not worth it
constexpr double hopeless = 1.2;  ///< of a squared deviation: what giving way does not bring back
constexpr double min_cosine_at_creases =
    0.7;                          ///< of a triangle's turn: not from one side of a feature curve to the other
constexpr double max_lift = 0.2;  ///< of the edge length
constexpr int sweeps = 12;
constexpr std::size_t max_movers = 4;
constexpr std::size_t max_flips = 8;

}  // namespace

FitAttempt::FitAttempt(const FitState& state, std::uint32_t v, double floor)
    : state_(state),
      floor_(floor),
      vertices_(vertices_around(state.rings, v, touched_rings)),
      original_(patch()),
      mesh_(original_),
      rings_(mesh_),
      deviation_(state.deviations[v]),
      gap_(gaps(rings_).largest(0, samples(0))) {
  for (const Triangle& t : mesh_.triangles) facing_.push_back(rings_.normal_of(t));
}

/// The triangles all of whose corners are among the vertices.
Mesh FitAttempt::patch() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> numbers;
  numbers.reserve(vertices_.size());
  Mesh mesh;
  for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
    mesh.vertices.push_back(state_.mesh.vertices[vertices_[i]]);
    numbers.push_back({vertices_[i], i});
    triangles_.insert(triangles_.end(), state_.rings.triangles(vertices_[i]).begin(),
                      state_.rings.triangles(vertices_[i]).end());
  }
  std::sort(numbers.begin(), numbers.end());
  std::sort(triangles_.begin(), triangles_.end());
  triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
  std::erase_if(triangles_, [&](std::uint32_t t) {
    Triangle local{};
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t v = state_.mesh.triangles[t][c];
      const auto at = std::lower_bound(numbers.begin(), numbers.end(), std::pair{v, 0u});
      if (at == numbers.end() || at->first != v) return true;
      local[c] = at->second;
    }
    mesh.triangles.push_back(local);
    return false;
  });
  return mesh;
}

bool FitAttempt::reach() {
  return pull_one(rings_, std::array{1.0, 0.75, 0.5, 0.25});
}

bool FitAttempt::lift() {
  std::uint32_t nearest = 0;
  double distance = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : rings_.triangles(0)) {
    const auto [a, b, c] = corners_of(mesh_, t);
    const double d = squared_norm(gap_.on_mesh - closest_point_on_triangle(gap_.on_mesh, a, b, c));
    if (d < distance) {
      distance = d;
      nearest = t;
    }
  }
  const Triangle corners = mesh_.triangles[nearest];
  if (!std::all_of(corners.begin(), corners.end(), [&](std::uint32_t c) { return is_movable(c); })) return false;
  surround(rings_, corners, 2);
  for (const double share : {0.5, 0.35, 0.2}) {
    Vec3 step = share * (gap_.on_surface - gap_.on_mesh);
    const double most = max_lift * rings_.edge_length(0);
    if (norm(step) > most) step *= most / norm(step);
    for (const std::uint32_t c : corners) mesh_.vertices[c] += step;
    if (keep_or_undo(rings_)) return true;
  }
  return false;
}

bool FitAttempt::flip() {
  std::vector<std::pair<double, Quad>> candidates;
  const std::vector<Vec3> facing = facing_;
  for (const Quad& q : quads()) {
    flip(q);
    const VertexRings rings(mesh_);
    candidates.push_back({GapFinder(mesh_, rings, nullptr, 0).largest(0, samples(0)).squared_distance, q});
    mesh_.triangles = original_.triangles;
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& x, const auto& y) { return x.first < y.first; });
  if (candidates.size() > max_flips) candidates.resize(max_flips);
  for (const auto& [_, q] : candidates) {
    flip(q);
    facing_[q.left] = facing_[q.right] = normalized(facing[q.left] + facing[q.right]);
    flipped_ = q;
    const VertexRings rings(mesh_);
    if (pull(rings, 0, mesh_.vertices[0]) || pull_one(rings, std::array{1.0, 0.5})) return true;
    mesh_.triangles = original_.triangles;
    facing_ = facing;
    flipped_.reset();
  }
  return false;
}

bool FitAttempt::is_movable(std::uint32_t v) const {
  return !rings_.on_boundary(v) && !state_.constraints.vertex(vertices_[v]);
}

/// Those beside the vertex, the nearest to the gap first.
bool FitAttempt::pull_one(const VertexRings& rings, std::span<const double> shares) {
  std::vector<std::uint32_t> movers = vertices_around(rings, 0, 1);
  std::erase_if(movers, [&](std::uint32_t w) { return !is_movable(w); });
  const auto distance = [&](std::uint32_t w) { return squared_norm(mesh_.vertices[w] - gap_.on_surface); };
  std::sort(movers.begin(), movers.end(), [&](auto p, auto q) {
    return distance(p) != distance(q) ? distance(p) < distance(q) : vertices_[p] < vertices_[q];
  });
  movers.resize(std::min(movers.size(), max_movers));
  for (const double share : shares)
    for (const std::uint32_t mover : movers) {
      const Vec3 way = share * (gap_.on_surface - mesh_.vertices[mover]);
      Vec3 target = mesh_.vertices[mover] + way;
      if (share < 1 && state_.projector) target = state_.projector->project(target, norm(way));
      if (pull(rings, mover, target)) return true;
    }
  return false;
}

/// Puts the vertex there, and lets those around it give way.
bool FitAttempt::pull(const VertexRings& rings, std::uint32_t mover, const Vec3& target) {
  mesh_.vertices[mover] = target;
  if (!gaps(rings).all_within(0, samples(0), better * deviation_)) {
    mesh_.vertices[mover] = original_.vertices[mover];
    return false;
  }
  surround(rings, std::span(&mover, 1), 2);
  for (const std::uint32_t w : rings.neighbours(mover))
    if (w != 0 && !gaps(rings).all_within(w, samples(w), hopeless * largest_before())) {
      mesh_.vertices[mover] = original_.vertices[mover];
      return false;
    }
  std::vector<std::uint32_t> others;
  for (const std::uint32_t w : region_)
    if (w != mover && is_movable(w)) others.push_back(w);
  give_way(mesh_, rings, state_.projector, others, sweeps);
  return keep_or_undo(rings);
}

/// The region: what lies up to `distance` edges around those, and what a flip has changed.
void FitAttempt::surround(const VertexRings& rings, std::span<const std::uint32_t> centres, int distance) {
  region_.clear();
  const auto add = [&](std::uint32_t w) {
    if (std::find(region_.begin(), region_.end(), w) == region_.end()) region_.push_back(w);
  };
  for (const std::uint32_t c : centres)
    for (const std::uint32_t w : vertices_around(rings, c, distance)) add(w);
  if (flipped_)
    for (const std::uint32_t w : {flipped_->a, flipped_->b, flipped_->c, flipped_->d}) add(w);
}

bool FitAttempt::keep_or_undo(const VertexRings& rings) {
  if (triangles_are_good(rings) && is_better(rings) && !intersects(rings)) {
    write_back(rings);
    return true;
  }
  for (const std::uint32_t w : region_) mesh_.vertices[w] = original_.vertices[w];
  return false;
}

bool FitAttempt::triangles_are_good(const VertexRings& rings) const {
  const double least = state_.constraints.curve.empty() ? 0 : min_cosine_at_creases;
  double floor = floor_;
  for (const std::uint32_t w : region_)
    for (const std::uint32_t t : rings_.triangles(w)) {
      const Triangle& c = original_.triangles[t];
      floor = std::min(
          floor, VertexRings::score(original_.vertices[c[0]], original_.vertices[c[1]], original_.vertices[c[2]]));
    }
  for (const std::uint32_t w : region_)
    for (const std::uint32_t t : rings.triangles(w)) {
      const Triangle& c = mesh_.triangles[t];
      if (rings.score(c) < floor || dot(rings.normal_of(c), facing_[t]) <= least) return false;
    }
  return true;
}

/// Of the region.
double FitAttempt::largest_before() const {
  double largest = 0;
  for (const std::uint32_t w : region_) largest = std::max(largest, state_.deviations[vertices_[w]]);
  return largest;
}

bool FitAttempt::has_moved(std::uint32_t v) const {
  const auto is = [v](std::uint32_t w) { return v == w; };
  return mesh_.vertices[v] != original_.vertices[v] ||
         (flipped_ && (is(flipped_->a) || is(flipped_->b) || is(flipped_->c) || is(flipped_->d)));
}

/// Whether the deviation fell and no other rose above the region's largest.
bool FitAttempt::is_better(const VertexRings& rings) {
  const GapFinder now = gaps(rings);
  if (!(now.deviation(0, samples(0), better * deviation_) <= better * deviation_)) return false;
  const double largest = largest_before();
  measured_.clear();
  for (const std::uint32_t w : region_) {
    const auto beside = rings.neighbours(w);
    if (!has_moved(w) && std::none_of(beside.begin(), beside.end(), [&](std::uint32_t x) { return has_moved(x); }))
      continue;
    measured_.push_back({w, now.deviation(w, samples(w), largest)});
    if (measured_.back().second > largest) return false;
  }
  return true;
}

/// Whether triangles intersect that did not: the two sides of a thin part are near each other.
bool FitAttempt::intersects(const VertexRings& rings) const {
  std::vector<std::uint32_t> changed;
  for (const std::uint32_t w : region_)
    if (has_moved(w)) changed.insert(changed.end(), rings.triangles(w).begin(), rings.triangles(w).end());
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return any_pierces(mesh_, changed) && !any_pierces(original_, changed);
}

void FitAttempt::write_back(const VertexRings& rings) {
  for (const auto& [w, deviation] : measured_) state_.deviations.set(vertices_[w], deviation);
  for (const std::uint32_t w : region_) {
    if (!has_moved(w)) continue;
    state_.mesh.vertices[vertices_[w]] = mesh_.vertices[w];
    for (const std::uint32_t x : rings.neighbours(w))
      if (std::find(region_.begin(), region_.end(), x) == region_.end()) state_.deviations.mark(vertices_[x]);
  }
  if (flipped_)
    for (const std::uint32_t t : {flipped_->left, flipped_->right}) {
      Triangle& to = state_.mesh.triangles[triangles_[t]];
      for (int c = 0; c < 3; ++c) to[c] = vertices_[mesh_.triangles[t][c]];
    }
}

/// Edges of the triangles around the vertex that can be flipped.
std::vector<FitAttempt::Quad> FitAttempt::quads() const {
  std::vector<Quad> list;
  for (const std::uint32_t t : rings_.triangles(0))
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh_.triangles[t][c], b = mesh_.triangles[t][(c + 1) % 3];
      if (b == 0) continue;  // the other triangle at that edge has it as well, the other way round
      if (const auto q = quad(a, b)) list.push_back(*q);
    }
  return list;
}
std::optional<FitAttempt::Quad> FitAttempt::quad(std::uint32_t a, std::uint32_t b) const {
  constexpr double min_cosine = 0.3;
  if (rings_.on_boundary(a) || rings_.on_boundary(b)) return {};
  const auto [low, high] = std::minmax(vertices_[a], vertices_[b]);
  if (state_.constraints.edge(low, high)) return {};
  if (std::min(rings_.triangles(a).size(), rings_.triangles(b).size()) < 4) return {};
  Quad q{a, b, a, a, 0, 0};
  for (const std::uint32_t t : rings_.triangles(a))
    for (int c = 0; c < 3; ++c) {
      const Triangle& corners = mesh_.triangles[t];
      if (corners[c] == a && corners[(c + 1) % 3] == b) {
        q.c = corners[(c + 2) % 3];
        q.left = t;
      }
      if (corners[c] == b && corners[(c + 1) % 3] == a) {
        q.d = corners[(c + 2) % 3];
        q.right = t;
      }
    }
  const auto beside = rings_.neighbours(q.c);
  if (q.c == a || q.d == a || q.c == q.d || std::find(beside.begin(), beside.end(), q.d) != beside.end()) return {};
  if (rings_.on_boundary(q.c) || rings_.on_boundary(q.d)) return {};
  const Vec3 normal = normalized(facing_[q.left] + facing_[q.right]);
  for (const Triangle& t : {Triangle{q.c, q.a, q.d}, Triangle{q.d, q.b, q.c}})
    if (!(dot(rings_.normal_of(t), normal) > min_cosine)) return {};
  return q;
}
void FitAttempt::flip(const Quad& q) {
  mesh_.triangles[q.left] = {q.c, q.a, q.d};
  mesh_.triangles[q.right] = {q.d, q.b, q.c};
}

}  // namespace evenmesh
