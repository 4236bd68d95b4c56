#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"
#include "grid/density.h"
#include "grid/surface_components.h"
#include "grid/thin_spots.h"
#include "pipeline/lost_pieces.h"
#include "pipeline/sampling.h"

namespace evenmesh {
namespace {

constexpr int attempts = 4;            ///< to find the resolution of a surface without a size of its own
constexpr double fractal_alpha = 150;  ///< samples per seed there
constexpr std::size_t min_resolution = 24;
constexpr double even_thickness = 0.4;   ///< of walls: all but a tenth is at least that much of the median
constexpr double max_unresolved = 0.02;  ///< share of crossings: rays that graze a curved surface lose up to 1 %

/// Those that were missed included.
double whole_samples(const SampleSet& samples) {
  return static_cast<double>(samples.size() + samples.unresolved);
}

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
    if (result_.plan.refinable) resolve_thin_parts();
    weigh();
    if (result_.plan.small_components > 0 || surprise > 2) drop_small();
    add_lost_pieces();
    return std::move(result_);
  }

 private:
  void sample() {
    const Grid grid = make_grid(sampler_.bounds(), result_.plan.grid.resolution);
    result_.samples = timer_.stage("sample", 0.1, [&] { return sampler_.sample(grid, context_); });
    result_.filled_cavities = 0;
    result_.thin = wide_spots(std::exchange(result_.samples.thin, {}), grid.origin, grid.spacing);
    if (!options_.fill_cavities) return;
    std::erase_if(result_.thin, [](const ThinSpot& spot) { return spot.gap; });
    timer_.stage("sample", 0, [&] {
      fill();
      if (fill_narrow_gaps(result_, ", or take --hull all", context_)) fill();
    });
  }

  void fill() {
    RemainingSurface rest = fill_cavities(std::move(result_.samples), context_);
    result_.samples = std::move(rest.samples);
    result_.filled_cavities += rest.dropped;
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

  /// Walls and gaps that were missed need a grid point or two between their sides, as long as samples are not too many.
  void resolve_thin_parts() {
    const double planned = static_cast<double>(result_.plan.grid.resolution);
    const double vertices = static_cast<double>(result_.plan.vertices);
    const double affordable = affordable_samples(vertices);
    ThinParts parts;
    for (int attempt = 0; attempt < attempts && !result_.thin.empty(); ++attempt) {
      const double edge = edge_length_of(result_.samples.total_area, vertices), h = result_.samples.grid.spacing;
      const ThinParts missed = thin_parts(result_.thin, edge);
      if (missed.area < min_missed_area * edge * edge) break;
      // Where the surface tapers off some of it is thinner than any grid.
      if (missed.least < even_thickness * missed.thickness) break;
      const double finer = cells_across_wall * h / missed.least;
      if (whole_samples(result_.samples) * finer * finer > affordable) break;
      parts = missed;
      set_resolution(resolution_for(missed.least, result_));
      sample();
    }
    if (parts.area > 0)
      result_.findings.push_back(
          make_finding(FindingCode::grid_refined, {{"thickness", parts.thickness},
                                                   {"area", parts.area},
                                                   {"resolution", static_cast<double>(result_.plan.grid.resolution)},
                                                   {"planned", planned}}));
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

  /// Those that no ray hits go without being dropped.
  void add_lost_pieces() {
    const Mesh* mesh = sampler_.input_mesh();
    if (mesh == nullptr) return;
    const std::size_t lost = timer_.stage("sample", 0, [&] {
      return count_lost_pieces(*mesh, sampler_.bounds(), result_.samples,
                               result_.samples.total_area / static_cast<double>(result_.plan.vertices));
    });
    result_.dropped_components = std::max(result_.dropped_components, lost);
  }

  const Sampler& sampler_;
  const MeshOptions& options_;
  StageTimer& timer_;
  ExecutionContext& context_;
  Sampling result_;
};

void add_findings(const Sampler& sampler, Sampling& sampling, const ExecutionContext& context) {
  const SampleSet& samples = sampling.samples;
  const auto say = [&](FindingCode code, std::vector<std::pair<std::string, FindingValue>> values = {}) {
    sampling.findings.push_back(make_finding(code, std::move(values)));
  };
  add_one_sided(sampler, sampling, context);
  if (const std::size_t count = sampling.filled_cavities; count > 0)
    say(FindingCode::cavities_filled, {{"count", static_cast<double>(count)},
                                       {"surfaces", std::string(count == 1 ? "surface" : "surfaces")},
                                       {"them", std::string(count == 1 ? "it" : "them")}});
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
  add_findings(sampler, sampling, context);
  return sampling;
}

}  // namespace evenmesh
