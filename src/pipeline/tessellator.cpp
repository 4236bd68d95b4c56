#include "pipeline/tessellator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "connect/dual_polygons.h"
#include "connect/flood.h"
#include "connect/fragments.h"
#include "cvt/starts.h"
#include "evenmesh/error.h"
#include "features/crowding.h"
#include "features/followable.h"
#include "features/long_curves.h"
#include "grid/surface_components.h"
#include "topology/closing.h"

namespace evenmesh {
namespace {

constexpr double little_progress = 0.002;  ///< of a round of repair: there may be a few, or many
constexpr std::size_t relaxing_evaluations = 5;
constexpr double sheet_effort = 1.7;  ///< a small part of the time there: Q 0.005 higher for 10 % more of it

/// @param rugged  what is left of filled gaps takes more effort to even out
RelaxOptions relax_options(const MeshOptions& options, bool rugged) {
  RelaxOptions relax;
  relax.start = options.start == Start::random       ? SeedStart::random
                : options.start == Start::blue_noise ? SeedStart::blue_noise
                                                     : SeedStart::coarse_to_fine;
  relax.lloyd = options.optimizer == Optimizer::lloyd;
  relax.tolerance = options.tolerance;
  relax.seed = options.seed;
  const bool high = options.quality == Quality::high || (rugged && options.quality == Quality::normal);
  relax.effort = options.quality == Quality::fast ? 0.5 : high ? 3 : 1;
  relax.annealing_rounds = high ? 12 : 0;
  relax.evaluations = options.iterations;
  return relax;
}

}  // namespace

Tessellator::Tessellator(Sampling sampling, const MeshOptions& o, const Kernels& kernels, StageTimer& t,
                         ExecutionContext& c)
    : options(o), timer(t), context(c), kernels_(kernels) {
  result.sampling = std::move(sampling);
}

CellEvaluator& Tessellator::evaluator() {
  const SampleSet& samples = result.sampling.samples;
  if (!evaluator_)
    evaluator_ = kernels_.cells ? kernels_.cells->evaluator(samples, context)
                                : std::make_unique<CpuCellEvaluator>(samples, context);
  return *evaluator_;
}

double Tessellator::edge() const {
  const std::size_t cells = std::max({wanted(), result.seeds.size(), result.complex.labels});
  return edge_length_of(result.sampling.samples.total_area, static_cast<double>(cells));
}

void Tessellator::find_features() {
  if (!options.feature_angle || result.sampling.plan.route != Route::solid) return;
  std::erase_if(result.sampling.findings,
                [](const Finding& f) { return f.code == FindingCode::features_not_followed; });
  const SampleSet& samples = result.sampling.samples;
  const double edge = result.sampling.sizing.mean();
  // Then noise cannot be told from edges.
  const bool settled_by_vote = 10 * samples.disagreements > samples.size();
  std::size_t found = 0;
  timer.stage("features", 0.01, [&] {
    FeatureCurves all = find_feature_curves(samples, *options.feature_angle, edge, context);
    found = all.curves.size() + all.left_out.size();
    if (settled_by_vote) {
      all = without_curves(all, std::vector<char>(all.curves.size(), 1));
      all.apexes.clear();
    }
    result.features = followable(all, edge, wanted() / 2);
    result.feature_seeds = place_feature_seeds(result.features, edge);
  });
  context.log(fmt::format("features: {} curves, {} corners, {} seeds", result.features.curves.size(),
                          result.features.corners.size(), fixed()));
  if (result.sampling.hidden_area > 0) keep_long_features(edge);
  const std::vector<Vec3>& left_out = result.features.left_out;
  if (left_out.empty()) return;
  const char* reason =
      settled_by_vote ? "inside and outside were settled by vote in too many places to tell them from noise"
                      : "too short, too near to each other or too many for meshes this coarse: ask for more vertices";
  result.sampling.findings.push_back(make_finding(
      FindingCode::features_not_followed,
      {{"count", static_cast<double>(left_out.size())}, {"all", static_cast<double>(found)}, {"reason", reason}},
      left_out.front()));
}

void Tessellator::keep_long_features(double edge) {
  constexpr double most = 0.2;   // share of the vertices
  constexpr double length = 50;  // edges
  if (static_cast<double>(fixed()) <= most * static_cast<double>(wanted())) return;
  const std::size_t all = result.features.curves.size();
  result.features = long_curves(result.features, length * edge);
  result.feature_seeds = place_feature_seeds(result.features, edge);
  result.sampling.findings.push_back(
      make_finding(FindingCode::short_features_left_out,
                   {{"count", static_cast<double>(all - result.features.curves.size())}, {"length", length * edge}}));
}

void Tessellator::relax_all(std::size_t count, double effort) {
  settled_.clear();
  result.seeds_are_vertices = false;
  timer.stage("relax", closed() ? 0.6 : 0.5, [&] {
    RelaxOptions relax = relax_options(options, result.sampling.hidden_area > 0);
    relax.effort *= closed() ? effort : sheet_effort;
    if (fixed() > 0)
      relax.fixed = [&](std::size_t seeds) {
        if (2 * seeds > count) return result.feature_seeds.seeds;
        const double edge = edge_length_of(result.sampling.samples.total_area, double(seeds));
        return place_feature_seeds(result.features, edge).seeds;
      };
    RelaxResult relaxed = relax_seeds(evaluator(), count, relax, context);
    result.seeds = std::move(relaxed.seeds);
    result.energies.insert(result.energies.end(), relaxed.ratios.begin(), relaxed.ratios.end());
    result.energy_ratio = relaxed.energy_ratio;
  });
}

void Tessellator::relax(std::size_t effort) {
  if (!settled_.empty()) {
    relax_around(unsettled(), effort * relaxing_evaluations);
    settle();
    return;
  }
  timer.stage("relax", little_progress, [&] {
    const bool lloyd = options.optimizer == Optimizer::lloyd;
    const auto relaxed = optimize(evaluator(), result.seeds,
                                  {lloyd, effort * relaxing_evaluations, options.tolerance, frozen_}, context);
    if (closed() && frozen_.empty())
      result.energies.insert(result.energies.end(), relaxed.ratios.begin(), relaxed.ratios.end());
  });
}

void Tessellator::relax_last(std::size_t first) {
  std::vector<char> frozen(result.seeds.size(), 0);
  std::fill_n(frozen.begin(), std::min(first, frozen.size()), 1);
  std::swap(frozen, frozen_);
  relax();
  std::swap(frozen, frozen_);
}

void Tessellator::connect() {
  timer.stage("connect", 0.1, [&] {
    evaluator().nearest(result.seeds, result.labels);
    if (options.connect == Connect::fragments)
      connect_as_fragments();
    else if (closed())
      connect_solid();
    else
      connect_sheets();
    for (const CellComponent& piece : result.complex.pieces) result.seeds.positions.push_back(piece.centroid);
  });
}

LabelComplex Tessellator::dual_of(const SampleSet& samples, std::vector<std::uint32_t>& labels) const {
  return kernels_.extraction ? kernels_.extraction->connect(samples, labels, result.seeds, context)
                             : connect_labels(samples, labels, result.seeds, context);
}

void Tessellator::connect_solid() {
  const SampleSet& samples = result.sampling.samples;
  if (options.connect == Connect::flood) flood_labels(samples, result.labels, result.seeds, context);
  if (fixed() > 0) constrain_labels(samples, result.features, result.feature_seeds, result.labels, context);
  forget_incomplete_cells();
  result.complex = dual_of(samples, result.labels);
}

/// Along both sides of the shell, of which one has labels.
void Tessellator::connect_sheets() {
  const SheetSampling& sheet = *result.sampling.sheet;
  const SampleSet& both = sheet.both_sides.samples;
  std::vector<std::uint32_t> all(both.size(), no_label);
  for (std::size_t i = 0; i < result.labels.size(); ++i) all[sheet.chosen[i]] = result.labels[i];
  if (options.connect == Connect::flood) flood_labels(both, all, result.seeds, context);
  result.complex = dual_of(both, all);
  for (std::size_t i = 0; i < result.labels.size(); ++i) result.labels[i] = all[sheet.chosen[i]];
}

/// Of sheets, a boundary away from their rim is a hole: a cycle that could not be filled.
void Tessellator::connect_as_fragments() {
  const FragmentOptions fragments{.max_cycle = options.max_cycle, .open = !closed()};
  result.complex = connect_fragments(result.sampling.samples, result.seeds, fragments, context).complex;
  if (closed()) return;
  const SheetSampling& sheet = *result.sampling.sheet;
  std::vector<char> at_rim(result.seeds.size(), 0);
  for (std::size_t i = 0; i < result.labels.size(); ++i)
    if (sheet.sheets.border[sheet.chosen[i]]) at_rim[result.labels[i]] = 1;
  for (const auto& [a, b] : manifold_defects(result.complex.triangles, result.seeds.size()))
    if (a != b && (!at_rim[a] || !at_rim[b])) result.complex.defects.push_back({a, b});
}

void Tessellator::forget_split_cells() {
  result.seeds.positions.resize(given());
  result.complex.pieces.clear();
}

void Tessellator::insert(std::span<const Vec3> seeds) {
  result.seeds.positions.insert(result.seeds.positions.end(), seeds.begin(), seeds.end());
  result.inserted_seeds += seeds.size();
}

bool Tessellator::fill_narrow_gaps() {
  return timer.stage("regularize", 0, [&] {
    const bool filled = evenmesh::fill_narrow_gaps(result.sampling, "", context);
    if (filled) evaluator_.reset();
    return filled;
  });
}

std::vector<std::uint32_t> Tessellator::unconnected() const {
  constexpr double owns_nothing = -1;
  const SampleSet& samples = result.sampling.samples;
  std::vector<char> connected(result.seeds.size(), 0);
  for (const Triangle& t : result.complex.triangles)
    for (const std::uint32_t l : t) connected[l] = 1;
  if (std::find(connected.begin(), connected.end(), 0) == connected.end()) return {};
  std::vector<double> area(result.seeds.size(), owns_nothing);
  for (std::size_t i = 0; i < result.labels.size(); ++i) {
    if (result.labels[i] == no_label) continue;
    double& sum = area[result.labels[i]];
    sum = std::max(sum, 0.0) + samples.area[i];
  }
  // Small sheets need three seeds, and small pieces of them are not worth it.
  const double worth_it = closed() ? owns_nothing : 0.5 * samples.total_area / static_cast<double>(wanted());
  std::vector<std::uint32_t> list;
  for (std::uint32_t l = 0; l < area.size(); ++l)
    if (!connected[l] && area[l] > worth_it && !is_frozen(l)) list.push_back(l);
  return list;
}

std::vector<Defect> Tessellator::defects() const {
  auto list = result.complex.defects;
  for (const std::uint32_t l : unconnected()) list.push_back({l, l});
  return list;
}

bool Tessellator::drop_small_components() {
  Sampling& sampling = result.sampling;
  std::size_t dropped = 0;
  timer.stage("connect", 0, [&] {
    const double cell = sampling.samples.total_area / static_cast<double>(wanted());
    RemainingSurface rest = evenmesh::drop_small_components(std::move(sampling.samples), cell, context);
    sampling.samples = std::move(rest.samples);
    dropped = rest.dropped;
    if (dropped > 0) evaluator_.reset();
  });
  sampling.dropped_components += dropped;
  if (dropped > 0 && sampling.samples.size() < wanted())
    throw UnusableInput("the surface consists of specks smaller than a cell: ask for more vertices");
  return dropped > 0;
}

bool Tessellator::clear_small_components() {
  if (unconnected().empty() || !drop_small_components()) return false;
  refill_idle_seeds();
  relax();
  connect();
  return true;
}

/// Seeds whose samples have gone start again elsewhere.
void Tessellator::refill_idle_seeds() {
  timer.stage("relax", 0, [&] {
    forget_split_cells();
    const std::size_t count = std::min(result.seeds.size(), wanted());
    evaluator().nearest(result.seeds, result.labels);
    std::vector<char> owns(result.seeds.size(), 0);
    for (const std::uint32_t l : result.labels) owns[l] = 1;
    std::size_t kept = 0;
    for (std::size_t s = 0; s < result.seeds.size(); ++s)
      if (owns[s] || result.seeds.is_fixed(s)) result.seeds.positions[kept++] = result.seeds.positions[s];
    result.seeds.positions.resize(kept);
    if (kept < count) adjust_count(count, 7);
  });
}

void Tessellator::adjust_count(std::size_t count, std::uint64_t salt) {
  evenmesh::adjust_count(evaluator(), result.seeds, count, options.seed + salt, context);
}

void Tessellator::adjust_and_relax(std::size_t count) {
  timer.stage("relax", 0, [&] { adjust_count(count, 7); });
  relax();
}

TopologyRepair Tessellator::plan_repair(std::span<const Vec3> ambiguous, TopologyRepairOptions repair) const {
  return timer.stage("connect", 0, [&] {
    // Sheets are repaired by seeds alone, whatever their number was meant to be.
    repair.edge = closed() ? edge() : edge_length_of(result.sampling.samples.total_area, double(result.seeds.size()));
    repair.given = given();
    return plan_topology_repair(result.sampling.samples, result.labels, result.seeds, defects(), ambiguous,
                                repair.unresolved ? result.balls : result.filled, repair);
  });
}

void Tessellator::unite_changed(std::span<const std::uint32_t> changed) {
  timer.stage("regularize", 0, [&] {
    std::vector<Ball> balls;
    for (const std::uint32_t b : changed) balls.push_back(result.balls.balls()[b]);
    const std::size_t count = std::min(result.seeds.size(), wanted());
    result.sampling.samples = unite_balls(result.sampling.samples, balls, context);
    evaluator_.reset();
    std::vector<Vec3>& seeds = result.seeds.positions;
    std::vector<Vec3> others(result.seeds.free_positions().begin(), result.seeds.free_positions().end());
    clear_around(others, result.balls, changed, edge());
    seeds.resize(result.seeds.fixed.size());
    seeds.insert(seeds.end(), others.begin(), others.end());
    if (result.seeds.size() < count) adjust_count(count, 11);
    ++result.regularization_rounds;
  });
}

void Tessellator::fill_gaps(std::span<const Ball> places) {
  timer.stage("regularize", 0, [&] {
    FilledSolid made = evenmesh::fill_gaps(result.sampling.samples, places, context);
    result.sampling.samples = std::move(made.samples);
    if (result.filled_points.size() == 0) result.filled_points = PointHash(4 * made.samples.grid.spacing);
    for (const Vec3& p : made.points) result.filled_points.add(p);
    evaluator_.reset();
    ++result.regularization_rounds;
  });
}

void Tessellator::release_features() {
  std::vector<char> bad(result.seeds.size(), 0);
  for (const auto& [a, b] : defects()) bad[a] = bad[b] = 1;
  const Seeds old = std::move(result.feature_seeds.seeds);
  std::vector<char> doomed(result.features.curves.size(), 0);
  for (std::size_t s = 0; s < old.size(); ++s)
    if (bad[s] && old.fixed[s].kind == Attachment::Kind::curve) doomed[old.fixed[s].index] = 1;
  for (std::size_t c = 0; c < doomed.size(); ++c)
    for (const std::uint32_t corner : {result.features.curves[c].from, result.features.curves[c].to})
      if (corner != FeatureCurve::none && bad[corner]) doomed[c] = 1;
  result.released_curves += static_cast<std::size_t>(std::count(doomed.begin(), doomed.end(), 1));
  result.features = without_curves(result.features, doomed);
  result.feature_seeds = place_feature_seeds(result.features, result.sampling.sizing.mean());
  forget_split_cells();
  Seeds seeds = result.feature_seeds.seeds;
  std::set<std::array<double, 3>> stay;
  for (const Vec3& p : seeds.positions) stay.insert({p.x, p.y, p.z});
  for (std::size_t s = 0; s < result.seeds.size(); ++s) {
    const Vec3& p = result.seeds.positions[s];
    if (s >= old.size() || !stay.contains({p.x, p.y, p.z})) seeds.positions.push_back(p);
  }
  result.seeds = std::move(seeds);
  connect();
}

}  // namespace evenmesh
