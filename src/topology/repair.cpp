#include "topology/repair.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/point_hash.h"

namespace evenmesh {
namespace {

constexpr std::size_t fewest_samples = 12;  ///< of a cell that may still be divided: three or four grid cells across

/// A cell that has a defect.
struct Cell {
  std::vector<Vec3> samples;
  double area = 0;
  Vec3 moment;
  Vec3 centroid(const Vec3& seed) const { return area > 0 ? moment / area : seed; }

  /// Calls use(p) for up to `count` samples, each the farthest from the seed and those before it, as long as they are
  /// apart.
  template <typename Use>
  void for_far_samples(const Vec3& seed, std::size_t count, double apart, const Use& use) const {
    std::vector<double> distance(samples.size(), std::numeric_limits<double>::infinity());
    Vec3 last = seed;
    for (std::size_t n = 0; n < count; ++n) {
      std::size_t farthest = 0;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        distance[i] = std::min(distance[i], squared_norm(samples[i] - last));
        if (distance[i] > distance[farthest]) farthest = i;
      }
      if (samples.empty() || distance[farthest] <= (n == 0 ? 0 : apart * apart)) return;
      last = samples[farthest];
      use(last);
    }
  }
};

class Planner {
 public:
  Planner(const SampleSet& samples, std::span<const std::uint32_t> labels, std::span<const Vec3> seeds,
          std::span<const Vec3> ambiguous_faces, const BallIndex& places, const TopologyRepairOptions& options)
      : samples_(samples),
        labels_(labels),
        seeds_(seeds),
        ambiguous_faces_(ambiguous_faces, options.edge),
        places_(places),
        options_(options),
        new_places_({}, options.first_radius),
        planned_(ambiguous_faces.size(), 0),
        cells_(seeds.size()),
        asked_(seeds.size(), 0) {
    repair_.places = places.balls();
    grown_.assign(repair_.places.size(), 0);
  }

  TopologyRepair plan(std::span<const std::pair<std::uint32_t, std::uint32_t>> defects) {
    std::vector<char> defective(seeds_.size(), 0);
    for (const auto& [a, b] : defects) defective[a] = defective[b] = 1;
    measure(defective);
    for (const auto& [a, b] : defects) repair_topology(a, b);
    for (std::size_t l = 0; l < asked_.size(); ++l) {
      if (!asked_[l]) continue;
      const std::size_t before = repair_.seeds.size();
      cells_[l].for_far_samples(seeds_[l], options_.seeds_per_cell, samples_.grid.spacing,
                                [&](const Vec3& p) { repair_.seeds.push_back(p); });
      if (l >= options_.given && repair_.seeds.size() > before) repair_.seeds.push_back(seeds_[l]);
    }
    return std::move(repair_);
  }

 private:
  void measure(const std::vector<char>& defective) {
    for (const SampleBlock& block : samples_.blocks) {
      const Vec3 center = samples_.block_center(block);
      for (std::uint32_t i = block.begin; i < block.end; ++i) {
        const std::uint32_t l = labels_[i];
        if (l >= defective.size() || !defective[l]) continue;
        Cell& cell = cells_[l];
        const Vec3 p = center + Vec3{samples_.x[i], samples_.y[i], samples_.z[i]};
        cell.samples.push_back(p);
        cell.area += samples_.area[i];
        cell.moment += double(samples_.area[i]) * p;
      }
    }
  }

  void repair_topology(std::uint32_t a, std::uint32_t b) {
    const Vec3 p = cells_[a].centroid(seeds_[a]), q = cells_[b].centroid(seeds_[b]), middle = 0.5 * (p + q);
    const double size = std::sqrt(std::max(cells_[a].area, cells_[b].area));
    const double reach = std::min(options_.edge, 0.5 * norm(p - q) + 0.6 * size + 2 * samples_.grid.spacing);
    if (options_.seeds_only) {
      asked_[a] = asked_[b] = 1;
      return;
    }
    bool is_new = false;
    ambiguous_faces_.near(middle, reach, [&](std::uint32_t i) {
      if (!planned_[i]) is_new |= put_place(ambiguous_faces_[i]);
      planned_[i] = 1;
    });
    if (is_new) return;
    const bool few_samples = std::min(cells_[a].samples.size(), cells_[b].samples.size()) < fewest_samples;
    if ((few_samples || options_.prefer_places) && unresolved_near(middle) && put_place(middle)) return;
    asked_[a] = asked_[b] = 1;
  }

  /// Far from all ambiguous faces, those that were filled included, the grid does resolve the shape, however
  /// fine its features are.
  bool unresolved_near(const Vec3& p) const {
    const double reach = 3 * options_.edge;
    bool found = options_.unresolved || ambiguous_faces_.near(p, reach, [](std::uint32_t) { return true; });
    places_.near(p, reach, [&](std::uint32_t b) { found |= norm(p - places_.balls()[b].center) < reach; });
    return found;
  }

  /// A new place, unless one is here already: that one grows, once per round. Whether that is all to be done: else
  /// seeds are needed, too.
  bool put_place(const Vec3& p) {
    const double reach = options_.unresolved ? 0.25 * options_.edge : 0;
    bool met = false, is_new = true;
    places_.near(p, reach, [&](std::uint32_t b) {
      Ball& place = repair_.places[b];
      if (met || norm(p - place.center) > places_.balls()[b].radius + reach) return;
      const bool full = place.radius + 0.5 * options_.growth > options_.last_radius;
      if (options_.unresolved && full && !grown_[b]) return;  // the next one stands beside it
      met = true;
      is_new = options_.unresolved;
      if (grown_[b] || full) return;
      grown_[b] = 1;
      place.radius += options_.growth;
      repair_.changed.push_back(b);
    });
    const double apart = 0.7 * options_.first_radius;
    new_places_.near(p, 0,
                     [&](std::uint32_t b) { met |= squared_norm(p - new_places_.balls()[b].center) < apart * apart; });
    if (met) return is_new;
    repair_.changed.push_back(static_cast<std::uint32_t>(repair_.places.size()));
    repair_.places.push_back({p, options_.first_radius});
    new_places_.add({p, options_.first_radius});
    return true;
  }

  const SampleSet& samples_;
  std::span<const std::uint32_t> labels_;
  std::span<const Vec3> seeds_;
  PointHash ambiguous_faces_;
  const BallIndex& places_;
  const TopologyRepairOptions& options_;
  BallIndex new_places_;
  std::vector<char> planned_;  ///< ambiguous faces that have been seen to
  std::vector<Cell> cells_;
  std::vector<char> asked_, grown_;
  TopologyRepair repair_;
};

}  // namespace

TopologyRepair plan_topology_repair(const SampleSet& samples, std::span<const std::uint32_t> labels,
                                    std::span<const Vec3> seeds,
                                    std::span<const std::pair<std::uint32_t, std::uint32_t>> defects,
                                    std::span<const Vec3> ambiguous_faces, const BallIndex& places,
                                    const TopologyRepairOptions& options) {
  return Planner(samples, labels, seeds, ambiguous_faces, places, options).plan(defects);
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
