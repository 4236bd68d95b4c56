#pragma once
/// Help for the tests of this room.

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/glsl.h"
#include "gl/glsl_field.h"
#include "gl/glsl_source.h"
#include "shape/fields.h"

namespace evenmesh::testing {

using Values = std::map<std::string, std::string>;

/// Points in [-reach, reach]³, the same on every machine.
inline Points scattered(std::size_t count, float reach = 1.5f) {
  Points points(0);
  std::uint32_t state = 12345;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    return (static_cast<float>(state >> 8) / 8388608.0f - 1.0f) * reach;
  };
  for (std::size_t i = 0; i < count; ++i) {
    points.x.push_back(next()), points.y.push_back(next()), points.z.push_back(next());
  }
  return points;
}

inline Shape shader(const std::string& text, const Values& definitions = {}, const std::string& entry = "map") {
  return shape_from_glsl(text, {.entry = entry, .definitions = definitions}, "test.glsl");
}

inline float value_at(const std::string& text, const Vec3& p, const Values& definitions = {},
                      const std::string& entry = "map") {
  const Shape shape = shader(text, definitions, entry);
  return static_cast<float>(shape.field()->evaluate(p, nullptr));
}

/// What a bad shader is refused with, by an error of the type E; "" if it is not.
template <typename E>
std::string refusal(const std::string& text, const Values& definitions = {}, const std::string& entry = "map") {
  try {
    shader(text, definitions, entry);
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

inline ::testing::AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

inline const std::string sphere = "float map(vec3 p) { return length(p) - 1.0; }\n";

}  // namespace evenmesh::testing
