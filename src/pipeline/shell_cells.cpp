#include "pipeline/shell_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cvt/starts.h"
#include "geometry/half_edges.h"
#include "geometry/triangle.h"
#include "pipeline/fineness.h"
#include "pipeline/mend.h"
#include "sample/blocks.h"
#include "sample/bridge_points.h"

namespace evenmesh {
namespace {

constexpr double wanted_alpha = 100, least_alpha = 50;
constexpr double samples_per_voxel_area = 1.5;  ///< Σ |n_a|, the mean over all directions
constexpr unsigned default_thickness = 2, most_thickness = 20;
constexpr int topology_rounds = 12;

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
double estimated_area(const Shape& shape, double spacing, Run& run) {
  if (const Mesh* mesh = shape.mesh()) return area_of(*mesh);
  if (const PointCloud* points = shape.points())
    return 0.75 * static_cast<double>(points->points.size()) * spacing * spacing;
  return scout_scale(shape, 0, run).area;
}

ShellPlan plan_shell(const Shape& shape, const MeshOptions& options, Report& report, Run& run) {
  const PointCloud* points = shape.points();
  const double spacing = points ? point_spacing(*points, run) : 0;
  const double area = estimated_area(shape, spacing, run), longest = shape.bounds.longest_side();
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
    if (!options.resolution && voxels > most_thickness) resolution = std::floor(resolution * most_thickness / voxels);
    plan.spacing = spacing;
    plan.bridge = options.thickness.value_or(static_cast<unsigned>(std::clamp(
        std::ceil(1.6 * spacing * resolution / longest), double(default_thickness), double(most_thickness))));
    plan.thickness = default_thickness;
    report.notices.push_back(
        {false, fmt::format("points about {:.3g} apart: gaps of up to {:.3g} ({} voxels) are bridged", spacing,
                            2 * plan.bridge * longest / resolution, 2 * plan.bridge)});
  }
  plan.resolution = static_cast<std::size_t>(resolution);
  return plan;
}

SiteVoxels voxelize(const Shape& shape, const ShellPlan& plan, Run& run) {
  const VoxelGrid grid = make_voxel_grid(shape.bounds, plan.resolution, std::max(plan.thickness, plan.bridge) + 2);
  if (const Mesh* mesh = shape.mesh()) return voxelize_mesh(*mesh, grid, run);
  if (const PointCloud* points = shape.points()) {
    SiteVoxels sparse = voxelize_points(points->points, points->normals, grid, run);
    if (sparse.size() == 0) return sparse;
    if (sparse.normal.empty()) estimate_normals(sparse, 2 * plan.bridge, run);
    return bridge_points(sparse, build_shell(sparse, plan.bridge, run), plan.spacing, !points->normals.empty(), run);
  }
  return voxelize_field(*shape.field(), grid, shape.bounds, run);
}

}  // namespace

bool is_open_surface(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  Vec3 sum;
  double area = 0;
  std::size_t boundary = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    const Vec3 n = area_normal(a, b, c);
    sum += n, area += norm(n);
    for (std::size_t h = 3 * t; h < 3 * t + 3; ++h) boundary += edges.opposite(h) == HalfEdges::none;
  }
  return static_cast<double>(boundary) > 0.01 * 3 * static_cast<double>(mesh.triangles.size()) ||
         norm(sum) > 0.03 * area;
}

ShellSampling sample_by_shell(const Shape& shape, const MeshOptions& options, Stages& stages, Report& report,
                              Run& run) {
  const ShellPlan plan = stages.stage("voxelize", 0.02, [&] { return plan_shell(shape, options, report, run); });
  const SiteVoxels sites = stages.stage("voxelize", 0.05, [&] { return voxelize(shape, plan, run); });
  if (sites.size() == 0) throw UnusableInput("nothing of the surface lies within the bounds");
  ShellSampling sampling;
  stages.stage("shell", 0.1, [&] {
    const Shell shell = build_shell(sites, plan.thickness, run);
    report.shell_voxels = shell.size();
    sampling.surface = shell_surface(shell, sites, run);
  });
  stages.stage("sheets", 0.1, [&] {
    // Cells on one sheet and not worth a triangle of their own; of points, what noise makes.
    const double cell = 0.5 * sampling.surface.samples.total_area / static_cast<double>(plan.vertices);
    const double least_area = (shape.points() ? 10 : 2) * cell;
    sampling.sheets =
        options.wrap ? outer_sheets(sampling.surface, run) : choose_sheets(sampling.surface, sites, least_area, run);
    const auto keep = [&](std::uint32_t i) { return sampling.sheets.chosen[i] != 0; };
    sampling.samples = sampling.surface.samples;
    keep_samples(sampling.samples, keep);
    ShellSurface drawn = sampling.surface;
    draw_onto_surface(drawn, sites, {1.0, options.wrap ? 1.0 : 0.0}, run);
    sampling.on_surface = std::move(drawn.samples);
    keep_samples(sampling.on_surface, keep);
  });
  report.seeds_asked = plan.vertices;
  report.resolution = plan.resolution, report.thickness = plan.thickness;
  report.spacing = sites.grid.side;
  report.sites = sites.size(), report.samples = sampling.samples.size();
  report.sheets = sampling.sheets.sheets, report.cuts = sampling.sheets.cut;
  const double most = std::max(4.0, std::floor(static_cast<double>(report.samples) / least_alpha));
  if (static_cast<double>(report.seeds_asked) > most) {
    report.notices.push_back(
        {false, fmt::format("{} vertices would have fewer than {} samples each at resolution {}; meshing with {:.0f}",
                            report.seeds_asked, least_alpha, plan.resolution, most)});
    report.seeds_asked = static_cast<std::size_t>(most);
  }
  report.dropped_components = sampling.sheets.dropped;
  if (sampling.sheets.cut > 0)
    report.notices.push_back(
        {false, fmt::format("{} sheets of surface end where others meet or cross them", sampling.sheets.cut)});
  return sampling;
}

namespace {

class ShellCells {
 public:
  ShellCells(const ShellSampling& sampling, const MeshOptions& options, Stages& stages, Report& report, Run& run)
      : sampling_(sampling),
        samples_(sampling.samples),
        options_(options),
        stages_(stages),
        report_(report),
        run_(run),
        evaluator_(sampling.samples, run) {}

  ConnectedCells result() {
    stages_.stage("balance", 0.5, [&] {
      BalanceResult result = balance_seeds(evaluator_, report_.seeds_asked, balance_options(options_), run_);
      seeds_ = std::move(result.seeds);
      report_.energies.insert(report_.energies.end(), result.ratios.begin(), result.ratios.end());
      report_.energy_ratio = result.energy_ratio;
    });
    connect();
    for (int round = 0; round < topology_rounds && !defects().empty(); ++round) mend();
    ConnectedCells cells;
    cells.two_manifold = complex_.defects.empty();
    cells.anchors = anchors();
    cells.seeds = std::move(seeds_), cells.labels = std::move(labels_);
    cells.triangles = std::move(complex_.triangles);
    return cells;
  }

 private:
  void connect() {
    stages_.stage("connect", 0.1, [&] {
      evaluator_.nearest(seeds_, labels_);
      std::vector<std::uint32_t> all(sampling_.surface.samples.size(), no_label);
      std::size_t at = 0;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (sampling_.sheets.chosen[i]) all[i] = labels_[at++];
      complex_ = connect_labels(sampling_.surface.samples, all, seeds_, run_);
      at = 0;
      for (std::size_t i = 0; i < all.size(); ++i)
        if (sampling_.sheets.chosen[i]) labels_[at++] = all[i];
      for (const CellPiece& piece : complex_.pieces) seeds_.push_back(piece.centroid);
    });
  }

  /// Defects of the complex, and cells that own a good deal of surface but no triangle: small sheets need three seeds.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> defects() const {
    auto list = complex_.defects;
    std::vector<char> connected(seeds_.size(), 0);
    for (const Triangle& t : complex_.triangles)
      for (const std::uint32_t l : t) connected[l] = 1;
    std::vector<double> area(seeds_.size(), 0);
    for (std::size_t i = 0; i < labels_.size(); ++i) area[labels_[i]] += samples_.area[i];
    const double worth_it = 0.5 * samples_.total_area / static_cast<double>(report_.seeds_asked);
    for (std::uint32_t l = 0; l < seeds_.size(); ++l)
      if (!connected[l] && area[l] > worth_it) list.push_back({l, l});
    return list;
  }

  void mend() {
    const std::size_t given = seeds_.size() - complex_.pieces.size();
    const Mending mending = stages_.stage("connect", 0, [&] {
      const double edge = edge_length_of(samples_.total_area, static_cast<double>(seeds_.size()));
      return plan_mending(samples_, labels_, seeds_, defects(), {}, BallIndex({}),
                          {.edge = edge, .given = given, .seeds_only = true});
    });
    run_.log(fmt::format("mend: {} defects, {} seeds", defects().size(), seeds_.size()));
    seeds_.resize(given);
    seeds_.insert(seeds_.end(), mending.seeds.begin(), mending.seeds.end());
    report_.inserted_seeds += mending.seeds.size();
    connect();
  }

  /// Cells at the rim, and their place on it.
  std::vector<std::pair<std::uint32_t, Vec3>> anchors() const {
    struct Rim {
      Vec3 sum, nearest;
      double count = 0, distance = std::numeric_limits<double>::infinity();
    };
    std::vector<Rim> rims(seeds_.size());
    const auto each = [&](const auto& use) {
      std::size_t full = 0;
      const SampleSet& set = sampling_.on_surface;
      for (const SampleBlock& block : set.blocks)
        for (std::uint32_t i = block.begin; i < block.end; ++i, ++full) {
          while (!sampling_.sheets.chosen[full]) ++full;
          if (sampling_.sheets.border[full])
            use(rims[labels_[i]], set.block_center(block) + Vec3{set.x[i], set.y[i], set.z[i]});
        }
    };
    each([](Rim& rim, const Vec3& p) { rim.sum += p, rim.count += 1; });
    each([](Rim& rim, const Vec3& p) {
      if (const double d = squared_norm(p - rim.sum / rim.count); d < rim.distance) rim.distance = d, rim.nearest = p;
    });
    std::vector<std::pair<std::uint32_t, Vec3>> list;
    for (std::uint32_t l = 0; l < rims.size(); ++l)
      if (rims[l].count > 0) list.push_back({l, rims[l].nearest});
    return list;
  }

  const ShellSampling& sampling_;
  const SampleSet& samples_;
  const MeshOptions& options_;
  Stages& stages_;
  Report& report_;
  Run& run_;
  CellEvaluator evaluator_;
  std::vector<Vec3> seeds_;
  std::vector<std::uint32_t> labels_;
  LabelComplex complex_;
};

}  // namespace

ConnectedCells connect_shell(const ShellSampling& sampling, const MeshOptions& options, Stages& stages, Report& report,
                             Run& run) {
  return ShellCells(sampling, options, stages, report, run).result();
}

std::size_t separate_fans(Mesh& mesh, std::vector<std::uint32_t>& source) {
  const std::size_t before = mesh.vertices.size();
  source.resize(before);
  std::iota(source.begin(), source.end(), 0u);
  const HalfEdges edges(mesh.triangles, before);
  for (std::uint32_t v = 0; v < before; ++v) {
    std::uint32_t copy = v, last_fan = 0;
    edges.visit_fans(v, [&](std::uint32_t h, std::uint32_t fan) {
      if (fan != last_fan) {
        last_fan = fan, copy = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(mesh.vertices[v]), source.push_back(v);
      }
      mesh.triangles[h / 3][h % 3] = copy;
    });
  }
  return mesh.vertices.size() - before;
}

}  // namespace evenmesh
