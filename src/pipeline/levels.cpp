#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "geometry/subdivide.h"
#include "grid/coarsen.h"
#include "evenmesh/measure.h"
#include "pipeline/draft.h"
#include "pipeline/tessellator.h"
#include "refine/flips.h"
#include "refine/shape_smoothing.h"

namespace evenmesh {
namespace {
static double env(const char* n, double d) { const char* e = std::getenv(n); return e ? std::atof(e) : d; }
static double cpu() { timespec t; clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }

constexpr double samples_per_seed = 80;

class Levels {
 public:
  explicit Levels(Tessellator& finest) : finest_(finest), context_(finest.context), options_(finest.options) {
    options_.connect = Connect::complex;
  }

  bool run() {
    std::size_t levels = 0;
    const double base = env("EM_BASE", 3000);
    for (double n = double(finest_.wanted()) / 4; n >= base; n /= 4) ++levels;
    if (levels == 0) return false;
    counts_.push_back(finest_.wanted() - std::size_t(env("EM_RES", 0.001) * finest_.wanted()));
    for (std::size_t l = 0; l < levels; ++l) counts_.push_back((counts_.back() + 6) / 4);
    make_samples(levels);
    std::unique_ptr<Tessellator> level = tessellator(levels);
    level->relax_all(counts_[levels]);
    level->connect();
    if (!level->fits()) repair_solid(*level);
    if (!level->fits()) { std::fprintf(stderr, "levels: base has %zu defects\n", level->defects().size()); return false; }
    const std::int64_t euler = level->result.complex.surface_euler;
    for (std::size_t l = 1; l <= levels; ++l) counts_[l] = std::size_t((std::int64_t(counts_[l - 1]) + 3 * euler + 2) / 4);
    if (std::llabs(std::int64_t(counts_[levels]) - std::int64_t(level->given())) > 0) {
      level->forget_split_cells();
      level->adjust_and_relax(counts_[levels]);
      level->connect();
      if (!level->fits()) return false;
    }
    std::fprintf(stderr, "levels: base %zu seeds %zu samples, cpu %.3f\n", level->result.seeds.size(), level->result.sampling.samples.size(), cpu());
    for (std::size_t l = levels; l-- > 0;) {
      std::vector<Vec3> seeds = subdivided(*level);
      std::unique_ptr<Tessellator> next;
      if (l > 0) next = tessellator(l);
      Tessellator& t = next ? *next : finest_;
      t.result.seeds = Seeds(std::move(seeds));
      t.result.seeds_are_vertices = true;
      repair_tips(t, counts_[l]);
      if (l == 0) break;
      t.connect();
      if (!t.fits()) repair_solid(t);
      if (!t.fits()) { std::fprintf(stderr, "levels: level %zu has %zu defects\n", l, t.defects().size()); return false; }
      level = std::move(next);
    }
    return true;
  }

 private:
  void make_samples(std::size_t levels) {
    sets_.resize(levels + 1);
    const SampleSet* from = &finest_.result.sampling.samples;
    raw_.push_back(nullptr);
    for (std::size_t l = 1; l <= levels; ++l) {
      if (double(from->size()) / 4 >= samples_per_seed * double(counts_[l])) {
        raw_.push_back(std::make_unique<SampleSet>(coarsen(*from, context_)));
        from = raw_.back().get();
      } else
        raw_.push_back(nullptr);
      sets_[l] = one_sample_per_edge(*from, context_);
    }
  }
  std::unique_ptr<Tessellator> tessellator(std::size_t l) {
    Sampling sampling;
    sampling.plan = finest_.result.sampling.plan;
    sampling.plan.vertices = counts_[l];
    sampling.samples = sets_[l];
    sampling.sizing = finest_.result.sampling.sizing.with_mean(edge_length_of(sets_[l].total_area, double(counts_[l])));
    return std::make_unique<Tessellator>(std::move(sampling), options_, kernels_, finest_.timer, context_);
  }

  void dbg(const char* what, const Mesh& m) { const auto q = measure_quality(m, context_); std::fprintf(stderr, "levels: %s %zu Q %.4f min %.3f irr %.4f ecv %.4f cpu %.3f\n", what, q.vertices, q.q_avg, q.q_min, q.irregular_ratio, q.edge_length_cv, cpu()); }

  std::vector<Vec3> subdivided(const Tessellator& level) {
    Draft draft = extract(level.result, options_, context_);
    const auto projector = make_projector(level.result.sampling.samples);
    flip_to_delaunay(draft.mesh, draft.constraints, context_);
    dbg("extracted", draft.mesh);
    smooth(draft, *projector, std::size_t(env("EM_LEV0", 40)));
    flip_to_delaunay(draft.mesh, draft.constraints, context_);
    dbg("smoothed", draft.mesh);
    draft.mesh = subdivide(draft.mesh, context_).mesh;
    draft.sizing = draft.sizing.with_mean(0.5 * draft.sizing.mean());
    const auto fine = make_projector(sets_[0].size() ? sets_[0] : finest_.result.sampling.samples);
    const std::size_t ev = std::size_t(env("EM_LEV1", 20));
    if (ev == 0) {
      for (Vec3& v : draft.mesh.vertices) v = fine->project(v, 0.5 * draft.sizing.edge(v));
    } else smooth(draft, *fine, ev);
    dbg("subdivided", draft.mesh);
    return std::move(draft.mesh.vertices);
  }
  void smooth(Draft& draft, const Projector& projector, std::size_t evaluations) {
    ShapeSmoothingOptions o;
    o.evaluations = evaluations;
    o.size_weight = env("EM_LMU", 0.1);
    smooth_shapes(draft.mesh, &projector, draft.sizing, o, context_, draft.constraints);
  }

  void repair_tips(Tessellator& t, std::size_t count) {
    const double heavy = env("EM_HEAVY", 2.0), light = env("EM_LIGHT", 0.25), off = env("EM_OFF", 0.35);
    CellSums sums;
    std::vector<Vec3>& x = t.result.seeds.positions;
    t.evaluator().evaluate(x, sums);
    const SampleSet& samples = t.result.sampling.samples;
    const double mean = samples.total_weight / double(x.size());
    const double edge = t.edge();
    std::vector<Vec3> places, kept, added;
    std::size_t removed = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double r = sums.mass[i] / mean;
      if (r < light) { places.push_back(x[i]); ++removed; continue; }
      const Vec3 shift = (1 / sums.mass[i]) * sums.moment[i];
      if (r > heavy || norm(shift) > off * edge) places.push_back(x[i]);
      double m = r;
      int k = 0;
      for (; m > heavy; m -= 1) { added.push_back(x[i] + shift + 0.3 * edge * normalized(Vec3{double((i * 7 + k * 3) % 5) - 2, double((i * 3 + k) % 5) - 2, double((i + k * 11) % 5) - 1.9})); ++k; }
      kept.push_back(x[i]);
    }
    const std::size_t n0 = x.size();
    x = kept;
    x.insert(x.end(), added.begin(), added.end());
    places.insert(places.end(), added.begin(), added.end());
    // to the count: exactly
    std::vector<Vec3> before = x;
    const std::size_t now = x.size();
    const std::size_t most = count + std::size_t(2 * env("EM_RES", 0.001) * finest_.wanted() * count / finest_.wanted());
    count = std::clamp(now, count, most);
    if (now != count) {
      t.adjust_count(count, 3);
      // changed places
      if (count > now) for (std::size_t i = now; i < t.result.seeds.size(); ++i) places.push_back(t.result.seeds.positions[i]);
      else {
        std::size_t j = 0;
        for (std::size_t i = 0; i < before.size(); ++i)
          if (j < count && before[i] == t.result.seeds.positions[j]) ++j; else places.push_back(before[i]);
      }
    }
    std::fprintf(stderr, "levels: tips: %zu seeds, %zu added, %zu removed, adjust %ld, %zu places, cpu %.3f\n", n0, added.size(), removed, long(count) - long(now), places.size(), cpu());
    t.relax_around(places, std::size_t(env("EM_TIPEV", 15)));
    std::fprintf(stderr, "levels: tips done cpu %.3f\n", cpu());
  }

  Tessellator& finest_;
  ExecutionContext& context_;
  MeshOptions options_;
  Kernels kernels_;
  std::vector<std::size_t> counts_;  ///< of vertices, by level, the finest first
  std::vector<std::unique_ptr<SampleSet>> raw_;
  std::vector<SampleSet> sets_;
};

}  // namespace

bool seed_by_levels(Tessellator& state) {
  if (!state.closed() || state.fixed() > 0 || env("EM_LEVELS", 1) == 0) return false;
  return Levels(state).run();
}

}  // namespace evenmesh
