#include "gl/glsl_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "evenmesh/error.h"
#include "gl/point_program.h"

namespace evenmesh::gl {
namespace {

constexpr std::size_t rows_of_gradient = 7;
constexpr float step_factor = 1.0f / 1024;
constexpr std::uint32_t some_loop = 0xffffffffu;  ///< instead of a line
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// As in field.glsl, bit by bit.
float step_at(float x, float y, float z, float scale) {
  const float size = std::max(std::max(std::abs(x), std::max(std::abs(y), std::abs(z))), scale);
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(size) & 0x7f800000u) * step_factor;
}

std::string shader_text(const GlslSource& source) {
  const Constants constants{{"EM_GROUP", PointProgram::group},
                            {"EM_SOME_LOOP", some_loop},
                            {"EM_BUDGET", loop_budget},
                            {"EM_STEP", step_factor},
                            {"EM_ENTRY", source.entry}};
  return assemble_shader("#include \"guard.glsl\"\n#line 1\n" + source.code + "#include \"field.glsl\"\n", constants);
}

std::string endless(const std::string& name, std::uint32_t line) {
  const std::string place = line == some_loop ? name + ": a loop" : fmt::format("{}:{}: this loop", name, line);
  return fmt::format(
      "{} does not end after {} rounds (all loops of one evaluation together); bound it, for instance "
      "for (int i = 0; i < 100; i++)",
      place, loop_budget);
}

}  // namespace

GlslField::GlslField(std::shared_ptr<Context> context, GlslSource source, const FieldTraits& traits)
    : source_(std::move(source)),
      context_(std::move(context)),
      device_(std::make_unique<PointProgram>()),
      scale_(std::exp2(std::floor(std::log2(std::clamp(traits.scale, 1e-30, 1e30))))),
      lipschitz_(traits.lipschitz) {
  const std::string text = shader_text(source_);
  try {
    context_->run([&] {
      *device_ = PointProgram(context_, text, source_.text.name);
      device_->program().set("em_two", 2);
      device_->program().set("em_scale", static_cast<float>(scale_));
      device_->program().set("em_level", static_cast<float>(traits.level));
    });
  } catch (const ShaderError& error) {
    throw UnusableInput(source_.explain(error.log()));
  }
}

GlslField::~GlslField() = default;

/// Values of some rows (see field.glsl); rows × points of them.
void GlslField::run(const PointBatch& points, std::span<const std::span<float>> values) const {
  std::uint32_t line = 0;
  context_->run([&] { line = device_->run(points, static_cast<unsigned>(values.size()), values); });
  if (line != 0) throw UnusableInput(endless(source_.text.name, line));
}

void GlslField::drop_infinite(std::span<float> values) const {
  std::size_t count = 0;
  for (float& value : values) {
    if (std::isfinite(value)) continue;
    ++count;
    if (value < 0) value = nan;
  }
  if (count > 0) non_finite_ += count;
}

void GlslField::evaluate(const PointBatch& points, std::span<float> values) const {
  if (values.empty()) return;
  run(points, {&values, 1});
  drop_infinite(values);
}

void GlslField::evaluate_gradient(const PointBatch& points, std::span<float> values, std::span<float> dx,
                                  std::span<float> dy, std::span<float> dz) const {
  const std::size_t count = values.size();
  if (count == 0) return;
  std::vector<float> below(3 * count);
  const std::array<std::span<float>, 3> at{dx, dy, dz};
  std::array<std::span<float>, rows_of_gradient> rows{values};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows[1 + 2 * axis] = at[axis];
    rows[2 + 2 * axis] = std::span<float>(below).subspan(axis * count, count);
  }
  run(points, rows);
  for (const std::span<float> row : rows) drop_infinite(row);
  const float scale = static_cast<float>(scale_);
  const std::array<std::span<const float>, 3> p{points.x, points.y, points.z};
  for (std::size_t i = 0; i < count; ++i) {
    const float step = step_at(p[0][i], p[1][i], p[2][i], scale);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float apart = (p[axis][i] + step) - (p[axis][i] - step);
      at[axis][i] = (at[axis][i] - below[axis * count + i]) / apart;
    }
  }
}

Interval GlslField::evaluate(const Box& box) const {
  Interval range{};
  enclose({&box, 1}, {&range, 1});
  return range;
}

void GlslField::enclose(std::span<const Box> boxes, std::span<Interval> ranges) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::fill(ranges.begin(), ranges.end(), Interval{-infinity, infinity});
  if (!lipschitz_ || boxes.empty()) return;
  std::vector<float> x(boxes.size()), y(boxes.size()), z(boxes.size()), f(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 c = boxes[i].center();
    x[i] = static_cast<float>(c.x);
    y[i] = static_cast<float>(c.y);
    z[i] = static_cast<float>(c.z);
  }
  evaluate(PointBatch{x, y, z}, f);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!std::isfinite(f[i])) continue;
    // The point that was asked for is the rounded one; a few roundings happen within f, too.
    const Vec3 asked{x[i], y[i], z[i]};
    const double reach = 0.5 * boxes[i].diagonal() + norm(asked - boxes[i].center());
    const double rounding = 1e-5 * (std::abs(f[i]) + *lipschitz_ * (norm(asked) + reach + scale_));
    const double margin = *lipschitz_ * reach + rounding;
    ranges[i] = {f[i] - margin, f[i] + margin};
  }
}

double GlslField::evaluate(const Vec3& point, Vec3* gradient) const {
  return Field::evaluate(point, gradient);
}

}  // namespace evenmesh::gl
