#include "pipeline/shell_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "band/filled_gaps.h"
#include "band/moving_least_squares.h"
#include "geometry/triangle.h"
#include "grid/blocks.h"
#include "grid/density.h"
#include "grid/surface_components.h"
#include "pipeline/plan.h"
#include "sample/sample.h"
#include "shape/sampler.h"

namespace evenmesh {
namespace {

constexpr double wanted_alpha = 100, min_alpha = 50;
constexpr double samples_per_voxel_area = 1.5;  ///< Σ |n_a|, the mean over all directions
constexpr std::size_t coarse = 128;             ///< resolution at which areas are estimated
constexpr unsigned default_thickness = 2, max_thickness = 20;

double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    area += triangle_area(a, b, c);
  }
  return area;
}

/// Up to the rounding of single precision.
bool on_a_line(const std::vector<Vec3>& points) {
  Vec3 along;
  for (const Vec3& p : points)
    if (squared_norm(p - points[0]) > squared_norm(along)) along = p - points[0];
  const double length = norm(along);
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return norm(cross(p - points[0], along)) <= 1e-6 * length * length; });
}

struct ShellPlan {
  std::size_t vertices = 0, resolution = 0;
  unsigned thickness = default_thickness;
  double spacing = 0;   ///< of points
  unsigned bridge = 0;  ///< voxels, half the width of the gaps between points that are closed
};

/// Area by triangles, points or a coarse sampling.
double estimated_area(const Shape& shape, double spacing, ExecutionContext& context) {
  if (const Mesh* mesh = shape.mesh()) return area_of(*mesh);
  if (const PointCloud* points = shape.points())
    return 0.75 * static_cast<double>(points->points.size()) * spacing * spacing;
  if (const Sampler* sampler = shape.sampler())
    return sampler->sample_surface(make_grid(shape.bounds, coarse), shape.bounds, context).total_area;
  return presample(shape, 0, context).area;
}

ShellPlan plan_shell(const Shape& shape, const MeshOptions& options, Report& report, ExecutionContext& context) {
  const PointCloud* points = shape.points();
  const double spacing = points ? point_spacing(*points, context) : 0;
  const double area = estimated_area(shape, spacing, context), longest = shape.bounds.longest_side();
  if (!(area > 0) || !(longest > 0) || (points && on_a_line(points->points)))
    throw UnusableInput("the input has no area: all its triangles or points lie on a line or in a point");
  ShellPlan plan;
  double vertices = 0;
  if (options.vertices) {
    vertices = static_cast<double>(*options.vertices);
  } else if (options.edge_length) {
    vertices = vertices_of(area, *options.edge_length);
  } else {
    vertices = std::clamp(vertices_of(area, shape.bounds.diagonal() / 80), 200.0, 1e6);
    report.notices.push_back(
        {false, fmt::format("no -n or -l given: {:.0f} vertices, from area {:.4g}", vertices, area)});
  }
  plan.vertices = static_cast<std::size_t>(std::max(4.0, std::round(vertices)));
  const double h = std::sqrt(samples_per_voxel_area * area / (wanted_alpha * static_cast<double>(plan.vertices)));
  double resolution = std::clamp(std::ceil(longest / h), 32.0, 8192.0);
  if (options.resolution) resolution = static_cast<double>(*options.resolution);
  plan.thickness = options.thickness.value_or(default_thickness);
  if (points) {
    // Random points leave gaps of up to about three times their spacing.
    const double voxels = 1.6 * spacing * resolution / longest;
    if (!options.resolution && voxels > max_thickness) resolution = std::floor(resolution * max_thickness / voxels);
    plan.spacing = spacing;
    plan.bridge = options.thickness.value_or(static_cast<unsigned>(
        std::clamp(std::ceil(1.6 * spacing * resolution / longest), double(default_thickness), double(max_thickness))));
    plan.thickness = default_thickness;
    report.notices.push_back(
        {false, fmt::format("points about {:.3g} apart: gaps of up to {:.3g} ({} voxels) are bridged", spacing,
                            2 * plan.bridge * longest / resolution, 2 * plan.bridge)});
  }
  plan.resolution = static_cast<std::size_t>(resolution);
  return plan;
}

SiteVoxels voxelize(const Shape& shape, const ShellPlan& plan, ExecutionContext& context) {
  const unsigned margin = std::max(plan.thickness, plan.bridge) + plan.thickness + 2;
  if (const Sampler* sampler = shape.sampler())
    return voxelize_samples(sampler->sample_surface(make_grid(shape.bounds, plan.resolution), shape.bounds, context),
                            margin, context);
  if (shape.compound())
    return voxelize_samples(sample_shape(shape, make_grid(shape.bounds, plan.resolution), context), margin, context);
  const VoxelGrid grid = make_voxel_grid(shape.bounds, plan.resolution, margin);
  if (const Mesh* mesh = shape.mesh()) return voxelize_mesh(*mesh, grid, context);
  if (const PointCloud* points = shape.points()) {
    SiteVoxels sparse = voxelize_points(points->points, points->normals, grid, context);
    if (sparse.size() == 0) return sparse;
    if (sparse.normal.empty()) estimate_normals(sparse, 2 * plan.bridge, context);
    return moving_least_squares(sparse, build_narrow_band(sparse, plan.bridge, context), plan.spacing,
                                !points->normals.empty(), context);
  }
  return voxelize_field(*shape.field(), grid, shape.bounds, context);
}

}  // namespace

namespace {

void report_sampling(const ShellPlan& plan, std::size_t samples, const SiteVoxels& sites, Report& report) {
  report.seeds_asked = plan.vertices;
  report.resolution = plan.resolution, report.thickness = plan.thickness;
  report.spacing = sites.grid.side;
  report.sites = sites.size(), report.samples = samples;
}

/// The sites around the outer border of a shell.
SiteVoxels outer_border(const BandSurface& surface, const Sheets& outer, const VoxelGrid& grid,
                        ExecutionContext& context) {
  const SampleSet& samples = surface.samples;
  std::vector<Vec3> points, normals;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      if (!outer.chosen[i]) continue;
      points.push_back(samples.block_center(block) + Vec3{samples.x[i], samples.y[i], samples.z[i]});
      normals.push_back(unpack_normal(samples.normal[i]));
    }
  return voxelize_points(points, normals, grid, context);
}

/// The inner side of a shell, turned around: the border of what the shell encloses.
SampleSet enclosed_by(const BandSurface& surface, ExecutionContext& context) {
  const SurfaceComponents parts = surface_components(surface.samples, context);
  std::vector<double> behind(parts.area.size(), 0);
  for (std::uint32_t i = 0; i < surface.samples.size(); ++i)
    if (surface.facing[i] < 0) behind[parts.part[i]] += surface.samples.area[i];
  const auto is_inner = [&](std::uint32_t i) { return behind[parts.part[i]] > 0.5 * parts.area[parts.part[i]]; };
  SampleSet samples = keep_samples(surface.samples, is_inner, context);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.edge[i].bits ^= 1;
    samples.normal[i] = pack_normal(-unpack_normal(samples.normal[i]));
  }
  return samples;
}

/// Samples, and once more on a finer grid where so little of the input counts that seeds would starve.
template <typename Sample>
void sample_well(ShellPlan plan, bool may_refine, const Sample& sample) {
  const std::size_t samples = sample(plan);
  const double wanted = wanted_alpha * static_cast<double>(plan.vertices);
  if (!may_refine || static_cast<double>(samples) > 0.6 * wanted) return;
  const double finer = std::min(3.0, std::sqrt(wanted / static_cast<double>(std::max<std::size_t>(1, samples))));
  plan.resolution = std::min<std::size_t>(8192, static_cast<std::size_t>(finer * static_cast<double>(plan.resolution)));
  if (plan.bridge > 0) plan.bridge = std::min(max_thickness, static_cast<unsigned>(std::ceil(finer * plan.bridge)));
  sample(plan);
}

/// Counts the gaps that hide surface (elsewhere it is still seen from its other side); returns the narrowest.
std::optional<FilledGap> report_gaps(std::vector<FilledGap> gaps, const ShellSampling& sampling, std::size_t sites,
                                     Report& report) {
  std::vector<char> seen(sites, 0);
  for (const std::uint32_t i : sampling.in_surface) seen[sampling.surface.site[i]] = 1;
  std::erase_if(gaps, [&](const FilledGap& gap) {
    const auto count = std::count_if(gap.sites.begin(), gap.sites.end(), [&](std::uint32_t s) { return seen[s] != 0; });
    return 2 * static_cast<std::size_t>(count) > gap.sites.size();
  });
  report.merges = gaps.size(), report.thickness_apart = report.thickness;
  if (gaps.empty()) return std::nullopt;
  const auto narrowest = std::min_element(gaps.begin(), gaps.end(), [](const FilledGap& a, const FilledGap& b) {
    return std::pair(a.kept_apart, a.width) < std::pair(b.kept_apart, b.width);
  });
  report.thickness_apart = narrowest->kept_apart;
  return *narrowest;
}

Notice merge_notice(const FilledGap& narrowest, const Report& report) {
  const double finer = std::ceil(3.5 * report.spacing / narrowest.width * static_cast<double>(report.resolution));
  std::string cure = "no resolution up to 8192 keeps them apart";
  if (narrowest.kept_apart > 0) {
    cure = fmt::format("--thickness {} keeps them apart", narrowest.kept_apart);
  } else if (finer <= 8192) {
    cure = fmt::format("-r {:.0f} --thickness 1 keeps them apart", finer);
  }
  const Vec3& at = narrowest.middle;
  return {false,
          fmt::format("sheets that come within {:.3g} of each other merge in {} places, first at ({:.4g}, {:.4g}, "
                      "{:.4g}): {}",
                      narrowest.width, report.merges, at.x, at.y, at.z, cure)};
}

/// Fills in kept.shell and kept.shell_cut as far as asked for.
void keep_shell(const NarrowBand& shell, const Box& bounds, Artifacts& kept) {
  if (!kept.shell && !kept.shell_cut) return;
  const VoxelGrid& grid = shell.grid();
  const SparseVolume empty{.name = "distance",
                           .origin = grid.center({0, 0, 0}),
                           .side = grid.side,
                           .background = static_cast<float>(grid.side * (shell.reach() + 1))};
  if (kept.shell) kept.shell = empty;
  if (kept.shell_cut) kept.shell_cut = empty;
  const Vec3 size = bounds.size(), middle = (bounds.center() - grid.origin) / grid.side;
  const std::size_t across = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  const auto layer = static_cast<std::int32_t>(middle[static_cast<int>(across)]);
  const auto add = [&](SparseVolume& volume, const Voxel& at, NearestSite nearest) {
    volume.voxels.push_back(at);
    volume.values.push_back(static_cast<float>(grid.side * std::sqrt(nearest.squared_distance())));
  };
  for (std::size_t t = 0; t < shell.tiles().size(); ++t) {
    const Voxel corner = shell.tiles()[t].corner();
    const bool in_cut = kept.shell_cut && corner[across] / std::int32_t{tile_size} == layer / std::int32_t{tile_size};
    if (!kept.shell && !in_cut) continue;
    const NearestSite* nearest = shell.nearest(t).data();
    for_each_voxel(shell.tiles()[t], [&](unsigned x, unsigned y, unsigned z) {
      const Voxel at{corner[0] + std::int32_t(x), corner[1] + std::int32_t(y), corner[2] + std::int32_t(z)};
      if (kept.shell) add(*kept.shell, at, *nearest);
      if (in_cut && at[across] == layer) add(*kept.shell_cut, at, *nearest);
      ++nearest;
    });
  }
}

ShellSampling sample_sheets(const Shape& shape, const ShellPlan& plan, StageTimer& timer, Report& report,
                            Artifacts& kept, std::optional<FilledGap>& narrowest, ExecutionContext& context) {
  const SiteVoxels sites = timer.stage("voxelize", 0.05, [&] { return voxelize(shape, plan, context); });
  if (sites.size() == 0) throw UnusableInput("nothing of the surface lies within the bounds");
  ShellSampling sampling;
  std::vector<FilledGap> gaps;
  timer.stage("shell", 0.1, [&] {
    const NarrowBand shell = build_narrow_band(sites, plan.thickness, context);
    report.shell_voxels = shell.size();
    keep_shell(shell, shape.bounds, kept);
    sampling.surface = band_surface(shell, sites, context);
    gaps = filled_gaps(shell, sites, context);
  });
  timer.stage("sheets", 0.1, [&] {
    // Less is not worth a triangle; of points, what noise makes is larger.
    const double cell = 0.5 * sampling.surface.samples.total_area / static_cast<double>(plan.vertices);
    const double min_area = (shape.points() ? 10 : 1) * cell;
    sampling.sheets = choose_sheets(sampling.surface, sites, min_area, context);
    for (std::uint32_t i = 0; i < sampling.sheets.chosen.size(); ++i)
      if (sampling.sheets.chosen[i]) sampling.in_surface.push_back(i);
    sampling.samples = gather(sampling.surface.samples, sampling.in_surface, context);
    sampling.on_surface = drawn_onto_surface(sampling.samples, sampling.in_surface, sampling.surface, sites, context);
  });
  if (sampling.samples.size() == 0)
    throw UnusableInput("no piece of the surface is large enough for this fineness: ask for more vertices");
  report_sampling(plan, sampling.samples.size(), sites, report);
  report.sheets = sampling.sheets.sheets, report.cuts = sampling.sheets.cut;
  report.dropped_components = sampling.sheets.dropped;
  narrowest = report_gaps(std::move(gaps), sampling, sites.size(), report);
  return sampling;
}

SampleSet sample_enclosed(const Shape& shape, const ShellPlan& plan, StageTimer& timer, Report& report, Artifacts& kept,
                          ExecutionContext& context) {
  const SiteVoxels sites = timer.stage("voxelize", 0.05, [&] { return voxelize(shape, plan, context); });
  if (sites.size() == 0) throw UnusableInput("nothing of the surface lies within the bounds");
  SampleSet samples = timer.stage("shell", 0.1, [&] {
    const NarrowBand shell = build_narrow_band(sites, plan.thickness, context);
    report.shell_voxels = shell.size();
    keep_shell(shell, shape.bounds, kept);
    const BandSurface surface = band_surface(shell, sites, context);
    const SiteVoxels border = outer_border(surface, outer_sheets(surface, context), sites.grid, context);
    return enclosed_by(band_surface(build_narrow_band(border, plan.thickness - 1, context), border, context), context);
  });
  if (samples.size() == 0) throw UnusableInput("the surface is too small for its grid: raise the resolution");
  report_sampling(plan, samples.size(), sites, report);
  return samples;
}

/// As many samples as an even mesh would need to have the same for its cells as the smallest have.
std::size_t enough_for(double densest, std::size_t samples) {
  return static_cast<std::size_t>(static_cast<double>(samples) / std::clamp(densest, 1.0, 16.0));
}

/// Fewer seeds when the samples cannot feed as many.
void limit_seeds(Report& report) {
  const double most = std::max(4.0, std::floor(static_cast<double>(report.samples) / min_alpha));
  if (static_cast<double>(report.seeds_asked) <= most) return;
  report.notices.push_back(
      {false, fmt::format("{} vertices would have fewer than {} samples each at resolution {}; meshing with {:.0f}",
                          report.seeds_asked, min_alpha, report.resolution, most)});
  report.seeds_asked = static_cast<std::size_t>(most);
}

}  // namespace

ShellSampling sample_by_shell(const Shape& shape, const MeshOptions& options, StageTimer& timer, Report& report,
                              Artifacts& kept, ExecutionContext& context) {
  const ShellPlan plan = timer.stage("voxelize", 0.02, [&] { return plan_shell(shape, options, report, context); });
  ShellSampling sampling;
  std::optional<FilledGap> narrowest;
  sample_well(plan, !options.resolution, [&](const ShellPlan& p) {
    sampling = {};  // frees the memory first
    sampling = sample_sheets(shape, p, timer, report, kept, narrowest, context);
    if (!options.density) return sampling.samples.size();
    sampling.on_surface = weigh_by_density(std::move(sampling.on_surface), options.density, context).samples;
    WeightedSamples weighted = weigh_by_density(std::move(sampling.samples), options.density, context);
    sampling.samples = std::move(weighted.samples);
    return enough_for(weighted.max_density, sampling.samples.size());
  });
  limit_seeds(report);
  if (narrowest && !shape.points()) report.notices.push_back(merge_notice(*narrowest, report));
  if (sampling.sheets.cut > 0)
    report.notices.push_back(
        {false, fmt::format("{} sheets of surface end where others meet or cross them", sampling.sheets.cut)});
  return sampling;
}

SampleSet sample_wrapping(const Shape& shape, const MeshOptions& options, StageTimer& timer, Report& report,
                          Artifacts& kept, ExecutionContext& context) {
  ShellPlan plan = timer.stage("voxelize", 0.02, [&] { return plan_shell(shape, options, report, context); });
  plan.thickness = std::max(plan.thickness, 2u);
  if (plan.bridge > 0) plan.bridge = std::max(plan.bridge, plan.thickness);
  SampleSet samples;
  sample_well(plan, !options.resolution, [&](const ShellPlan& p) {
    samples = {};
    samples = sample_enclosed(shape, p, timer, report, kept, context);
    if (!options.density) return samples.size();
    WeightedSamples weighted = weigh_by_density(std::move(samples), options.density, context);
    samples = std::move(weighted.samples);
    return enough_for(weighted.max_density, samples.size());
  });
  limit_seeds(report);
  report.notices.push_back({false, fmt::format("the wrap lies about {:.3g} outside of the surface, and closes what is "
                                               "narrower than {:.3g}",
                                               report.spacing, 2 * plan.thickness * report.spacing)});
  return samples;
}

}  // namespace evenmesh
