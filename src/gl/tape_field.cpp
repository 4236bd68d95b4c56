#include "gl/tape_field.h"

#include <array>
#include <utility>

#include "gl/point_program.h"
#include "gl/tape_glsl.h"
#include "shape/expression_field.h"

namespace evenmesh::gl {
namespace {

std::string shader_text(const std::string& code, std::int32_t rows) {
  const Constants constants{{"EM_GROUP", PointProgram::group}, {"EM_ROWS", rows}};
  return assemble_shader("#include \"tape_math.glsl\"\n#line 1\n" + code + "#include \"tape.glsl\"\n", constants);
}

class TapeField final : public Field {
 public:
  TapeField(std::shared_ptr<Context> context, const ExpressionGraph& graph)
      : on_cpu_(make_graph_field(graph)), context_(std::move(context)), device_(std::make_unique<Device>()) {
    const Tape tape = compile_tape(graph);
    const std::string values = shader_text(glsl_of_tape(tape), 1);
    const std::string gradients = shader_text(glsl_of_tape_gradient(tape), 4);
    context_->run([&] {
      device_->values = PointProgram(context_, values, "of the expression");
      device_->gradients = PointProgram(context_, gradients, "of the expression's gradient");
    });
  }

  void evaluate(const PointBatch& points, std::span<float> values) const override {
    if (values.empty()) return;
    context_->run([&] { device_->values.run(points, 1, {&values, 1}); });
  }
  void evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx, std::span<float> dy,
                         std::span<float> dz) const override {
    if (values.empty()) return;
    const std::array<std::span<float>, 4> rows{values, dx, dy, dz};
    context_->run([&] { device_->gradients.run(points, 1, rows); });
  }
  Interval evaluate(const Box& box) const override { return on_cpu_->evaluate(box); }
  void enclose(std::span<const Box> boxes, std::span<Interval> ranges) const override {
    on_cpu_->enclose(boxes, ranges);
  }
  double evaluate(const Vec3& point, Vec3* gradient) const override { return on_cpu_->evaluate(point, gradient); }
  std::size_t batch_size() const override { return 262'144; }

 private:
  struct Device {
    PointProgram values{}, gradients{};
  };

  std::shared_ptr<const Field> on_cpu_;
  std::shared_ptr<Context> context_;
  std::unique_ptr<Device> device_;  ///< touched in jobs only
};

}  // namespace

std::shared_ptr<const Field> make_tape_field(std::shared_ptr<Context> context, const ExpressionGraph& graph) {
  return std::make_shared<TapeField>(std::move(context), graph);
}

bool is_tape_field(const Field& field) {
  return dynamic_cast<const TapeField*>(&field) != nullptr;
}

}  // namespace evenmesh::gl
