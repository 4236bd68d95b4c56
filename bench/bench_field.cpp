// Nanoseconds per point of fields: values, gradients, and intervals per box.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/random.h"
#include "evenmesh/shape.h"
#include "shape/bounds.h"
#include "shape/field.h"

namespace evenmesh {
namespace {

constexpr std::size_t point_count = 4096;

struct Points {
  std::vector<float> x, y, z, values, dx, dy, dz;
  explicit Points(const Box& box)
      : x(point_count),
        y(point_count),
        z(point_count),
        values(point_count),
        dx(point_count),
        dy(point_count),
        dz(point_count) {
    Random random(1);
    const Vec3 size = box.size();
    for (std::size_t i = 0; i < point_count; ++i) {
      x[i] = static_cast<float>(box.lo.x + size.x * random.uniform());
      y[i] = static_cast<float>(box.lo.y + size.y * random.uniform());
      z[i] = static_cast<float>(box.lo.z + size.z * random.uniform());
    }
  }
  PointBatch batch() const { return {x, y, z}; }
};

void per_point(benchmark::State& state) {
  state.counters["s/point"] = benchmark::Counter(
      static_cast<double>(point_count), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void values(benchmark::State& state, const std::string& name) {
  const Shape shape = gallery_shape(name);
  Points points(shape.bounds);
  for (auto _ : state) {
    shape.field()->evaluate(points.batch(), points.values);
    benchmark::DoNotOptimize(points.values.data());
    benchmark::ClobberMemory();
  }
  per_point(state);
}

void gradients(benchmark::State& state, const std::string& name) {
  const Shape shape = gallery_shape(name);
  Points points(shape.bounds);
  for (auto _ : state) {
    shape.field()->evaluate_gradient(points.batch(), points.values, points.dx, points.dy, points.dz);
    benchmark::DoNotOptimize(points.values.data());
    benchmark::ClobberMemory();
  }
  per_point(state);
}

void intervals(benchmark::State& state, const std::string& name) {
  const Shape shape = gallery_shape(name);
  Box box{shape.bounds.lo, shape.bounds.center()};
  for (auto _ : state) {
    benchmark::DoNotOptimize(shape.field()->evaluate(box));
    benchmark::ClobberMemory();
  }
}

void bounds(benchmark::State& state, const std::string& name) {
  const Shape shape = gallery_shape(name);
  for (auto _ : state) benchmark::DoNotOptimize(find_bounds(*shape.field()));
}

const bool registered = [] {
  for (const GalleryEntry& entry : gallery()) {
    const std::string name(entry.name);
    benchmark::RegisterBenchmark(("values/" + name).c_str(), values, name);
    benchmark::RegisterBenchmark(("gradient/" + name).c_str(), gradients, name);
    benchmark::RegisterBenchmark(("interval/" + name).c_str(), intervals, name);
    benchmark::RegisterBenchmark(("find_bounds/" + name).c_str(), bounds, name)->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace evenmesh

BENCHMARK_MAIN();
