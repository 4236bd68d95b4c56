#include "pipeline/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"
#include "evenmesh/repair.h"
#include "grid/sizing_field.h"
#include "pipeline/presample.h"

namespace evenmesh {
namespace {

constexpr std::size_t many_components = 16;     ///< small ones: of a surface that is taken for a fractal
constexpr double samples_per_voxel_area = 1.5;  ///< Σ |n_a|, the mean over all directions
constexpr unsigned default_thickness = 2;       ///< voxels

/// The vertices that the user said in one way or another.
std::optional<double> asked_vertices(const MeshOptions& options, double area) {
  if (options.vertices) return static_cast<double>(*options.vertices);
  if (options.edge_length) return std::round(vertices_of(area, *options.edge_length));
  return std::nullopt;
}

/// Whether a grid that may be had keeps both sides of a closed surface apart. If not, says which one would.
bool keeps_sides_apart(const Sampler& sampler, double thickness, const MeshOptions& options, ExecutionContext& context,
                       std::vector<Finding>& findings) {
  const double area = sampler.area(context), longest = sampler.bounds().longest_side();
  const double cells = cells_across_wall * longest / thickness;
  const double samples = samples_per_voxel_area * area * std::pow(cells / longest, 2);
  const bool fine = options.resolution ? cells <= static_cast<double>(*options.resolution) + 1
                                       : samples <= affordable_samples(asked_vertices(options, area).value_or(0));
  if (fine && cells <= static_cast<double>(max_resolution)) return true;
  findings.push_back(make_finding(FindingCode::closed_as_sheets, {{"thickness", thickness},
                                                                  {"vertices", round_up(samples / affordable_alpha)},
                                                                  {"resolution", std::ceil(cells)}}));
  return false;
}

Route route_of(const Sampler& sampler, const MeshOptions& options, ExecutionContext& context, Plan& plan) {
  if (options.method == Method::raster && (options.wrap || !sampler.has_inside()))
    throw InvalidInput("rays need a solid: points and wraps are meshed by the shell method");
  if (options.wrap) return Route::wrap;
  if (options.method == Method::shell) return Route::sheets;
  if (options.method == Method::raster) return Route::solid;
  const Solidity solidity = sampler.solidity(context);
  if (solidity.share < min_solidity) return Route::sheets;
  if (solidity.thickness && !keeps_sides_apart(sampler, *solidity.thickness, options, context, plan.findings))
    return Route::sheets;
  plan.mean_thickness = solidity.thickness;
  return Route::solid;
}

/// Edges turn little, and are no longer than thin parts are thick.
double estimated_vertices(const SurfaceScale& scale, double diagonal) {
  double edge = std::min(0.35 * scale.curvature_radius, 1.5 * scale.thickness);
  edge = std::clamp(edge, diagonal / 500, diagonal / 40);
  return std::clamp(std::round(vertices_of(scale.area, edge)), 200.0, 1e6);
}

double solid_vertices(const SurfaceScale& scale, double diagonal, const MeshOptions& options, Plan& plan) {
  if (const auto asked = asked_vertices(options, scale.area)) return std::max(*asked, 4.0);
  const double vertices = estimated_vertices(scale, diagonal);
  const std::string thinnest = std::isfinite(scale.thickness) ? fmt::format("{:.3g}", scale.thickness) : "not thin";
  plan.findings.push_back(make_finding(
      FindingCode::fineness_estimated,
      {{"vertices", vertices},
       {"area", scale.area},
       {"also", fmt::format(", curvature radius {:.3g}, thinnest part {}", scale.curvature_radius, thinnest)}}));
  return vertices;
}

/// Cells along the longest side.
double solid_resolution(const SurfaceScale& scale, double longest, double vertices, const MeshOptions& options) {
  if (options.resolution) return static_cast<double>(*options.resolution);
  const double samples = wanted_alpha * 1.02 * vertices;
  double resolution = longest / std::sqrt(scale.area * scale.samples_per_area / samples);
  // Thin parts need grid points inside, as long as that costs no more than four times the samples. Where there are many
  // small components, thin parts are thin at every scale.
  if (std::isfinite(scale.thickness) && scale.thickness > 0 && scale.small_components <= many_components)
    resolution = std::clamp(2.5 * longest / scale.thickness, resolution, 2 * resolution);
  return std::ceil(std::max(resolution, 24.0));
}

void plan_solid(const Sampler& sampler, const MeshOptions& options, StageTimer& timer, ExecutionContext& context,
                Plan& plan) {
  const double longest = sampler.bounds().longest_side();
  const double thin = plan.mean_thickness ? std::ceil(cells_across_wall * longest / *plan.mean_thickness) : 0;
  const std::size_t finest = std::max(options.resolution.value_or(0), static_cast<std::size_t>(thin));
  const SurfaceScale scale = timer.stage("sample", 0.02, [&] { return presample(sampler, finest, context); });
  double vertices = solid_vertices(scale, sampler.bounds().diagonal(), options, plan);
  double resolution = solid_resolution(scale, longest, vertices, options);
  if (!options.resolution) resolution = std::max(resolution, thin);
  if (resolution > double(max_resolution)) {
    resolution = double(max_resolution);
    plan.findings.push_back(
        make_finding(FindingCode::resolution_limited, {{"resolution", resolution}, {"alpha", wanted_alpha}}));
  }
  const double h = longest / resolution, samples = scale.area * scale.samples_per_area / (h * h);
  const double max_vertices = std::max(4.0, std::floor(samples / min_alpha));
  if (vertices > max_vertices) {
    plan.findings.push_back(make_finding(
        FindingCode::vertices_limited,
        {{"asked", vertices}, {"alpha", min_alpha}, {"resolution", resolution}, {"vertices", max_vertices}}));
    vertices = max_vertices;
  }
  plan.vertices = static_cast<std::size_t>(vertices);
  plan.grid.resolution = static_cast<std::size_t>(resolution);
  plan.samples_per_h2 = scale.area * scale.samples_per_area;
  plan.small_components = scale.small_components;
}

double shell_vertices(double area, double diagonal, const MeshOptions& options, Plan& plan) {
  if (options.vertices) return static_cast<double>(*options.vertices);
  if (options.edge_length) return vertices_of(area, *options.edge_length);
  const double vertices = std::clamp(vertices_of(area, diagonal / 80), 200.0, 1e6);
  plan.findings.push_back(
      make_finding(FindingCode::fineness_estimated, {{"vertices", vertices}, {"area", area}, {"also", std::string()}}));
  return vertices;
}

/// Random points leave gaps of up to about three times their spacing. Returns the resolution.
double bridge_gaps(double spacing, double longest, double resolution, const MeshOptions& options, Plan& plan) {
  const double voxels = 1.6 * spacing * resolution / longest;
  if (!options.resolution && voxels > max_thickness) resolution = std::floor(resolution * max_thickness / voxels);
  const double wanted =
      std::clamp(std::ceil(1.6 * spacing * resolution / longest), double(default_thickness), double(max_thickness));
  plan.grid.bridge = options.thickness.value_or(static_cast<unsigned>(wanted));
  plan.grid.thickness = default_thickness;
  const double gap = 2 * plan.grid.bridge * longest / resolution;
  plan.findings.push_back(make_finding(FindingCode::point_gaps_bridged,
                                       {{"spacing", spacing}, {"gap", gap}, {"voxels", 2.0 * plan.grid.bridge}}));
  return resolution;
}

void plan_shell(const Sampler& sampler, const MeshOptions& options, ExecutionContext& context, Plan& plan) {
  const double area = sampler.area(context), longest = sampler.bounds().longest_side();
  if (!(area > 0) || !(longest > 0))
    throw UnusableInput("the input has no area: all its triangles or points lie on a line or in a point");
  const double vertices = shell_vertices(area, sampler.bounds().diagonal(), options, plan);
  plan.vertices = static_cast<std::size_t>(std::max(4.0, std::round(vertices)));
  const double h = std::sqrt(samples_per_voxel_area * area / (wanted_alpha * static_cast<double>(plan.vertices)));
  double resolution = std::clamp(std::ceil(longest / h), 32.0, double(max_resolution));
  if (options.resolution) resolution = static_cast<double>(*options.resolution);
  plan.grid.thickness = options.thickness.value_or(default_thickness);
  if (const auto spacing = sampler.point_spacing())
    resolution = bridge_gaps(*spacing, longest, resolution, options, plan);
  plan.grid.resolution = static_cast<std::size_t>(resolution);
  if (plan.route != Route::wrap) return;
  plan.grid.thickness = std::max(plan.grid.thickness, 2u);  // the border is eroded by one less
  if (plan.grid.bridge > 0) plan.grid.bridge = std::max(plan.grid.bridge, plan.grid.thickness);
}

}  // namespace

double round_up(double count) {
  const double digits = std::pow(10, std::max(0.0, std::floor(std::log10(count)) - 1));
  return std::ceil(count / digits) * digits;
}

Plan make_plan(const Sampler& sampler, const MeshOptions& options, StageTimer& timer, ExecutionContext& context) {
  Plan plan;
  plan.route = timer.stage("sample", 0, [&] { return route_of(sampler, options, context, plan); });
  plan.refinable = !options.resolution;
  if (plan.route == Route::solid)
    plan_solid(sampler, options, timer, context, plan);
  else
    timer.stage("voxelize", 0.02, [&] { plan_shell(sampler, options, context, plan); });
  return plan;
}

}  // namespace evenmesh
