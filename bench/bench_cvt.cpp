// The CVT kernel: nearest seeds, and a full evaluation of the energy with footprints.
// Items are samples; divide by the time to get samples per second. Threads: all processors, or one.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>

#include "core/parallel.h"
#include "cvt/relax.h"
#include "cvt/starts.h"
#include "evenmesh/shape.h"
#include "sample/sample.h"

namespace {

using namespace evenmesh;

struct Surface {
  SampleSet samples;
  std::vector<Vec3> seeds;
};

/// The octic with 100 samples per seed, seeds in balance.
const Surface& surface(std::size_t count) {
  static std::map<std::size_t, Surface> surfaces;
  auto [it, is_new] = surfaces.try_emplace(count);
  if (is_new) {
    const Shape shape = gallery_shape("octic");
    const double presampled = static_cast<double>(sample_shape(shape, make_grid(shape.bounds, 64)).size());
    it->second.samples = sample_shape(
        shape, make_grid(shape.bounds,
                         static_cast<std::size_t>(64 * std::sqrt(100.0 * static_cast<double>(count) / presampled))));
    ExecutionContext& context = ExecutionContext::silent();
    CpuCellEvaluator evaluator(it->second.samples, context);
    it->second.seeds = relax_seeds(evaluator, count, {}, context).seeds.positions;
  }
  return it->second;
}

/// Repeats work(evaluator, seeds) with seeds that move a little each time, as in an optimization.
template <typename Work>
void repeat(benchmark::State& state, const Work& work) {
  const Surface& s = surface(static_cast<std::size_t>(state.range(0)));
  ExecutionContext context(static_cast<unsigned>(state.range(1)));
  with_threads(context, [&] {
    CpuCellEvaluator evaluator(s.samples, context);
    std::vector<Vec3> seeds = s.seeds;
    const double step = 1e-3 * std::sqrt(s.samples.total_area / static_cast<double>(seeds.size()));
    double sign = 1;
    for (auto _ : state) {
      for (Vec3& p : seeds) p.x += sign * step;
      sign = -sign;
      work(evaluator, seeds);
    }
  });
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(s.samples.size()));
}

void Evaluate(benchmark::State& state) {
  CellSums sums;
  repeat(state, [&](CellEvaluator& evaluator, const std::vector<Vec3>& seeds) { evaluator.evaluate(seeds, sums); });
}
void Nearest(benchmark::State& state) {
  std::vector<std::uint32_t> labels;
  repeat(state, [&](CellEvaluator& evaluator, const std::vector<Vec3>& seeds) { evaluator.nearest(seeds, labels); });
}

const std::vector<std::vector<std::int64_t>> cases = {{20000, 60000}, {0, 1}};
BENCHMARK(Nearest)->ArgsProduct(cases)->ArgNames({"seeds", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(Evaluate)->ArgsProduct(cases)->ArgNames({"seeds", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
