// The shell method's foundation: voxelization of a mesh and the narrow-band distance transform.
//
//   bench_shell armadillo.obj [Google Benchmark's options]
//
// Without a file a torus. Arguments: voxels along the longest side, reach d, threads (0 = all processors).
#include <benchmark/benchmark.h>
#include <malloc.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/task_arena.h>

#include <fstream>
#include <string>

#include "band/narrow_band.h"
#include "evenmesh/io.h"
#include "geometry/primitives.h"

namespace {

using namespace evenmesh;

Mesh& model() {
  static Mesh mesh = make_torus(1, 0.35, 256, 128);
  return mesh;
}

/// How far the process' memory rises above what it was at the start; Linux only, 0 elsewhere.
class PeakMemory {
 public:
  PeakMemory() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";  // forgets the peak
    before_ = kibibytes("VmRSS:");
  }
  double bytes() const { return 1024.0 * (kibibytes("VmHWM:") - before_); }

 private:
  static double kibibytes(const std::string& key) {
    std::ifstream in("/proc/self/status");
    for (std::string word; in >> word;)
      if (double value = 0; word == key && in >> value) return value;
    return 0;
  }
  double before_ = 0;
};

void voxelization(benchmark::State& state) {
  const VoxelGrid grid = make_voxel_grid(model().bounds(), static_cast<std::size_t>(state.range(0)), 10);
  ExecutionContext context(static_cast<unsigned>(state.range(1)));
  SiteVoxels sites;
  for (auto _ : state) {
    sites = {};
    sites = voxelize_mesh(model(), grid, context);
  }
  state.counters["sites"] = static_cast<double>(sites.size());
  state.counters["bytes"] = static_cast<double>(sites.bytes());
}

/// Both stages, and the memory they take at most.
void both(benchmark::State& state) {
  const VoxelGrid grid = make_voxel_grid(model().bounds(), static_cast<std::size_t>(state.range(0)), 10);
  ExecutionContext context(static_cast<unsigned>(state.range(1)));
  double peak = 0;
  for (auto _ : state) {
    const PeakMemory memory;
    const SiteVoxels sites = voxelize_mesh(model(), grid, context);
    const NarrowBand shell = build_narrow_band(sites, static_cast<unsigned>(state.range(2)), context);
    peak = memory.bytes();
    state.counters["voxels"] = static_cast<double>(shell.size());
    state.counters["bytes"] = static_cast<double>(sites.bytes() + shell.bytes());
  }
  state.counters["peak"] = peak;
}

/// OpenVDB's narrow band of the same width around the same mesh, signed, with its memory.
void openvdb_band(benchmark::State& state) {
  const double side = model().bounds().longest_side() / static_cast<double>(state.range(0));
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(side);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const Vec3& v : model().vertices) points.emplace_back(v.x, v.y, v.z);
  for (const Triangle& t : model().triangles) triangles.emplace_back(t[0], t[1], t[2]);
  tbb::task_arena arena(state.range(1) == 0 ? tbb::task_arena::automatic : static_cast<int>(state.range(1)));
  double peak = 0;
  for (auto _ : state) {
    const PeakMemory memory;
    const auto grid = arena.execute([&] {
      return openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles,
                                                                static_cast<float>(state.range(2)));
    });
    peak = memory.bytes();
    state.counters["voxels"] = static_cast<double>(grid->activeVoxelCount());
  }
  state.counters["peak"] = peak;
}

void transform(benchmark::State& state) {
  const VoxelGrid grid = make_voxel_grid(model().bounds(), static_cast<std::size_t>(state.range(0)), 10);
  ExecutionContext context(static_cast<unsigned>(state.range(1)));
  const SiteVoxels sites = voxelize_mesh(model(), grid, context);
  NarrowBand shell;
  for (auto _ : state) {
    shell = {};
    shell = build_narrow_band(sites, static_cast<unsigned>(state.range(2)), context);
  }
  state.counters["voxels"] = static_cast<double>(shell.size());
  state.counters["bytes"] = static_cast<double>(shell.bytes());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && argv[1][0] != '-') {
    model() = read_mesh(argv[1]);
    argv[1] = argv[0], ++argv, --argc;
  }
  benchmark::RegisterBenchmark("voxelization", voxelization)
      ->ArgsProduct({{512, 1024, 2048}, {0, 1}})
      ->ArgNames({"res", "threads"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("transform", transform)
      ->ArgsProduct({{512, 1024, 2048}, {0, 1}, {3, 9}})
      ->ArgNames({"res", "threads", "d"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("openvdb", openvdb_band)
      ->ArgsProduct({{512, 1024, 2048}, {0, 1}, {3}})
      ->ArgNames({"res", "threads", "d"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("both", both)
      ->ArgsProduct({{512, 1024, 2048}, {0, 1}, {3, 9}})
      ->ArgNames({"res", "threads", "d"})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
