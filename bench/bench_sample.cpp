// Time per sample: scan conversion of a mesh, conversion to blocks, implicit surfaces, coarsening.

#include <benchmark/benchmark.h>

#include "geometry/primitives.h"
#include "grid/coarsen.h"
#include "sample/sample.h"
#include "sample/scan.h"

namespace evenmesh {
namespace {

void per_sample(benchmark::State& state, std::size_t samples) {
  state.counters["samples"] = static_cast<double>(samples);
  state.counters["per_sample"] = benchmark::Counter(
      static_cast<double>(samples), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void scan(benchmark::State& state) {
  const Mesh mesh = make_icosphere(6);  // 82,000 triangles
  const Grid grid = make_grid(mesh.bounds(), static_cast<std::size_t>(state.range(0)));
  std::size_t size = 0;
  for (auto _ : state) size = scan_mesh(mesh, grid).size();
  per_sample(state, size);
}
BENCHMARK(scan)->Arg(170)->Arg(650)->Unit(benchmark::kMillisecond)->UseRealTime();

void convert(benchmark::State& state) {
  const Mesh mesh = make_icosphere(6);
  const TriDexel solid = scan_mesh(mesh, make_grid(mesh.bounds(), static_cast<std::size_t>(state.range(0))));
  for (auto _ : state) benchmark::DoNotOptimize(sample_dexels(solid, mesh, ExecutionContext::silent()));
  per_sample(state, solid.size());
}
BENCHMARK(convert)->Arg(170)->Arg(650)->Unit(benchmark::kMillisecond)->UseRealTime();

void octic(benchmark::State& state) {
  const Shape shape = gallery_shape("octic");
  const Grid grid = make_grid(shape.bounds, static_cast<std::size_t>(state.range(0)));
  std::size_t size = 0;
  for (auto _ : state) size = sample_shape(shape, grid).size();
  per_sample(state, size);
}
BENCHMARK(octic)->Arg(185)->Arg(400)->Unit(benchmark::kMillisecond)->UseRealTime();

void coarsened(benchmark::State& state) {
  const Shape shape = gallery_shape("octic");
  const SampleSet fine = sample_shape(shape, make_grid(shape.bounds, 400));
  for (auto _ : state) benchmark::DoNotOptimize(coarsen(fine));
  per_sample(state, fine.size());
}
BENCHMARK(coarsened)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace evenmesh
