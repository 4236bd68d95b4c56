// Any bytes as an expression: it is refused with InvalidInput, or it parses and evaluates without a fault.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "evenmesh/error.h"
#include "evenmesh/shape.h"
#include "shape/field.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace evenmesh;
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const Shape shape = shape_from_expression(text, {{"a", 0.5}, {"R", 2.0}});
    const Field& field = *shape.field();
    const std::array<float, 5> x{0.0f, 0.5f, -1.0f, 3.0f, -20000.0f}, y{0.0f, -0.25f, 1.0f, 7.0f, 1e30f},
        z{0.0f, 1.0f, -2.0f, 0.125f, -1e-30f};
    std::array<float, 5> f, dx, dy, dz;
    field.evaluate(PointBatch{x, y, z}, f);
    field.evaluate_gradient(PointBatch{x, y, z}, f, dx, dy, dz);
    const Box box{{-1, -2, 0}, {0.5, 3, 0.25}};
    (void)field.evaluate(box);
    Vec3 gradient;
    (void)field.evaluate(box.center(), &gradient);
    if (const auto special = field.specialized(box)) special->evaluate(PointBatch{x, y, z}, f);
  } catch (const InvalidInput&) {
    // A formula that is not one; anything else is a fault.
  }
  return 0;
}
