#include "refine/fit.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/parallel.h"
#include "geometry/triangle.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

constexpr double worth_fitting = 0.17;  ///< of the edge length
constexpr double least_score = 0.9;     ///< Q ≥ 0.648, angles ≥ 34.2°
constexpr double most_lift = 0.2;       ///< of the edge length
constexpr int reaching_rounds = 5, lifting_rounds = 4;
constexpr std::size_t samples_per_cell = 20;

/// Some samples of every vertex' cell.
class CellSamples {
 public:
  CellSamples(const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample, std::size_t vertices)
      : start_(vertices + 1, 0) {
    const std::size_t stride =
        std::max<std::size_t>(1, samples.size() / (samples_per_cell * std::max<std::size_t>(1, vertices)));
    const auto each = [&](const auto& visit) {
      for (std::size_t b = 0; b < samples.blocks.size(); ++b)
        for (std::size_t i = (samples.blocks[b].begin + stride - 1) / stride * stride; i < samples.blocks[b].end;
             i += stride)
          if (vertex_of_sample[i] < vertices) visit(b, i);
    };
    each([&](std::size_t, std::size_t i) { ++start_[vertex_of_sample[i] + 1]; });
    for (std::size_t v = 0; v < vertices; ++v) start_[v + 1] += start_[v];
    points_.resize(start_.back());
    std::vector<std::size_t> fill(start_.begin(), start_.end() - 1);
    each([&](std::size_t b, std::size_t i) {
      points_[fill[vertex_of_sample[i]]++] =
          samples.block_center(samples.blocks[b]) + Vec3{samples.x[i], samples.y[i], samples.z[i]};
    });
  }
  std::span<const Vec3> of(std::uint32_t v) const { return {points_.data() + start_[v], start_[v + 1] - start_[v]}; }

 private:
  std::vector<std::size_t> start_;
  std::vector<Vec3> points_;
};

class Fitter {
 public:
  Fitter(Mesh& mesh, const CellSamples& cells, const Projector* projector)
      : mesh_(mesh), cells_(cells), projector_(projector), rings_(mesh) {}

  /// Largest squared distance of a cell's samples from the triangles around its vertex.
  double deviation(std::uint32_t v) const { return deviation_[v]; }
  /// Of the vertices whose surroundings changed since the last call; all of them at first.
  void measure_deviations(const Run& run) {
    if (deviation_.empty()) deviation_.assign(mesh_.vertices.size(), 0), stale_.assign(mesh_.vertices.size(), 1);
    parallel_for(run, deviation_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        if (stale_[v]) deviation_[v] = measured_deviation(static_cast<std::uint32_t>(v)), stale_[v] = 0;
    });
  }

  /// Pulls a vertex of the neighbourhood onto the sample of v's cell that is farthest from the mesh, or as far towards
  /// it as the triangles allow.
  bool reach(std::uint32_t v) {
    const std::optional<Vec3> farthest = farthest_sample(v);
    if (!farthest) return false;
    const Vec3 tip = *farthest;
    std::vector<std::uint32_t> movers = neighbours(v);
    movers.push_back(v);
    std::sort(movers.begin(), movers.end(), [&](auto p, auto q) {
      const double dp = squared_norm(mesh_.vertices[p] - tip), dq = squared_norm(mesh_.vertices[q] - tip);
      return dp != dq ? dp < dq : p < q;
    });
    movers.resize(std::min<std::size_t>(movers.size(), 5));
    for (const double share : {1.0, 0.75, 0.5, 0.25})
      for (const std::uint32_t mover : movers)
        if (pull(v, mover, mesh_.vertices[mover] + share * (tip - mesh_.vertices[mover]))) return true;
    return false;
  }

  /// Lifts the triangle under the farthest sample of v's cell half way towards it.
  bool lift(std::uint32_t v) {
    const std::optional<Vec3> tip = farthest_sample(v);
    if (!tip) return false;
    std::uint32_t nearest = 0;
    Vec3 foot;
    double distance = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : rings_.triangles(v)) {
      const Triangle& c = mesh_.triangles[t];
      const Vec3 q = closest_point_on_triangle(*tip, mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]);
      if (const double d = squared_norm(*tip - q); d < distance) distance = d, nearest = t, foot = q;
    }
    const Triangle corners = mesh_.triangles[nearest];
    const double edge = rings_.edge_length(v);
    Vec3 step = 0.5 * (*tip - foot);
    if (norm(step) > most_lift * edge) step *= most_lift * edge / norm(step);
    std::vector<std::uint32_t> region;
    for (const std::uint32_t c : corners)
      for (const std::uint32_t w : two_rings(c)) region.push_back(w);
    std::sort(region.begin(), region.end());
    region.erase(std::unique(region.begin(), region.end()), region.end());
    const double before = worst_deviation(region);
    const std::array<Vec3, 3> original = {mesh_.vertices[corners[0]], mesh_.vertices[corners[1]],
                                          mesh_.vertices[corners[2]]};
    std::array<std::vector<Vec3>, 3> normals;
    std::array<double, 3> floor;
    for (int c = 0; c < 3; ++c)
      normals[c] = rings_.normals(corners[c]),
      floor[c] = std::min(least_score, rings_.worst_score(corners[c], normals[c]));
    for (const std::uint32_t c : corners) mesh_.vertices[c] += step;
    bool good = true;
    for (int c = 0; c < 3; ++c) good = good && rings_.worst_score(corners[c], normals[c]) >= floor[c];
    if (good && is_better(v, 0.8, region, before)) return true;
    for (int c = 0; c < 3; ++c) mesh_.vertices[corners[c]] = original[c];
    return false;
  }

  std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t t : rings_.triangles(v))
      for (const std::uint32_t w : mesh_.triangles[t])
        if (w != v && std::find(list.begin(), list.end(), w) == list.end()) list.push_back(w);
    return list;
  }

 private:
  /// Zero when all samples are so near that nobody asks how near.
  double measured_deviation(std::uint32_t v) const {
    const double edge = worth_fitting * rings_.edge_length(v);
    double worst = 0;
    for (const Vec3& p : cells_.of(v))
      if (!is_within(p, rings_.triangles(v), edge * edge))
        worst = std::max(worst, squared_distance(p, rings_.triangles(v)));
    return worst;
  }
  bool is_within(const Vec3& p, std::span<const std::uint32_t> triangles, double limit) const {
    for (const std::uint32_t t : triangles) {
      const Triangle& c = mesh_.triangles[t];
      const Vec3 q = closest_point_on_triangle(p, mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]);
      if (squared_norm(p - q) < limit) return true;
    }
    return false;
  }
  double squared_distance(const Vec3& p, std::span<const std::uint32_t> triangles) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t t : triangles) {
      const Triangle& c = mesh_.triangles[t];
      nearest =
          std::min(nearest, squared_norm(p - closest_point_on_triangle(p, mesh_.vertices[c[0]], mesh_.vertices[c[1]],
                                                                       mesh_.vertices[c[2]])));
    }
    return nearest;
  }
  std::vector<std::uint32_t> two_rings(std::uint32_t v) const {
    std::vector<std::uint32_t> list = neighbours(v);
    for (const std::uint32_t w : std::vector<std::uint32_t>(list))
      for (const std::uint32_t x : neighbours(w)) list.push_back(x);
    list.push_back(v);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }
  std::vector<std::uint32_t> triangles_around(const std::vector<std::uint32_t>& vertices) const {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t w : vertices)
      list.insert(list.end(), rings_.triangles(w).begin(), rings_.triangles(w).end());
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }
  std::optional<Vec3> farthest_sample(std::uint32_t v) const {
    std::optional<Vec3> farthest;
    double most = -1;
    for (const Vec3& p : cells_.of(v))
      if (const double d = squared_distance(p, rings_.triangles(v)); d > most) most = d, farthest = p;
    return farthest;
  }
  double worst_deviation(std::span<const std::uint32_t> cells) const {
    double worst = 0;
    for (const std::uint32_t w : cells) worst = std::max(worst, deviation_[w]);
    return worst;
  }
  /// Whether v's squared deviation fell to `share` of what it was and no cell's rose above `worst`; then the cells'
  /// deviations are brought up to date.
  bool is_better(std::uint32_t v, double share, std::span<const std::uint32_t> cells, double worst) {
    for (const Vec3& p : cells_.of(v))
      if (!is_within(p, rings_.triangles(v), share * deviation_[v])) return false;
    for (const std::uint32_t w : cells)
      for (const Vec3& p : cells_.of(w))
        if (!is_within(p, rings_.triangles(w), worst)) return false;
    for (const std::uint32_t w : cells) {
      deviation_[w] = measured_deviation(w);
      for (const std::uint32_t t : rings_.triangles(w))
        for (const std::uint32_t x : mesh_.triangles[t]) stale_[x] = 1;
    }
    return true;
  }

  /// Puts the vertex there, lets the two rings around it give way, and keeps that if triangles stay good and the mesh
  /// comes nearer.
  bool pull(std::uint32_t v, std::uint32_t mover, const Vec3& target) {
    const auto region = two_rings(mover);
    const auto triangles = triangles_around(region);
    std::vector<Vec3> positions, normals;
    double floor = least_score;
    const double before = worst_deviation(region);
    for (const std::uint32_t w : region) positions.push_back(mesh_.vertices[w]);
    for (const std::uint32_t t : triangles) {
      normals.push_back(rings_.normal_of(mesh_.triangles[t]));
      floor = std::min(floor, rings_.score(mesh_.triangles[t]));
    }
    mesh_.vertices[mover] = target;
    for (int round = 0; round < 6; ++round)
      for (const std::uint32_t w : region)
        if (w != mover) give_way(w);
    bool good = true;
    for (std::size_t i = 0; i < triangles.size() && good; ++i) {
      const Triangle& t = mesh_.triangles[triangles[i]];
      good = rings_.score(t) >= floor && dot(rings_.normal_of(t), normals[i]) > 0;
    }
    if (good && is_better(v, 0.8, region, before)) return true;
    for (std::size_t i = 0; i < region.size(); ++i) mesh_.vertices[region[i]] = positions[i];
    return false;
  }

  /// Half way to the mean of the neighbours, along the surface, if that makes the worst triangle around w better.
  void give_way(std::uint32_t w) {
    Vec3& position = mesh_.vertices[w];
    const Vec3 original = position;
    const std::vector<Vec3> normals = rings_.normals(w);
    const double before = rings_.worst_score(w, normals);
    if (before >= 1) return;
    Vec3 mean;
    const auto around = neighbours(w);
    for (const std::uint32_t x : around) mean += mesh_.vertices[x];
    mean = mean / static_cast<double>(around.size());
    const Vec3 n = rings_.normal(w), along = mean - original;
    const Vec3 step = along - dot(along, n) * n;
    for (const double share : {0.6, 0.2}) {
      const Vec3 trial = original + share * step;
      position = projector_ ? projector_->project(trial, norm(along) + 1e-300) : trial;
      if (rings_.worst_score(w, normals) > before) return;
    }
    position = original;
  }

  Mesh& mesh_;
  const CellSamples& cells_;
  const Projector* projector_;
  VertexRings rings_;
  std::vector<double> deviation_;  ///< squared, by vertex
  std::vector<char> stale_;        ///< deviation_ may be wrong
};

}  // namespace

std::size_t fit_extremes(Mesh& mesh, const SampleSet& samples, std::span<const std::uint32_t> vertex_of_sample,
                         const Projector* projector, Run& run) {
  const std::size_t count = mesh.vertices.size();
  const CellSamples cells(samples, vertex_of_sample, count);
  Fitter fitter(mesh, cells, projector);
  std::size_t moves = 0;
  for (int round = 0; round < reaching_rounds + lifting_rounds; ++round) {
    fitter.measure_deviations(run);
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < count; ++v)
      if (fitter.deviation(v) > 0) order.push_back(v);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) {
      return fitter.deviation(a) != fitter.deviation(b) ? fitter.deviation(a) > fitter.deviation(b) : a < b;
    });
    order.resize(std::min(order.size(), std::max<std::size_t>(50, count / 100)));
    const std::size_t before = moves;
    for (const std::uint32_t v : order) {
      run.throw_if_cancelled();
      moves += round < reaching_rounds ? fitter.reach(v) : fitter.lift(v);
    }
    if (moves == before && round >= reaching_rounds) break;
  }
  return moves;
}

}  // namespace evenmesh
