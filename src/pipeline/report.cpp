#include "pipeline/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/platform.h"
#include "pipeline/coarseness.h"

namespace evenmesh {
namespace {

void add_sampling(const Sampling& sampling, Report& report) {
  report.seeds_asked = sampling.plan.vertices;
  report.samples = sampling.sampled;
  report.resolution = sampling.plan.grid.resolution;
  report.spacing = sampling.samples.grid.spacing;
  report.filled_cavities = sampling.filled_cavities;
  report.disagreements = sampling.disagreements;
  report.unresolved = sampling.unresolved;
  report.dropped_components = sampling.dropped_components;
  report.sites = sampling.sites;
  report.shell_voxels = sampling.band_voxels;
  report.thickness = sampling.plan.grid.thickness;
  report.merges = sampling.merges;
  report.thickness_apart = sampling.thickness_apart;
  if (!sampling.sheet) return;
  report.sheets = sampling.sheet->sheets.sheets;
  report.cuts = sampling.sheet->sheets.cut;
}

std::vector<double> cycle_shares(const std::vector<std::size_t>& edges, ExecutionContext& context) {
  const auto all = static_cast<double>(std::accumulate(edges.begin(), edges.end(), std::size_t{0}));
  std::vector<double> shares;
  for (std::size_t c = 0; c < edges.size(); ++c) {
    shares.push_back(all > 0 ? static_cast<double>(edges[c]) / all : 0);
    context.log(fmt::format("edges from cycles of {}: {}, {:.2f} %", c + 3, edges[c], 100 * shares.back()));
  }
  return shares;
}

void add_tessellation(const Tessellation& cells, Report& report, ExecutionContext& context) {
  report.energies = cells.energies;
  report.evaluations = cells.energies.size();
  report.energy_ratio = cells.energy_ratio;
  report.crease_vertices = cells.feature_seeds.size();
  for (const FeatureCurve& curve : cells.features.curves)
    for (std::size_t p = 1; p < curve.points.size(); ++p)
      report.crease_length += norm(curve.points[p] - curve.points[p - 1]);
  report.inserted_seeds = cells.inserted_seeds;
  report.regularization_rounds = cells.regularization_rounds;
  report.cycle_shares = cycle_shares(cells.complex.edges_by_cycle, context);
}

constexpr double notable_share = 0.25;  ///< of edges that are longer than the radius of curvature

/// What the run has to say of its result, in the order of the stages.
class Judge {
 public:
  Judge(const Draft& draft, const Tessellation& cells, const MeshOptions& options, const Report& report)
      : draft_(draft), cells_(cells), options_(options), report_(report), quality_(report.quality) {}

  std::vector<Finding> findings(std::vector<Finding> lost, const Coarseness& coarse) {
    findings_ = cells_.sampling.findings;
    const auto is = [](FindingCode code) { return [code](const Finding& f) { return f.code == code; }; };
    // Where they are says more than how many.
    if (std::any_of(lost.begin(), lost.end(), is(FindingCode::thin_parts_lost)))
      std::erase_if(findings_, is(FindingCode::crossings_unresolved));
    findings_.insert(findings_.end(), std::make_move_iterator(lost.begin()), std::make_move_iterator(lost.end()));
    if (report_.dropped_components > 0)
      say(FindingCode::small_components_dropped, {{"count", number(report_.dropped_components)}});
    judge_topology();
    judge_triangles();
    if (coarse.share > notable_share)
      say(FindingCode::coarser_than_curvature,
          {{"percent", 100 * coarse.share}, {"vertices", rounded(coarse.factor * number(quality_.vertices))}});
    const double made = number(quality_.vertices);
    if (std::abs(made - asked()) > 0.005 * asked())
      say(FindingCode::vertex_count, {{"vertices", made},
                                      {"asked", asked()},
                                      {"reason", made > asked() ? "needs more" : "leaves room for fewer"}});
    return std::move(findings_);
  }

 private:
  double asked() const { return number(report_.seeds_asked); }
  static double number(std::size_t n) { return static_cast<double>(n); }
  /// To two digits.
  static double rounded(double n) {
    const double digit = std::pow(10.0, std::floor(std::log10(n)) - 1);
    return std::ceil(n / digit) * digit;
  }
  void say(FindingCode code, std::vector<std::pair<std::string, FindingValue>> values = {}) {
    findings_.push_back(make_finding(code, std::move(values)));
  }

  void judge_topology() {
    const bool closed = cells_.sampling.closed(), fragments = options_.connect == Connect::fragments;
    const bool manifold = quality_.two_manifold() && quality_.oriented();
    if (const std::size_t balls = cells_.balls.balls().size(); balls > 0)
      say(FindingCode::topology_simplified, {{"count", number(balls)}});
    const double h = report_.spacing;
    if (const PointHash& filled = cells_.filled_points; filled.size() > 0)
      findings_.push_back(make_finding(FindingCode::gaps_filled,
                                       {{"count", number(cells_.filled.balls().size())},
                                        {"volume", number(filled.size()) * h * h * h},
                                        {"size", 2 * h},
                                        {"finer", 4 * asked()}},
                                       filled[0]));
    if (!closed && fragments && !cells_.two_manifold) say(FindingCode::cells_torn);
    const double bad_edges = number(quality_.non_manifold_edges);
    if (!closed && !manifold) say(FindingCode::not_manifold, {{"edges", bad_edges}});
    if (closed && !(quality_.closed() && manifold))
      say(FindingCode::not_closed, {{"boundary", number(quality_.boundary_edges)}, {"edges", bad_edges}});
    // Fragments do not look at the samples' surface, and of sheets one side is left out.
    if (!closed || fragments || !(quality_.closed() && manifold)) return;
    const auto spheres = 2 * static_cast<std::int64_t>(draft_.two_triangle_spheres);
    if (const std::int64_t surface = cells_.complex.surface_euler - spheres; surface != quality_.euler)
      say(FindingCode::euler_differs,
          {{"mesh", static_cast<double>(quality_.euler)}, {"surface", static_cast<double>(surface)}});
  }

  void judge_triangles() {
    if (report_.self_intersections > 0)
      say(FindingCode::self_intersections, {{"count", number(report_.self_intersections)}, {"where", std::string()}});
    if (quality_.degenerate_faces > 0)
      say(FindingCode::no_area, {{"count", number(quality_.degenerate_faces)}, {"where", std::string()}});
  }

  const Draft& draft_;
  const Tessellation& cells_;
  const MeshOptions& options_;
  const Report& report_;
  const MeshQuality& quality_;
  std::vector<Finding> findings_;
};

}  // namespace

MeshResult measure(Refined refined, const Draft& draft, const Tessellation& cells, LostParts lost,
                   const MeshOptions& options, StageTimer& timer, ExecutionContext& context) {
  MeshResult result{std::move(refined.mesh), {}};
  Report& report = result.report;
  add_sampling(cells.sampling, report);
  add_tessellation(cells, report, context);
  report.dropped_components += draft.two_triangle_spheres;
  report.cuts += draft.cuts;
  report.self_intersections = refined.self_intersections;
  timer.stage("measure", 0.05, [&] { report.quality = measure_quality(result.mesh, context); });
  report.dropped_components = std::max(report.dropped_components, lost.small);
  report.seeds = report.quality.vertices;
  report.alpha = static_cast<double>(report.samples) / static_cast<double>(std::max<std::size_t>(1, report.seeds));
  const Coarseness coarse =
      timer.stage("measure", 0, [&] { return coarseness(result.mesh, draft.constraints, context); });
  report.findings = Judge(draft, cells, options, report).findings(std::move(lost.findings), coarse);
  report.seconds = timer.seconds();
  report.peak_memory_bytes = peak_memory_bytes();
  context.report("done", 1);
  return result;
}

}  // namespace evenmesh
