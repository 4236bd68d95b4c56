// Sampling of a shader: seconds, how many evaluations it takes, and what they cost by themselves.
//
//   bench_glsl FILE [RESOLUTION [LIPSCHITZ [DEVICE [NAME=VALUE …]]]]      512, none, the best device; bounds ±1.25
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/glsl.h"
#include "sample/sample.h"
#include "shape/field.h"

using namespace evenmesh;

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Counts the points asked for; a gradient takes seven of them.
class Counting final : public Field {
 public:
  explicit Counting(std::shared_ptr<const Field> field) : field_(std::move(field)) {}
  void evaluate(const PointBatch& points, std::span<float> values) const override {
    calls += 1, values_ += values.size();
    field_->evaluate(points, values);
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    calls += 1, gradients += values.size();
    field_->evaluate_gradient(points, values, dx, dy, dz);
  }
  Interval evaluate(const Box& box) const override { return field_->evaluate(box); }
  double evaluate(const Vec3& point, Vec3* gradient) const override { return field_->evaluate(point, gradient); }
  void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const override {
    calls += 1, boxes_ += boxes.size();
    field_->enclose(boxes, ranges);
  }
  double epsilon() const override { return field_->epsilon(); }
  bool differentiates() const override { return field_->differentiates(); }
  bool encloses_surely() const override { return field_->encloses_surely(); }
  std::size_t batch_size() const override { return field_->batch_size(); }

  std::size_t total() const { return values_ + 7 * gradients + boxes_; }
  mutable std::atomic<std::size_t> calls{0}, values_{0}, gradients{0}, boxes_{0};

 private:
  std::shared_ptr<const Field> field_;
};

/// Seconds per evaluation at random points, in one batch after the other.
double raw_cost(const Field& field, std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> side(-1.25f, 1.25f);
  std::vector<float> x(1 << 18), y(x.size()), z(x.size()), f(x.size());
  for (auto* v : {&x, &y, &z})
    for (float& c : *v) c = side(random);
  field.evaluate({x, y, z}, f);
  const double begin = now();
  std::size_t done = 0;
  for (; done < count; done += f.size()) field.evaluate({x, y, z}, f);
  return (now() - begin) / static_cast<double>(done);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) return std::printf("bench_glsl FILE [RESOLUTION [LIPSCHITZ [DEVICE [NAME=VALUE …]]]]\n"), 2;
  std::ifstream file(argv[1]);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  GlslOptions options;
  const std::size_t resolution = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2])) : 512;
  if (argc > 3 && std::atof(argv[3]) > 0) options.lipschitz = std::atof(argv[3]);
  if (argc > 4) options.device = argv[4];
  for (int i = 5; i < argc; ++i) {
    const std::string definition = argv[i];
    options.definitions[definition.substr(0, definition.find('='))] = definition.substr(definition.find('=') + 1);
  }
  options.bounds = {{-1.25, -1.25, -1.25}, {1.25, 1.25, 1.25}};
  Shape shape = shape_from_glsl(text, options, argv[1]);
  const auto field = std::get<std::shared_ptr<const Field>>(shape.what);
  const double cost = raw_cost(*field, std::size_t{1} << 24);
  const auto counting = std::make_shared<Counting>(field);
  shape.what = std::shared_ptr<const Field>(counting);
  const double begin = now();
  ExecutionContext context;
  const SampleSet samples = sample_shape(shape, make_grid(shape.bounds, resolution), context);
  const double seconds = now() - begin, evaluations = static_cast<double>(counting->total());
  std::printf("%s on %s\n", argv[1], gl_renderer(options.device).c_str());
  std::printf("raw: %.1f million evaluations per second\n", 1e-6 / cost);
  std::printf(
      "%zu samples in %.2f s; %.1f million evaluations (%.1f of values, %.1f of %.2f gradients, %.2f of boxes) in "
      "%zu calls: %.2f times their raw cost\n",
      samples.size(), seconds, 1e-6 * evaluations, 1e-6 * double(counting->values_), 7e-6 * double(counting->gradients),
      1e-6 * double(counting->gradients), 1e-6 * double(counting->boxes_), counting->calls.load(),
      seconds / (evaluations * cost));
} catch (const Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
