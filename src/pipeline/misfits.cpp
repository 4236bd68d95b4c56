#include "pipeline/misfits.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/random.h"

namespace evenmesh {
namespace {

/// Cells that do not suit their seeds, where a coarser mesh could not follow the shape.
constexpr double too_heavy = 2.5, too_light = 0.25;  ///< mass, compared with what it should be
constexpr double too_far = 0.5;                      ///< of the centroid from the seed, in edges
constexpr std::size_t misfit_evaluations = 15;

/// By seed, the mass its cell should have.
std::vector<double> wanted_masses(const SampleSet& samples, std::span<const Vec3> seeds, const SizingField& sizing) {
  std::vector<double> mass;
  for (const Vec3& s : seeds) mass.push_back(sizing.uniform() ? 1 : 1 / (sizing.edge(s) * sizing.edge(s)));
  const double scale = samples.total_weight / std::accumulate(mass.begin(), mass.end(), 0.0);
  for (double& m : mass) m *= scale;
  return mass;
}

/// Seeds more in heavy cells, fewer in light ones, and balance around these and around those that are off.
class MisfitRepair {
 public:
  /// @param thinner  of the same surface, maybe with fewer samples: enough to tell what does not fit
  MisfitRepair(Tessellator& state, CellEvaluator& thinner)
      : state_(state), thinner_(thinner), seeds_(state.result.seeds.positions) {}

  void run(std::size_t least, std::size_t most) {
    change_misfits();
    const std::size_t count = std::clamp(seeds_.size(), least, most);
    if (count != seeds_.size()) {
      const std::vector<Vec3> before = seeds_;
      state_.adjust_count(count, 3);
      // Those that stay keep their order.
      std::size_t same = 0;
      for (const Vec3& p : before)
        if (same < seeds_.size() && p == seeds_[same])
          ++same;
        else
          places_.push_back(p);
      places_.insert(places_.end(), seeds_.begin() + static_cast<std::ptrdiff_t>(same), seeds_.end());
    }
    state_.context.log(fmt::format("levels: {} seeds, {} places do not suit them", seeds_.size(), places_.size()));
    state_.relax_around(places_, misfit_evaluations);
    state_.settle();
  }

 private:
  void change_misfits() {
    const SampleSet& samples = thinner_.samples();
    const SizingField& sizing = state_.result.sampling.sizing;
    CellSums sums;
    thinner_.evaluate(seeds_, sums);
    state_.result.energy_ratio = energy_ratio(sums.energy, seeds_.size(), samples.total_area);
    const std::vector<double> wanted = wanted_masses(samples, seeds_, sizing);
    std::vector<Vec3> kept, added;
    for (std::size_t i = 0; i < seeds_.size(); ++i) {
      const bool fixed = state_.result.seeds.is_fixed(i);
      const double share = sums.mass[i] / wanted[i], edge = sizing.edge(seeds_[i]);
      const bool light = !fixed && share < too_light;
      const Vec3 off = share > 0 ? (1 / sums.mass[i]) * sums.moment[i] : Vec3{};
      if (light || share > too_heavy || (!fixed && norm(off) > too_far * edge)) places_.push_back(seeds_[i]);
      if (!light) kept.push_back(seeds_[i]);
      Random random(state_.options.seed + i);
      for (double left = share; left > too_heavy; left -= 1) {
        const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
        added.push_back(seeds_[i] + off + 0.3 * edge * normalized(Vec3{x, y, z}));
      }
    }
    seeds_ = std::move(kept);
    seeds_.insert(seeds_.end(), added.begin(), added.end());
    places_.insert(places_.end(), added.begin(), added.end());
  }

  Tessellator& state_;
  CellEvaluator& thinner_;
  std::vector<Vec3>& seeds_;
  std::vector<Vec3> places_;
};

}  // namespace

void repair_misfits(Tessellator& state, CellEvaluator& thinner, std::size_t least, std::size_t most) {
  MisfitRepair(state, thinner).run(least, most);
}

}  // namespace evenmesh
