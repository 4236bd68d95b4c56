// Time of refining and measuring, with one thread and with several: half-edges, rings, flips, polish, topology,
// quality, intersections. Vertices are shaken by a tenth of an edge: some 2 % of the edges flip, some 15 % of the
// triangles are bad.

#include <benchmark/benchmark.h>

#include "core/parallel.h"
#include "core/random.h"
#include "evenmesh/measure.h"
#include "geometry/half_edges.h"
#include "geometry/primitives.h"
#include "measure/topology.h"
#include "refine/flips.h"
#include "refine/polish.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

const Mesh& shaken_sphere() {
  static const Mesh mesh = [] {
    Mesh sphere = make_icosphere(7);  // 164,000 vertices, 328,000 triangles
    Random random(1);
    const double edge = 1.0 / 140;
    for (Vec3& v : sphere.vertices) {
      const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
      v = normalized(v + 0.1 * edge * Vec3{x, y, z});
    }
    return sphere;
  }();
  return mesh;
}

/// Calls work(mesh, context) on copies of the mesh with as many threads as the argument says.
template <typename Work>
void measure(benchmark::State& state, const Work& work) {
  ExecutionContext context(static_cast<unsigned>(state.range(0)));
  for (auto _ : state) {
    state.PauseTiming();
    Mesh mesh = shaken_sphere();
    state.ResumeTiming();
    with_threads(context, [&] { work(mesh, context); });
  }
}

void half_edges(benchmark::State& state) {
  measure(state, [](Mesh& mesh, ExecutionContext&) {
    benchmark::DoNotOptimize(HalfEdges(mesh.triangles, mesh.vertices.size()).outgoing(0));
  });
}
void rings(benchmark::State& state) {
  measure(state, [](Mesh& mesh, ExecutionContext&) { benchmark::DoNotOptimize(VertexRings(mesh).triangles(0)); });
}
void flips(benchmark::State& state) {
  measure(state, [](Mesh& mesh, ExecutionContext&) { benchmark::DoNotOptimize(flip_to_delaunay(mesh)); });
}
void polish_without_surface(benchmark::State& state) {
  measure(state,
          [](Mesh& mesh, ExecutionContext& context) { benchmark::DoNotOptimize(polish(mesh, nullptr, context)); });
}
void topology(benchmark::State& state) {
  measure(state, [](Mesh& mesh, ExecutionContext&) { benchmark::DoNotOptimize(measure_topology(mesh).components); });
}
void quality(benchmark::State& state) {
  measure(state, [](Mesh& mesh, ExecutionContext& context) {
    benchmark::DoNotOptimize(measure_quality(mesh, context).q_avg);
  });
}
void intersections(benchmark::State& state) {
  measure(state, [](Mesh& mesh, ExecutionContext& context) {
    benchmark::DoNotOptimize(self_intersections(mesh, context).size());
  });
}

BENCHMARK(half_edges)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(rings)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(flips)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(polish_without_surface)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(topology)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(quality)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(intersections)->Arg(1)->Arg(2)->Arg(8)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace evenmesh
