#include "topology/repair.h"

#include <algorithm>
#include <cmath>

#include "geometry/point_hash.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t fewest_samples = 12;  ///< of a cell that may still be divided: three or four grid cells across

/// The cells that have a defect.
struct Cell {
  std::uint32_t samples = 0;
  double area = 0, farthest = -1;
  Vec3 moment, far_sample;
  Vec3 centroid(const Vec3& seed) const { return area > 0 ? moment / area : seed; }
};

class Planner {
 public:
  Planner(const SampleSet& samples, std::span<const std::uint32_t> labels, std::span<const Vec3> seeds,
          std::span<const Vec3> ambiguous_faces, const BallIndex& balls, const TopologyRepairOptions& options)
      : samples_(samples),
        labels_(labels),
        seeds_(seeds),
        ambiguous_faces_(ambiguous_faces, options.edge),
        balls_(balls),
        options_(options),
        new_balls_({}, 0.5 * options.edge),
        planned_(ambiguous_faces.size(), 0),
        cells_(seeds.size()),
        asked_(seeds.size(), 0) {
    repair_.balls = balls.balls();
    grown_.assign(repair_.balls.size(), 0);
  }

  TopologyRepair plan(std::span<const std::pair<std::uint32_t, std::uint32_t>> defects) {
    std::vector<char> defective(seeds_.size(), 0);
    for (const auto& [a, b] : defects) defective[a] = defective[b] = 1;
    measure(defective);
    for (const auto& [a, b] : defects) repair_topology(a, b);
    for (std::size_t l = 0; l < asked_.size(); ++l)
      if (asked_[l] && cells_[l].farthest > 0) {
        repair_.seeds.push_back(cells_[l].far_sample);
        if (l >= options_.given) repair_.seeds.push_back(seeds_[l]);
      }
    return std::move(repair_);
  }

 private:
  template <typename Visit>
  void for_samples(const std::vector<char>& defective, const Visit& visit) const {
    for (const SampleBlock& block : samples_.blocks) {
      const Vec3 center = samples_.block_center(block);
      for (std::uint32_t i = block.begin; i < block.end; ++i)
        if (defective[labels_[i]]) visit(i, cells_index(i), center + Vec3{samples_.x[i], samples_.y[i], samples_.z[i]});
    }
  }
  std::uint32_t cells_index(std::uint32_t sample) const { return labels_[sample]; }

  void measure(const std::vector<char>& defective) {
    for_samples(defective, [&](std::uint32_t i, std::uint32_t l, const Vec3& p) {
      Cell& cell = cells_[l];
      ++cell.samples;
      cell.area += samples_.area[i];
      cell.moment += double(samples_.area[i]) * p;
    });
    for_samples(defective, [&](std::uint32_t, std::uint32_t l, const Vec3& p) {
      Cell& cell = cells_[l];
      const double distance = squared_norm(p - seeds_[l]);
      if (distance > cell.farthest) {
        cell.farthest = distance;
        cell.far_sample = p;
      }
    });
  }

  void repair_topology(std::uint32_t a, std::uint32_t b) {
    const Vec3 p = cells_[a].centroid(seeds_[a]), q = cells_[b].centroid(seeds_[b]), middle = 0.5 * (p + q);
    const double size = std::sqrt(std::max(cells_[a].area, cells_[b].area));
    const double reach = std::min(options_.edge, 0.5 * norm(p - q) + 0.6 * size + 2 * samples_.grid.spacing);
    if (options_.seeds_only) {
      asked_[a] = asked_[b] = 1;
      return;
    }
    bool ambiguous = false;
    ambiguous_faces_.near(middle, reach, [&](std::uint32_t i) {
      ambiguous = true;
      if (!planned_[i]) {
        planned_[i] = 1;
        put_ball(ambiguous_faces_[i]);
      }
    });
    if (ambiguous) return;
    if (std::min(cells_[a].samples, cells_[b].samples) < fewest_samples) return put_ball(middle);
    if (options_.prefer_balls && unresolved_near(middle)) return put_ball(middle);
    asked_[a] = asked_[b] = 1;
  }

  /// Far from all ambiguous faces, those under balls included, the grid does resolve the shape, however fine its
  /// features are.
  bool unresolved_near(const Vec3& p) const {
    const double reach = 3 * options_.edge;
    bool found = ambiguous_faces_.near(p, reach, [](std::uint32_t) { return true; });
    balls_.near(p, reach, [&](std::uint32_t b) { found |= norm(p - balls_.balls()[b].center) < reach; });
    return found;
  }

  /// A new ball, unless one is here already: that one grows, once per round.
  void put_ball(const Vec3& p) {
    const double start = 0.5 * options_.edge, most = options_.edge, step = 0.125 * options_.edge;
    bool met = false;
    balls_.near(p, 0.25 * options_.edge, [&](std::uint32_t b) {
      Ball& ball = repair_.balls[b];
      if (met || norm(p - ball.center) > balls_.balls()[b].radius + 0.25 * options_.edge) return;
      if (!grown_[b] && ball.radius + 0.5 * step > most) return;
      met = true;
      if (grown_[b]) return;
      grown_[b] = 1;
      ball.radius += step;
      repair_.changed.push_back(b);
    });
    new_balls_.near(p, 0,
                    [&](std::uint32_t b) { met |= squared_norm(p - new_balls_.balls()[b].center) < start * start; });
    if (met) return;
    repair_.changed.push_back(static_cast<std::uint32_t>(repair_.balls.size()));
    repair_.balls.push_back({p, start});
    new_balls_.add({p, start});
  }

  const SampleSet& samples_;
  std::span<const std::uint32_t> labels_;
  std::span<const Vec3> seeds_;
  PointHash ambiguous_faces_;
  const BallIndex& balls_;
  const TopologyRepairOptions& options_;
  BallIndex new_balls_;
  std::vector<char> planned_;  ///< ambiguous faces that have been seen to
  std::vector<Cell> cells_;
  std::vector<char> asked_, grown_;
  TopologyRepair repair_;
};

}  // namespace

TopologyRepair plan_topology_repair(const SampleSet& samples, std::span<const std::uint32_t> labels,
                                    std::span<const Vec3> seeds,
                                    std::span<const std::pair<std::uint32_t, std::uint32_t>> defects,
                                    std::span<const Vec3> ambiguous_faces, const BallIndex& balls,
                                    const TopologyRepairOptions& options) {
  return Planner(samples, labels, seeds, ambiguous_faces, balls, options).plan(defects);
}

void clear_around(std::vector<Vec3>& seeds, const BallIndex& balls, std::span<const std::uint32_t> changed,
                  double edge) {
  std::vector<char> is_changed(balls.balls().size(), 0);
  for (const std::uint32_t b : changed) is_changed[b] = 1;
  std::vector<Vec3> kept;
  std::vector<std::size_t> near_balls;
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    bool near = false;
    balls.near(seeds[s], edge, [&](std::uint32_t b) {
      near |= is_changed[b] && norm(seeds[s] - balls.balls()[b].center) < balls.balls()[b].radius + edge;
    });
    if (near)
      near_balls.push_back(s);
    else
      kept.push_back(seeds[s]);
  }
  // Few seeds lie here, in small groups: earlier ones, which were in balance, stay.
  std::vector<Vec3> around;
  around.reserve(near_balls.size());
  for (const std::size_t s : near_balls) around.push_back(balls.outside(seeds[s]));
  const double least = 0.6 * edge;
  const PointHash index(around, least);
  std::vector<char> gone(around.size(), 0);
  for (std::uint32_t s = 0; s < around.size(); ++s) {
    if (gone[s]) continue;
    kept.push_back(around[s]);
    index.near(around[s], least, [&](std::uint32_t t) {
      if (t > s) gone[t] = 1;
    });
  }
  seeds = std::move(kept);
}

void remove_common_cells(const SampleSet& samples, Seeds& all, std::span<const std::uint32_t> labels,
                         std::size_t count) {
  std::vector<Vec3>& seeds = all.positions;
  if (seeds.empty()) return;
  std::vector<double> share(seeds.size(), 0);
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labels[i] < share.size()) share[labels[i]] += samples.share(i);
  std::vector<double> sorted = share;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle, apart = 1.6 * std::sqrt(median);
  std::vector<std::uint32_t> order;
  for (auto s = static_cast<std::uint32_t>(all.fixed.size()); s < seeds.size(); ++s)
    if (share[s] >= 0.9 * median) order.push_back(s);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return share[a] != share[b] ? share[a] < share[b] : a < b; });

  const PointHash index(seeds, apart);
  std::vector<char> gone(seeds.size(), 0), beside(seeds.size(), 0);
  for (const std::uint32_t s : order) {
    if (count == 0) break;
    if (beside[s]) continue;
    gone[s] = 1;
    --count;
    index.near(seeds[s], apart, [&](std::uint32_t t) { beside[t] = 1; });
  }
  std::size_t kept = 0;
  for (std::size_t s = 0; s < seeds.size(); ++s)
    if (!gone[s]) seeds[kept++] = seeds[s];
  seeds.resize(kept);
}

}  // namespace evenmesh
