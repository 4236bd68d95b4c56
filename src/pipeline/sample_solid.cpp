#include <algorithm>
#include <cmath>

#include "band/enclosed.h"
#include "evenmesh/error.h"
#include "grid/density.h"
#include "grid/surface_components.h"
#include "pipeline/sampling.h"

namespace evenmesh {
namespace {

constexpr int attempts = 4;            ///< to find the resolution of a surface without a size of its own
constexpr double fractal_alpha = 150;  ///< samples per seed there
constexpr std::size_t min_resolution = 24;
constexpr double gap_per_edge = 0.9;     ///< width of gaps that are filled with the cavities
constexpr double worth_filling = 0.05;   ///< share of the area that gaps hide
constexpr double max_unresolved = 0.02;  ///< share of crossings: rays that graze a curved surface lose up to 1 %

class SolidSampling {
 public:
  SolidSampling(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                ExecutionContext& context)
      : sampler_(sampler), options_(options), timer_(timer), context_(context) {
    result_.plan = std::move(plan);
    result_.findings = std::move(result_.plan.findings);
  }

  Sampling result() {
    sample();
    const double h = result_.samples.grid.spacing;
    const double surprise = static_cast<double>(result_.samples.size()) / (result_.plan.samples_per_h2 / (h * h));
    if (result_.plan.refinable && (surprise > 2 || surprise < 0.6)) sample_again();
    weigh();
    if (result_.plan.small_components > 0 || surprise > 2) drop_small();
    return std::move(result_);
  }

 private:
  void sample() {
    const Grid grid = make_grid(sampler_.bounds(), result_.plan.grid.resolution);
    result_.samples = timer_.stage("sample", 0.1, [&] { return sampler_.sample(grid, context_); });
    result_.filled_cavities = 0;
    if (!options_.fill_cavities) return;
    timer_.stage("sample", 0, [&] {
      fill();
      if (fill_gaps()) fill();
    });
  }

  void fill() {
    RemainingSurface rest = fill_cavities(std::move(result_.samples), context_);
    result_.samples = std::move(rest.samples);
    result_.filled_cavities += rest.dropped;
  }

  /// An edge cannot go where the outside is narrower: much surface there is not worth its vertices. Little is left to
  /// the topology's repair.
  bool fill_gaps() {
    SampleSet& samples = result_.samples;
    if (samples.size() == 0) return false;
    const double h = samples.grid.spacing, area = samples.total_area;
    if (gap_ == 0) gap_ = gap_per_edge * edge_length_of(area, static_cast<double>(result_.plan.vertices));
    const auto reach = static_cast<unsigned>(std::clamp(std::round(0.5 * gap_ / h), 1.0, 10.0));
    SampleSet filled = narrow_gaps_filled(samples, reach, context_);
    result_.hidden_area = std::max(0.0, area - filled.total_area);
    if (result_.hidden_area < worth_filling * area) {
      result_.hidden_area = 0;
      return false;
    }
    result_.gap = 2 * reach * h;
    samples = std::move(filled);
    return true;
  }

  /// Fractals have more area the closer one looks, and thin parts may have been seen in pieces only.
  void sample_again() {
    for (int attempt = 0; attempt < attempts; ++attempt) {
      const double alpha = static_cast<double>(result_.samples.size()) / static_cast<double>(result_.plan.vertices);
      if (alpha > 0.6 * fractal_alpha && alpha < 1.4 * fractal_alpha) return;
      const double better = static_cast<double>(result_.plan.grid.resolution) * std::sqrt(fractal_alpha / alpha);
      set_resolution(better);
      sample();
    }
  }
  void set_resolution(double cells) {
    result_.plan.grid.resolution = std::clamp(static_cast<std::size_t>(cells), min_resolution, max_resolution);
  }

  /// Smaller cells need a finer grid.
  void weigh() {
    if (!options_.density) return;
    const auto weigh = [&] { return apply_density(result_, options_.density, context_); };
    const double finer = std::sqrt(std::min(16.0, timer_.stage("sample", 0, weigh)));
    if (!result_.plan.refinable || finer < 1.1) return;
    set_resolution(finer * static_cast<double>(result_.plan.grid.resolution));
    sample();
    timer_.stage("sample", 0, weigh);
  }

  /// Thousands of components smaller than a cell would keep seeds busy in vain.
  void drop_small() {
    const double cell = result_.samples.total_area / static_cast<double>(result_.plan.vertices);
    timer_.stage("sample", 0, [&] {
      RemainingSurface rest = drop_small_components(std::move(result_.samples), cell, context_);
      result_.samples = std::move(rest.samples);
      result_.dropped_components = rest.dropped;
    });
    if (result_.samples.size() < result_.plan.vertices)
      throw UnusableInput("the surface consists of specks smaller than a cell: ask for more vertices");
  }

  const Sampler& sampler_;
  const MeshOptions& options_;
  StageTimer& timer_;
  ExecutionContext& context_;
  Sampling result_;
  double gap_ = 0;  // width of the gaps to fill, model units; 0: not known yet
};

void add_findings(const Sampler& sampler, Sampling& sampling) {
  const SampleSet& samples = sampling.samples;
  const auto say = [&](FindingCode code, std::vector<std::pair<std::string, FindingValue>> values = {}) {
    sampling.findings.push_back(make_finding(code, std::move(values)));
  };
  if (const std::size_t count = sampling.filled_cavities; count > 0)
    say(FindingCode::cavities_filled, {{"count", static_cast<double>(count)},
                                       {"surfaces", std::string(count == 1 ? "surface" : "surfaces")},
                                       {"them", std::string(count == 1 ? "it" : "them")}});
  if (sampling.hidden_area > 0)
    say(FindingCode::narrow_gaps_filled, {{"gap", sampling.gap}, {"area", sampling.hidden_area}});
  if (samples.disagreements > 0)
    say(FindingCode::inside_by_vote, {{"count", static_cast<double>(samples.disagreements)}});
  if (const std::size_t non_finite = sampler.non_finite(); non_finite > 0)
    say(FindingCode::not_finite, {{"name", sampler.name()}, {"count", static_cast<double>(non_finite)}});
  if (samples.cut_by_bounds && !sampler.capped_by_bounds()) say(FindingCode::closed_by_bounds);
  const double all = static_cast<double>(samples.size() + samples.unresolved);
  if (static_cast<double>(samples.unresolved) > max_unresolved * all)
    say(FindingCode::crossings_unresolved, {{"spacing", samples.grid.spacing},
                                            {"count", static_cast<double>(samples.unresolved)},
                                            {"all", all},
                                            {"finer", 2.0 * static_cast<double>(sampling.plan.grid.resolution)}});
}

}  // namespace

Sampling sample_solid(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                      ExecutionContext& context) {
  Sampling sampling = SolidSampling(sampler, std::move(plan), options, timer, context).result();
  add_findings(sampler, sampling);
  return sampling;
}

}  // namespace evenmesh
