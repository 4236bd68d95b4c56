#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "band/enclosed.h"
#include "band/filled_gaps.h"
#include "band/narrow_band.h"
#include "evenmesh/error.h"
#include "grid/blocks.h"
#include "pipeline/sampling.h"

namespace evenmesh {
namespace {

/// Fills in kept.shell and kept.shell_cut as far as asked for.
void keep_shell(const NarrowBand& band, const Box& bounds, Artifacts& kept) {
  if (!kept.shell && !kept.shell_cut) return;
  const VoxelGrid& grid = band.grid();
  const SparseVolume empty{.name = "distance",
                           .origin = grid.center({0, 0, 0}),
                           .side = grid.side,
                           .background = static_cast<float>(grid.side * (band.reach() + 1))};
  if (kept.shell) kept.shell = empty;
  if (kept.shell_cut) kept.shell_cut = empty;
  const Vec3 size = bounds.size(), middle = (bounds.center() - grid.origin) / grid.side;
  const std::size_t across = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  const auto layer = static_cast<std::int32_t>(middle[static_cast<int>(across)]);
  const auto add = [&](SparseVolume& volume, const Voxel& at, NearestSite nearest) {
    volume.voxels.push_back(at);
    volume.values.push_back(static_cast<float>(grid.side * std::sqrt(nearest.squared_distance())));
  };
  for (std::size_t t = 0; t < band.tiles().size(); ++t) {
    const Voxel corner = band.tiles()[t].corner();
    const bool in_cut = kept.shell_cut && corner[across] / std::int32_t{tile_size} == layer / std::int32_t{tile_size};
    if (!kept.shell && !in_cut) continue;
    const NearestSite* nearest = band.nearest(t).data();
    for_each_voxel(band.tiles()[t], [&](unsigned x, unsigned y, unsigned z) {
      const Voxel at{corner[0] + std::int32_t(x), corner[1] + std::int32_t(y), corner[2] + std::int32_t(z)};
      if (kept.shell) add(*kept.shell, at, *nearest);
      if (in_cut && at[across] == layer) add(*kept.shell_cut, at, *nearest);
      ++nearest;
    });
  }
}

class BandSampling {
 public:
  BandSampling(const Sampler& sampler, const MeshOptions& options, StageTimer& timer, ExecutionContext& context,
               Artifacts& kept)
      : sampler_(sampler), options_(options), timer_(timer), context_(context), kept_(kept) {}

  /// Samples, and once more on a finer grid where so little of the input counts that seeds would starve.
  Sampling result(Plan plan) {
    const std::vector<Finding> findings = std::move(plan.findings);
    const double samples = once(plan), wanted = wanted_alpha * static_cast<double>(plan.vertices);
    if (plan.refinable && samples <= 0.6 * wanted) once(finer(plan, std::sqrt(wanted / std::max(1.0, samples))));
    result_.findings.insert(result_.findings.begin(), findings.begin(), findings.end());
    limit_vertices();
    if (result_.plan.route == Route::sheets)
      say_what_sheets_lost();
    else
      say_where_wrap_lies();
    return std::move(result_);
  }

 private:
  static Plan finer(Plan plan, double times) {
    times = std::min(3.0, times);
    const double resolution = times * static_cast<double>(plan.grid.resolution);
    plan.grid.resolution = std::min(max_resolution, static_cast<std::size_t>(resolution));
    if (plan.grid.bridge > 0)
      plan.grid.bridge = std::min(max_thickness, static_cast<unsigned>(std::ceil(times * plan.grid.bridge)));
    return plan;
  }

  std::string nothing_seen() const {
    if (!sampler_.point_spacing()) return "nothing of the surface lies within the bounds";
    return sampler_.name() +
           ": the points show no surface: too few lie around each of them to tell a plane there; take more points, or "
           "bridge wider gaps with --thickness (up to 20)";
  }

  /// Returns the samples that an even mesh would need to have the same for its cells as the smallest have.
  double once(const Plan& plan) {
    result_ = {};  // frees the memory first
    narrowest_.reset();
    result_.plan = plan;
    const SiteVoxels sites = timer_.stage("voxelize", 0.05, [&] { return sampler_.voxelize(plan.grid, context_); });
    if (sites.size() == 0) throw UnusableInput(nothing_seen());
    result_.sites = sites.size();
    if (plan.route == Route::sheets)
      sample_sheets(sites);
    else
      sample_enclosed(sites);
    const double samples = static_cast<double>(result_.samples.size());
    if (!options_.density) return samples;
    return std::floor(samples / std::clamp(apply_density(result_, options_.density, context_), 1.0, 16.0));
  }

  NarrowBand band_around(const SiteVoxels& sites) {
    NarrowBand band = sampler_.narrow_band(sites, result_.plan.grid.thickness, context_);
    result_.band_voxels = band.size();
    keep_shell(band, sampler_.bounds(), kept_);
    return band;
  }

  void sample_sheets(const SiteVoxels& sites) {
    SheetSampling& sheet = result_.sheet.emplace();
    std::vector<FilledGap> gaps;
    timer_.stage("shell", 0.1, [&] {
      const NarrowBand band = band_around(sites);
      sheet.both_sides = band_surface(band, sites, context_);
      gaps = filled_gaps(band, sites, context_);
    });
    timer_.stage("sheets", 0.1, [&] { choose(sites, sheet); });
    if (result_.samples.size() == 0)
      throw UnusableInput("no piece of the surface is large enough for this fineness: ask for more vertices");
    result_.dropped_components = sheet.sheets.dropped;
    find_merges(std::move(gaps));
  }

  void choose(const SiteVoxels& sites, SheetSampling& sheet) {
    const SampleSet& both = sheet.both_sides.samples;
    // Less is not worth a triangle; of points, what noise makes is larger.
    const double cell = 0.5 * both.total_area / static_cast<double>(result_.plan.vertices);
    const double min_area = (sampler_.point_spacing() ? 10 : 1) * cell;
    sheet.sheets = choose_sheets(sheet.both_sides, sites, min_area, context_);
    for (std::uint32_t i = 0; i < sheet.sheets.chosen.size(); ++i)
      if (sheet.sheets.chosen[i]) sheet.chosen.push_back(i);
    result_.samples = gather(both, sheet.chosen, context_);
    sheet.on_surface = drawn_onto_surface(result_.samples, sheet.chosen, sheet.both_sides, sites, context_);
  }

  void sample_enclosed(const SiteVoxels& sites) {
    result_.samples = timer_.stage("shell", 0.1, [&] {
      const BandSurface surface = band_surface(band_around(sites), sites, context_);
      const SiteVoxels border = outer_border(surface, outer_sheets(surface, context_), sites.grid, context_);
      const NarrowBand eroded = sampler_.narrow_band(border, result_.plan.grid.thickness - 1, context_);
      return enclosed_by(band_surface(eroded, border, context_), context_);
    });
    if (result_.samples.size() == 0) throw UnusableInput("the surface is too small for its grid: raise the resolution");
    if (options_.fill_cavities) timer_.stage("shell", 0, [&] { fill_narrow_gaps(result_, "", context_); });
  }

  /// Counts the gaps that hide surface; elsewhere it is still seen from its other side.
  void find_merges(std::vector<FilledGap> gaps) {
    const SheetSampling& sheet = *result_.sheet;
    std::vector<char> seen(result_.sites, 0);
    for (const std::uint32_t i : sheet.chosen) seen[sheet.both_sides.site[i]] = 1;
    std::erase_if(gaps, [&](const FilledGap& gap) {
      const auto count = std::count_if(gap.sites.begin(), gap.sites.end(), [&](auto s) { return seen[s] != 0; });
      return 2 * static_cast<std::size_t>(count) > gap.sites.size();
    });
    result_.merges = gaps.size();
    result_.thickness_apart = result_.plan.grid.thickness;
    if (gaps.empty()) return;
    narrowest_ = *std::min_element(gaps.begin(), gaps.end(), [](const FilledGap& a, const FilledGap& b) {
      return std::pair(a.kept_apart, a.width) < std::pair(b.kept_apart, b.width);
    });
    result_.thickness_apart = narrowest_->kept_apart;
  }

  /// Fewer seeds when the samples cannot feed as many.
  void limit_vertices() {
    const double asked = static_cast<double>(result_.plan.vertices);
    const double most = std::max(4.0, std::floor(static_cast<double>(result_.samples.size()) / min_alpha));
    if (asked <= most) return;
    say(FindingCode::vertices_limited, {{"asked", asked},
                                        {"alpha", min_alpha},
                                        {"resolution", static_cast<double>(result_.plan.grid.resolution)},
                                        {"vertices", most}});
    result_.plan.vertices = static_cast<std::size_t>(most);
  }

  void say_what_sheets_lost() {
    add_one_sided(sampler_, result_, context_);
    if (narrowest_ && !sampler_.point_spacing()) say_merges();
    if (const std::size_t cut = result_.sheet->sheets.cut; cut > 0)
      say(FindingCode::sheets_cut, {{"count", static_cast<double>(cut)}});
  }

  void say_merges() {
    const double resolution = static_cast<double>(result_.plan.grid.resolution);
    const double finer = std::ceil(3.5 * result_.samples.grid.spacing / narrowest_->width * resolution);
    std::string cure = fmt::format("no resolution up to {} keeps them apart", max_resolution);
    if (narrowest_->kept_apart > 0) {
      cure = fmt::format("--thickness {} keeps them apart", narrowest_->kept_apart);
    } else if (finer <= double(max_resolution)) {
      cure = fmt::format("-r {:.0f} --thickness 1 keeps them apart", finer);
    }
    say(FindingCode::sheets_merged,
        {{"width", narrowest_->width}, {"count", static_cast<double>(result_.merges)}, {"cure", cure}},
        narrowest_->middle);
  }

  void say_where_wrap_lies() {
    const double spacing = result_.samples.grid.spacing;
    say(FindingCode::wrap_distance, {{"distance", spacing}, {"gap", 2 * result_.plan.grid.thickness * spacing}});
  }

  void say(FindingCode code, std::vector<std::pair<std::string, FindingValue>> values, std::optional<Vec3> place = {}) {
    result_.findings.push_back(make_finding(code, std::move(values), place));
  }

  const Sampler& sampler_;
  const MeshOptions& options_;
  StageTimer& timer_;
  ExecutionContext& context_;
  Artifacts& kept_;
  Sampling result_;
  std::optional<FilledGap> narrowest_;
};

}  // namespace

Sampling sample_band(const Sampler& sampler, Plan plan, const MeshOptions& options, StageTimer& timer,
                     ExecutionContext& context, Artifacts& kept) {
  return BandSampling(sampler, options, timer, context, kept).result(std::move(plan));
}

}  // namespace evenmesh
