#include "refine/fit.h"

#include <algorithm>

#include "core/parallel.h"
#include "geometry/triangle.h"
#include "refine/cell_samples.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr double worth_fitting = 0.15;  ///< of the edge length
constexpr double min_score = 0.913;     ///< Q ≥ 0.639, angles ≥ 34.2°
constexpr double min_cosine_at_creases =
    0.7;                                 ///< of a triangle's turn: not from one side of a feature curve to the other
constexpr double max_lift = 0.2;         ///< of the edge length
constexpr double among_the_worst = 0.8;  ///< of the largest deviation: what a round looks at
constexpr int max_rounds = 16;
constexpr int max_rounds_inexact = 4;  ///< on samples off the surface: later rounds only cost quality
constexpr int max_perturbations = 2;   ///< rounds around the worst where nothing helps there

/// The mesh, and how far each cell's samples lie from it.
class Fit {
 public:
  Fit(Mesh& m, const CellSamples& c, const Projector* p, const VertexConstraints& h, const ExecutionContext& context)
      : mesh(m), cells(c), projector(p), constraints(h), rings(m, context) {
    deviation.assign(m.vertices.size(), 0);
    stale.assign(m.vertices.size(), 1);
    hopeless.assign(m.vertices.size(), 0);
  }

  /// Largest squared distance of a cell's samples from the triangles around its vertex; zero when all are so near that
  /// nobody asks how near.
  double measured_deviation(std::uint32_t v) const {
    if (rings.triangles(v).empty()) return 0;
    const double edge = worth_fitting * rings.edge_length(v);
    double worst = 0;
    for (const Vec3& p : cells.of(v))
      if (!is_within(p, v, edge * edge)) worst = std::max(worst, squared_distance(p, v));
    return worst;
  }
  /// Of the vertices whose surroundings changed since the last call; all of them at first.
  void measure_deviations(const ExecutionContext& context) {
    parallel_for(context, deviation.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (stale[v]) {
          deviation[v] = measured_deviation(static_cast<std::uint32_t>(v));
          stale[v] = hopeless[v] = 0;
        }
    });
  }
  /// Vertices whose deviation is above `share` of the largest, for which there is hope, the worst first.
  std::vector<std::uint32_t> far_vertices(double share) const {
    const double limit = share * share * *std::max_element(deviation.begin(), deviation.end());
    std::vector<std::uint32_t> list;
    for (std::uint32_t v = 0; v < deviation.size(); ++v)
      if (deviation[v] > limit && !hopeless[v]) list.push_back(v);
    std::sort(list.begin(), list.end(),
              [&](auto a, auto b) { return deviation[a] != deviation[b] ? deviation[a] > deviation[b] : a < b; });
    return list;
  }
  /// Vertices around the worst, which are stuck: when something gives way there, there is hope again for those.
  std::vector<std::uint32_t> around_the_stuck() {
    constexpr std::size_t max_stuck = 6;
    std::vector<std::uint32_t> stuck(deviation.size());
    for (std::uint32_t v = 0; v < stuck.size(); ++v) stuck[v] = v;
    const auto end = stuck.begin() + static_cast<std::ptrdiff_t>(std::min(max_stuck, stuck.size()));
    std::partial_sort(stuck.begin(), end, stuck.end(), [&](auto a, auto b) {
      return deviation[a] != deviation[b] ? deviation[a] > deviation[b] : a < b;
    });
    stuck.erase(end, stuck.end());
    std::vector<char> near(deviation.size(), 0);
    for (const std::uint32_t v : stuck)
      for (const std::uint32_t w : vertices_around(v, 6)) near[w] = 1;
    std::vector<std::uint32_t> list = far_vertices(0);
    std::erase_if(list, [&](std::uint32_t v) { return !near[v]; });
    for (const std::uint32_t v : stuck) hopeless[v] = 0;
    return list;
  }
  /// Whether p is nearer than √limit to the triangles around v.
  bool is_within(const Vec3& p, std::uint32_t v, double limit) const {
    for (const std::uint32_t t : rings.triangles(v))
      if (squared_norm(p - closest_on(t, p)) < limit) return true;
    return false;
  }
  double squared_distance(const Vec3& p, std::uint32_t v) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : rings.triangles(v)) nearest = std::min(nearest, squared_norm(p - closest_on(t, p)));
    return nearest;
  }
  Vec3 closest_on(std::uint32_t triangle, const Vec3& p) const {
    const auto [a, b, c] = corners_of(mesh, triangle);
    return closest_point_on_triangle(p, a, b, c);
  }
  /// The vertices up to `rings_around` edges away from v, v itself first.
  std::vector<std::uint32_t> vertices_around(std::uint32_t v, int rings_around) const {
    std::vector<std::uint32_t> list{v};
    for (std::size_t begin = 0; rings_around-- > 0;) {
      const std::size_t end = list.size();
      for (std::size_t i = begin; i < end; ++i)
        for (const std::uint32_t w : rings.neighbours(list[i]))
          if (std::find(list.begin(), list.end(), w) == list.end()) list.push_back(w);
      begin = end;
    }
    return list;
  }

  Mesh& mesh;
  const CellSamples& cells;
  const Projector* projector;
  const VertexConstraints& constraints;
  const VertexRings rings;
  std::vector<double> deviation;  ///< squared, by vertex
  std::vector<char> stale;        ///< deviation may be wrong
  std::vector<char> hopeless;     ///< an attempt was in vain, and nothing has changed since
};

/// Tries to bring the mesh nearer to the samples of one vertex' cell. Touches what lies up to `touched_rings` edges
/// away and nothing else.
class Attempt {
 public:
  static constexpr int touched_rings = 4;

  Attempt(Fit& fit, std::uint32_t v) : fit_(fit), mesh_(fit.mesh), rings_(fit.rings), v_(v) {
    double most = -1;
    for (const Vec3& p : fit.cells.of(v))
      if (const double d = fit.squared_distance(p, v); d > most) {
        most = d;
        tip_ = p;
      }
  }

  /// Pulls a vertex of the neighbourhood onto the sample that is farthest from the mesh, or as far towards it as the
  /// triangles allow.
  bool reach() {
    if (fit_.cells.of(v_).empty()) return false;
    std::vector<std::uint32_t> movers = fit_.vertices_around(v_, 1);
    std::erase_if(movers, [&](std::uint32_t w) { return fit_.constraints.vertex(w); });
    std::sort(movers.begin(), movers.end(), [&](auto p, auto q) {
      const double dp = squared_norm(mesh_.vertices[p] - tip_), dq = squared_norm(mesh_.vertices[q] - tip_);
      return dp != dq ? dp < dq : p < q;
    });
    movers.resize(std::min<std::size_t>(movers.size(), 3));
    for (const double share : {1.0, 0.75, 0.5, 0.25})
      for (const std::uint32_t mover : movers)
        if (pull(mover, mesh_.vertices[mover] + share * (tip_ - mesh_.vertices[mover]))) return true;
    return false;
  }

  /// Lifts the triangle under the farthest sample half way towards it.
  bool lift() {
    if (fit_.cells.of(v_).empty()) return false;
    std::uint32_t nearest = 0;
    Vec3 foot;
    double distance = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : rings_.triangles(v_)) {
      const Vec3 q = fit_.closest_on(t, tip_);
      if (const double d = squared_norm(tip_ - q); d < distance) {
        distance = d;
        nearest = t;
        foot = q;
      }
    }
    const Triangle corners = mesh_.triangles[nearest];
    for (const std::uint32_t c : corners)
      if (fit_.constraints.vertex(c)) return false;
    const double edge = rings_.edge_length(v_);
    region_.clear();
    for (const std::uint32_t c : corners)
      for (const std::uint32_t w : fit_.vertices_around(c, 2)) region_.push_back(w);
    std::sort(region_.begin(), region_.end());
    region_.erase(std::unique(region_.begin(), region_.end()), region_.end());
    remember(region_);
    for (const double share : {0.5, 0.35, 0.2}) {
      Vec3 step = share * (tip_ - foot);
      if (norm(step) > max_lift * edge) step *= max_lift * edge / norm(step);
      for (const std::uint32_t c : corners) mesh_.vertices[c] += step;
      if (keep_or_undo()) return true;
    }
    return false;
  }

 private:
  /// Puts the vertex there, lets the two rings around it give way, and keeps that if triangles stay good and the mesh
  /// comes nearer.
  bool pull(std::uint32_t mover, const Vec3& target) {
    if (region_.empty() || region_.front() != mover) {
      region_ = fit_.vertices_around(mover, 2);
      remember(region_);
    }
    mesh_.vertices[mover] = target;
    for (int round = 0; round < 6; ++round) {
      bool moved = false;
      for (std::size_t i = 1; i < region_.size(); ++i) moved |= give_way(region_[i]);
      if (!moved) break;
    }
    return keep_or_undo();
  }

  /// Positions, and the triangles around the region as they are now.
  void remember(std::span<const std::uint32_t> region) {
    positions_.clear();
    triangles_.clear();
    normals_.clear();
    worst_before_ = 0;
    floor_ = min_score;
    for (const std::uint32_t w : region) {
      positions_.push_back(mesh_.vertices[w]);
      worst_before_ = std::max(worst_before_, fit_.deviation[w]);
      triangles_.insert(triangles_.end(), rings_.triangles(w).begin(), rings_.triangles(w).end());
    }
    std::sort(triangles_.begin(), triangles_.end());
    triangles_.erase(std::unique(triangles_.begin(), triangles_.end()), triangles_.end());
    for (const std::uint32_t t : triangles_) {
      normals_.push_back(rings_.normal_of(mesh_.triangles[t]));
      floor_ = std::min(floor_, rings_.score(mesh_.triangles[t]));
    }
  }

  bool keep_or_undo() {
    if (triangles_are_good() && is_better()) return true;
    for (std::size_t i = 0; i < region_.size(); ++i) mesh_.vertices[region_[i]] = positions_[i];
    return false;
  }
  bool triangles_are_good() const {
    const double least = fit_.constraints.curve.empty() ? 0 : min_cosine_at_creases;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
      const Triangle& t = mesh_.triangles[triangles_[i]];
      if (rings_.score(t) < floor_ || dot(rings_.normal_of(t), normals_[i]) <= least) return false;
    }
    return true;
  }
  /// Whether v's squared deviation fell to 0.8 of what it was and no cell's rose above the region's worst; then the
  /// cells' deviations are brought up to date.
  bool is_better() {
    for (const Vec3& p : fit_.cells.of(v_))
      if (!fit_.is_within(p, v_, 0.8 * fit_.deviation[v_])) return false;
    for (const std::uint32_t w : region_)
      for (const Vec3& p : fit_.cells.of(w))
        if (!fit_.is_within(p, w, worst_before_)) return false;
    for (const std::uint32_t w : region_) {
      fit_.deviation[w] = fit_.measured_deviation(w);
      for (const std::uint32_t x : rings_.neighbours(w)) fit_.stale[x] = 1;
    }
    return true;
  }

  /// Half way to the mean of the neighbours, along the surface, if that makes the worst triangle around w better.
  bool give_way(std::uint32_t w) {
    if (rings_.on_boundary(w) || fit_.constraints.vertex(w)) return false;
    Vec3& position = mesh_.vertices[w];
    const Vec3 original = position;
    rings_.normals(w, ring_normals_);
    const double before = rings_.worst_score(w, ring_normals_);
    if (before >= 1) return false;
    Vec3 mean;
    for (const std::uint32_t x : rings_.neighbours(w)) mean += mesh_.vertices[x];
    mean = mean / static_cast<double>(rings_.neighbours(w).size());
    const Vec3 n = rings_.normal(w), along = mean - original;
    const Vec3 step = along - dot(along, n) * n;
    for (const double share : {0.6, 0.2}) {
      const Vec3 trial = original + share * step;
      position = fit_.projector ? fit_.projector->project(trial, norm(along) + 1e-300) : trial;
      if (rings_.worst_score(w, ring_normals_, before) > before) return true;
    }
    position = original;
    return false;
  }

  Fit& fit_;
  Mesh& mesh_;
  const VertexRings& rings_;
  std::uint32_t v_;
  Vec3 tip_;
  std::vector<std::uint32_t> region_, triangles_;
  std::vector<Vec3> positions_, normals_, ring_normals_;
  double worst_before_ = 0, floor_ = 0;
};

/// Takes those vertices off the list, from the front, that are so far apart that attempts do not meet.
std::vector<std::uint32_t> take_independent(const Fit& fit, std::vector<std::uint32_t>& list,
                                            std::vector<char>& taken) {
  std::fill(taken.begin(), taken.end(), 0);
  std::vector<std::uint32_t> group, rest;
  for (const std::uint32_t v : list) {
    const auto touched = fit.vertices_around(v, Attempt::touched_rings);
    const bool meets = std::any_of(touched.begin(), touched.end(), [&](std::uint32_t w) { return taken[w]; });
    (meets ? rest : group).push_back(v);
    if (!meets)
      for (const std::uint32_t w : touched) taken[w] = 1;
  }
  list = std::move(rest);
  return group;
}

}  // namespace

std::size_t fit_extremes(Mesh& mesh, const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample,
                         const Projector* projector, double sample_error, ExecutionContext& context,
                         const VertexConstraints& constraints) {
  if (mesh.triangles.empty()) return 0;
  CellSamples cells(samples, vertex_of_sample, mesh.vertices.size(), sample_error > 0 ? projector : nullptr,
                    sample_error, context);
  Fit fit(mesh, cells, projector, constraints, context);
  fit.measure_deviations(context);
  const auto far = fit.far_vertices(0);
  cells.take_all_of(far);
  for (const std::uint32_t v : far) fit.stale[v] = 1;
  std::vector<char> taken(mesh.vertices.size());
  std::size_t moves = 0;
  int shakes = 0;
  std::size_t attempts = 0;
  const std::size_t most_attempts = 500 + mesh.vertices.size() / 20;  // extremes are few; else the mesh is too coarse
  bool perturb = false;
  const int rounds = sample_error > 0 ? max_rounds_inexact : max_rounds;
  for (int round = 0; round < rounds && attempts < most_attempts; ++round) {
    fit.measure_deviations(context);
    std::vector<std::uint32_t> worst = perturb ? fit.around_the_stuck() : fit.far_vertices(among_the_worst);
    const std::size_t before = moves;
    while (!worst.empty()) {
      const auto group = take_independent(fit, worst, taken);
      std::vector<char> moved(group.size(), 0);
      parallel_tasks(context, group.size(), [&](std::size_t i) {
        Attempt attempt(fit, group[i]);
        moved[i] = attempt.reach() || attempt.lift();
        fit.hopeless[group[i]] = !moved[i];
      });
      attempts += group.size();
      moves += static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
    }
    if (moves == before && (perturb || shakes == max_perturbations)) break;
    perturb = moves == before;
    shakes += perturb;
  }
  return moves;
}

}  // namespace evenmesh
