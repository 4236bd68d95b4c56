// Seeds by way of coarser meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/subdivide.h"
#include "grid/coarsen.h"
#include "pipeline/draft.h"
#include "pipeline/misfits.h"
#include "refine/dislocations.h"
#include "refine/flips.h"
#include "refine/shape_smoothing.h"

namespace evenmesh {
namespace {

constexpr double min_base = 3000;        ///< vertices of the coarsest mesh
constexpr double samples_per_seed = 80;  ///< wanted on every level
constexpr double shortest_curve = 0.7;   ///< that a level follows, in edges
constexpr double lost_area = 0.03;       ///< share: a grid that loses more of the surface is too coarse
constexpr double few_defects = 0.01;     ///< by seed: what is worth a repair on a coarse level
constexpr double level_size_weight = 0.1;
constexpr std::size_t base_evaluations = 24, level_evaluations = 12, middle_evaluations = 8;
constexpr double count_tolerance = 0.001;  ///< of the vertices asked for

class Levels {
 public:
  /// @param levels  above the finest
  Levels(Tessellator& finest, std::size_t levels)
      : finest_(finest), context_(finest.context), options_(finest.options), samples_(levels + 1) {
    const double less = count_tolerance * static_cast<double>(finest.wanted());
    counts_.push_back(finest.wanted() - static_cast<std::size_t>(less));
    for (std::size_t l = 0; l < levels; ++l) counts_.push_back(parent_count(counts_.back(), 2));
  }

  bool run() {
    if (!coarsen_samples()) return false;
    std::unique_ptr<Tessellator> level = make_base();
    if (!level) return false;
    finest_.result.energies = level->result.energies;
    Draft mesh = regular_mesh(*level);
    for (std::size_t l = samples_.size() - 1; l-- > 0;) {
      std::unique_ptr<Tessellator> next = l > 0 ? make_level(l) : nullptr;
      Tessellator& finer = next ? *next : finest_;
      finest_.timer.stage("relax", 0, [&] { seed_from(std::move(mesh), *level, finer); });
      const double n = static_cast<double>(counts_[l]);
      const auto thinner = next || !thinner_ ? nullptr : finest_.evaluator().for_samples(*thinner_, context_);
      repair_misfits(finer, thinner ? *thinner : finer.evaluator(), counts_[l],
                     static_cast<std::size_t>((1 + 2 * count_tolerance) * n));
      if (!next) break;
      if (!connected(*next)) return false;
      level = std::move(next);
      mesh = extracted(*level);
      const SampleSet& samples = level->result.sampling.samples;
      smooth(mesh, samples, level_evaluations);
      if (options_.quality == Quality::high) remove_dislocations(mesh, samples);
    }
    return true;
  }

 private:
  /// Of a mesh that has so many with a vertex in the middle of every edge.
  static std::size_t parent_count(std::size_t count, std::int64_t euler) {
    return static_cast<std::size_t>(std::max<std::int64_t>(4, (static_cast<std::int64_t>(count) + 3 * euler + 2) / 4));
  }

  /// Whether there is something left of all of the surface.
  bool coarsen_samples() {
    return finest_.timer.stage("relax", 0, [&] {
      std::vector<std::unique_ptr<SampleSet>> thinner;
      const SampleSet& finest = finest_.result.sampling.samples;
      const SampleSet* from = &finest;
      for (std::size_t l = 1; l < samples_.size(); ++l) {
        if (static_cast<double>(from->size()) / 4 >= samples_per_seed * static_cast<double>(counts_[l]))
          from = thinner.emplace_back(std::make_unique<SampleSet>(coarsen(*from, context_))).get();
        samples_[l] = one_sample_per_edge(*from, context_);
      }
      if (!thinner.empty()) thinner_ = std::move(thinner.front());
      const double lost = 1 - samples_.back().total_area / finest.total_area;
      if (lost > lost_area)
        context_.log(fmt::format("levels: the coarsest grid loses {:.1f} % of the surface", 100 * lost));
      return lost <= lost_area;
    });
  }

  std::unique_ptr<Tessellator> make_level(std::size_t l) {
    const Sampling& whole = finest_.result.sampling;
    Sampling sampling;
    sampling.plan = whole.plan;
    sampling.plan.vertices = counts_[l];
    sampling.samples = std::move(samples_[l]);
    sampling.sizing =
        whole.sizing.with_mean(edge_length_of(sampling.samples.total_area, static_cast<double>(counts_[l])));
    auto level =
        std::make_unique<Tessellator>(std::move(sampling), options_, finest_.kernels(), finest_.timer, context_);
    level->result.features = finest_.result.features;
    return level;
  }

  /// The coarsest mesh, with as many vertices as will make those asked for.
  std::unique_ptr<Tessellator> make_base() {
    auto base = make_level(samples_.size() - 1);
    base->result.feature_seeds = place_feature_seeds(base->result.features, base->result.sampling.sizing.mean());
    base->relax_all(base->wanted());
    if (!connected(*base)) return nullptr;
    for (std::size_t l = 1; l < counts_.size(); ++l)
      counts_[l] = parent_count(counts_[l - 1], base->result.complex.surface_euler);
    if (counts_.back() == base->result.seeds.size()) return base;
    base->forget_split_cells();
    base->adjust_and_relax(std::max(counts_.back(), base->fixed() + 4));
    if (!connected(*base)) return nullptr;
    return base;
  }

  bool connected(Tessellator& level) const {
    level.connect();
    const std::size_t defects = level.defects().size();
    if (defects > 0 && static_cast<double>(defects) <= few_defects * static_cast<double>(level.wanted()))
      repair_solid(level);
    if (level.result.released_curves > 0) {
      context_.log("levels: sharp edges are in the way of the topology");
      return false;
    }
    if (!level.fits())
      context_.log(fmt::format("levels: {} defects among {} cells", level.defects().size(), level.result.seeds.size()));
    return level.fits();
  }

  Draft extracted(const Tessellator& level) const {
    return finest_.timer.stage("relax", 0, [&] {
      Draft draft = extract(level.result, options_, context_);
      flip_to_delaunay(draft.mesh, draft.constraints, context_);
      return draft;
    });
  }
  void smooth(Draft& draft, const SampleSet& samples, std::size_t evaluations) const {
    const auto projector = make_projector(samples);
    const ShapeSmoothingOptions options{
        .size_weight = level_size_weight, .evaluations = evaluations, .planes = draft.planes};
    smooth_shapes(draft.mesh, projector.get(), draft.sizing, options, context_, draft.constraints);
    flip_to_delaunay(draft.mesh, draft.constraints, context_);
  }

  /// Of the coarsest level, where regular connectivity is cheap.
  Draft regular_mesh(const Tessellator& level) const {
    Draft draft = extracted(level);
    finest_.timer.stage("relax", 0, [&] {
      const SampleSet& samples = level.result.sampling.samples;
      smooth(draft, samples, base_evaluations);
      if (options_.quality == Quality::fast) return;
      remove_dislocations(draft, samples);
    });
    return draft;
  }
  void remove_dislocations(Draft& draft, const SampleSet& samples) const {
    const auto projector = make_projector(samples);
    const DislocationOptions options{.work = annealing_work(options_.quality, finest_.wanted()),
                                     .size_weight = level_size_weight,
                                     .seed = options_.seed};
    const DislocationResult result =
        evenmesh::remove_dislocations(draft.mesh, projector.get(), draft.sizing, options, context_, draft.constraints);
    draft.planes.clear();
    smooth(draft, samples, level_evaluations);
    context_.log(fmt::format("levels: {} irregular vertices of {}, {} after annealing", result.irregular_before,
                             draft.mesh.vertices.size(), result.irregular));
  }
  /// By vertex of the draft's mesh: whether it belongs to no fixed seed.
  static std::vector<char> free_vertices(const Draft& draft, const Tessellator& level) {
    std::vector<char> free(draft.mesh.vertices.size(), 1);
    for (std::size_t l = 0; l < level.fixed(); ++l)
      if (const std::uint32_t v = draft.vertex_of_label[l]; v != Draft::none) free[v] = 0;
    return free;
  }
  static void append_free(const Draft& draft, const std::vector<char>& free, Seeds& seeds) {
    for (std::size_t v = 0; v < free.size(); ++v)
      if (free[v]) seeds.positions.push_back(draft.mesh.vertices[v]);
  }

  /// Seeds where a mesh with a vertex in the middle of every edge has them; on feature curves evenly spaced.
  void seed_from(Draft draft, const Tessellator& coarse, Tessellator& finer) const {
    SubdividedMesh halved = subdivide(draft.mesh, context_);
    std::vector<char> free = free_vertices(draft, coarse);
    free.resize(halved.mesh.vertices.size(), 1);
    if (!draft.constraints.curve.empty()) halve_constraints(halved, draft.constraints, free);
    draft.planes.clear();
    draft.mesh = std::move(halved.mesh);
    draft.sizing = draft.sizing.with_mean(0.5 * draft.sizing.mean());
    smooth(draft, finer.result.sampling.samples, middle_evaluations);
    finer.result.feature_seeds = halve_spacing(coarse.result.features, coarse.result.feature_seeds);
    finer.result.seeds = finer.result.feature_seeds.seeds;
    append_free(draft, free, finer.result.seeds);
    finer.result.seeds_are_vertices = true;
  }
  static void halve_constraints(const SubdividedMesh& halved, VertexConstraints& constraints, std::vector<char>& free) {
    const auto old = static_cast<std::uint32_t>(constraints.curve.size());
    constraints.curve.resize(halved.mesh.vertices.size(), VertexConstraints::free);
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (std::uint32_t e = 0; e < halved.edges.size(); ++e) {
      const auto& [a, b] = halved.edges[e];
      if (!constraints.edge(a, b)) continue;
      const std::uint32_t middle = old + e;
      free[middle] = 0;
      // Which curve joins two corners does not matter: the middle stays where it is.
      constraints.curve[middle] = VertexConstraints::corner;
      for (const std::uint32_t end : {a, b})
        if (constraints.curve[end] < VertexConstraints::corner) constraints.curve[middle] = constraints.curve[end];
      edges.push_back({a, middle});
      edges.push_back({b, middle});
    }
    std::sort(edges.begin(), edges.end());
    constraints.edges = std::move(edges);
  }

  Tessellator& finest_;
  ExecutionContext& context_;
  MeshOptions options_;
  std::vector<std::size_t> counts_;     ///< of vertices, by level, the finest first
  std::unique_ptr<SampleSet> thinner_;  ///< a quarter of the finest samples; none if that is too few
  std::vector<SampleSet> samples_;      ///< by level, from 1 on; moved from once a level is made
};

/// As many as leave enough vertices, and edges short enough for all feature curves, on the coarsest.
std::size_t count_levels(const Tessellator& finest) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const FeatureCurve& curve : finest.result.features.curves) shortest = std::min(shortest, curve.length());
  std::size_t levels = 0;
  double edge = finest.result.sampling.sizing.mean();
  for (auto n = static_cast<double>(finest.wanted());; ++levels) {
    n /= 4;
    edge *= 2;
    if (n < min_base || shortest < shortest_curve * edge) return levels;
  }
}

}  // namespace

bool seed_by_levels(Tessellator& state) {
  const MeshOptions& o = state.options;
  if (!state.closed() || o.start != Start::coarse_to_fine || o.connect != Connect::complex ||
      o.placement != Placement::quadric)
    return false;
  const std::size_t levels = count_levels(state);
  if (levels == 0) return false;
  const FeatureSeeds feature_seeds = state.result.feature_seeds;
  if (Levels(state, levels).run()) return true;
  state.context.log("levels: seeds are spread without");
  state.result.feature_seeds = feature_seeds;
  return false;
}

}  // namespace evenmesh
