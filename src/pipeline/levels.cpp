#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/random.h"
#include "geometry/subdivide.h"
#include "grid/coarsen.h"
#include "pipeline/draft.h"
#include "pipeline/tessellator.h"
#include "refine/dislocations.h"
#include <ctime>
#include <cstdio>
#include "refine/flips.h"
#include "refine/shape_smoothing.h"

namespace evenmesh {
namespace {
static double env(const char* n, double d) {
  const char* e = std::getenv(n);
  return e ? std::atof(e) : d;
}

constexpr double min_base = 3000;        ///< vertices of the coarsest mesh
constexpr double samples_per_seed = 80;  ///< wanted on every level
constexpr double shortest_curve = 0.7;   ///< that a level follows, in edges
constexpr double smoothing_size_weight = 0.1;
constexpr std::size_t base_evaluations = 40, level_evaluations = 12, middle_evaluations = 8;
constexpr double count_tolerance = 0.001;  ///< of the vertices asked for

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
    const std::size_t coarsest = samples_.size() - 1;
    coarsen_samples();
    std::unique_ptr<Tessellator> level = make_base();
    if (!level) return false;
    finest_.result.energies = level->result.energies;
    for (std::size_t l = coarsest; l-- > 0;) {
      Draft mesh = smoothed(*level, l + 1 == coarsest ? base_evaluations : level_evaluations);
      std::unique_ptr<Tessellator> next = l > 0 ? make_level(l) : nullptr;
      Tessellator& finer = next ? *next : finest_;
      seed_from(std::move(mesh), *level, finer);
      const double n = static_cast<double>(counts_[l]);
      const auto thinner = next || !thinner_ ? nullptr : finest_.evaluator().for_samples(*thinner_, context_);
      MisfitRepair(finer, thinner ? *thinner : finer.evaluator())
          .run(counts_[l], static_cast<std::size_t>((1 + 2 * count_tolerance) * n));
      if (next && !connected(*next)) return false;
      level = std::move(next);
    }
    return true;
  }

 private:
  /// Of a mesh that has so many with a vertex in the middle of every edge.
  static std::size_t parent_count(std::size_t count, std::int64_t euler) {
    return static_cast<std::size_t>(std::max<std::int64_t>(4, (static_cast<std::int64_t>(count) + 3 * euler + 2) / 4));
  }

  void coarsen_samples() {
    finest_.timer.stage("relax", 0, [&] {
      std::vector<std::unique_ptr<SampleSet>> thinner;
      const SampleSet* from = &finest_.result.sampling.samples;
      for (std::size_t l = 1; l < samples_.size(); ++l) {
        if (static_cast<double>(from->size()) / 4 >= samples_per_seed * static_cast<double>(counts_[l]))
          from = thinner.emplace_back(std::make_unique<SampleSet>(coarsen(*from, context_))).get();
        samples_[l] = one_sample_per_edge(*from, context_);
      }
      if (!thinner.empty()) thinner_ = std::move(thinner.front());
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
    if (!level.fits()) repair_solid(level);
    if (!level.fits())
      context_.log(fmt::format("levels: {} defects among {} cells", level.defects().size(), level.result.seeds.size()));
    return level.fits();
  }

  Draft smoothed(const Tessellator& level, std::size_t evaluations) const {
    return finest_.timer.stage("relax", 0, [&] {
      Draft draft = extract(level.result, options_, context_);
      flip_to_delaunay(draft.mesh, draft.constraints, context_);
      smooth(draft, level.result.sampling.samples, evaluations);
      if (evaluations == base_evaluations && env("EM_WORK", 0) > 0) {
        const auto projector = make_projector(level.result.sampling.samples);
        flip_to_delaunay(draft.mesh, draft.constraints, context_);
        timespec t0, t1;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t0);
        const auto r = remove_dislocations(draft.mesh, projector.get(), draft.sizing, {.work = std::size_t(env("EM_WORK", 0)), .size_weight = smoothing_size_weight, .irregular_cost = env("EM_COST", 0.4), .tolerance = env("EM_TOL", 0.3)}, context_, draft.constraints);
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t1);
        std::fprintf(stderr, "dbg dislocations %zu -> %zu of %zu, cpu %.3f\n", r.irregular_before, r.irregular, draft.mesh.vertices.size(), t1.tv_sec - t0.tv_sec + 1e-9 * (t1.tv_nsec - t0.tv_nsec));
        draft.planes.clear();
        smooth(draft, level.result.sampling.samples, evaluations / 2);
      }
      flip_to_delaunay(draft.mesh, draft.constraints, context_);
      return draft;
    });
  }
  void smooth(Draft& draft, const SampleSet& samples, std::size_t evaluations) const {
    const auto projector = make_projector(samples);
    const ShapeSmoothingOptions options{
        .size_weight = smoothing_size_weight, .evaluations = evaluations, .planes = draft.planes};
    smooth_shapes(draft.mesh, projector.get(), draft.sizing, options, context_, draft.constraints);
  }

  /// Seeds where a mesh with a vertex in the middle of every edge has them; on feature curves evenly spaced.
  void seed_from(Draft draft, const Tessellator& coarse, Tessellator& finer) const {
    finest_.timer.stage("relax", 0, [&] {
      SubdividedMesh halved = subdivide(draft.mesh, context_);
      VertexConstraints& constraints = draft.constraints;
      std::vector<char> on_curve(halved.mesh.vertices.size(), 0);
      for (std::size_t l = 0; l < coarse.fixed(); ++l)
        if (const std::uint32_t v = draft.vertex_of_label[l]; v != Draft::none) on_curve[v] = 1;
      if (!constraints.curve.empty()) halve_constraints(halved, draft, on_curve);
      draft.planes.clear();
      draft.mesh = std::move(halved.mesh);
      draft.sizing = draft.sizing.with_mean(0.5 * draft.sizing.mean());
      smooth(draft, finer.result.sampling.samples, middle_evaluations);
      finer.result.feature_seeds = halve_spacing(coarse.result.features, coarse.result.feature_seeds);
      finer.result.seeds = finer.result.feature_seeds.seeds;
      for (std::size_t v = 0; v < on_curve.size(); ++v)
        if (!on_curve[v]) finer.result.seeds.positions.push_back(draft.mesh.vertices[v]);
      finer.result.seeds_are_vertices = true;
    });
  }
  static void halve_constraints(const SubdividedMesh& halved, Draft& draft, std::vector<char>& on_curve) {
    VertexConstraints& constraints = draft.constraints;
    const auto old = static_cast<std::uint32_t>(constraints.curve.size());
    constraints.curve.resize(halved.mesh.vertices.size(), VertexConstraints::free);
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (std::uint32_t e = 0; e < halved.edges.size(); ++e) {
      const auto& [a, b] = halved.edges[e];
      if (!constraints.edge(a, b)) continue;
      const std::uint32_t middle = old + e;
      on_curve[middle] = 1;
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
    if (n < env("EM_BASE", min_base) || shortest < shortest_curve * edge) return levels;
  }
}

}  // namespace

bool seed_by_levels(Tessellator& state) {
  const MeshOptions& o = state.options;
  if (!state.closed() || o.start != Start::coarse_to_fine || o.connect != Connect::complex ||
      o.placement != Placement::quadric || env("EM_LEVELS", 1) == 0)
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
