#pragma once
/// Values of uniforms, from words on a command line.

#include <optional>
#include <string>
#include <string_view>

namespace evenmesh::gl {

/// Whether a uniform of this type can be given a value: bool, and int, uint, float, their vectors and square matrices.
bool is_plain_type(std::string_view type);

/// A constant of the type: "vec3(1, 0, 0.5)" from "1,0,0.5"; one number also fills a vector.
/// @throws InvalidInput  names the uniform and what it takes
std::string glsl_value(std::string_view type, std::string_view name, std::string_view value);

/// What a name that hosts of shaders set stands for here, as an expression that converts to `type`: 0, and 1024 for
/// resolutions. Empty for all other names.
std::string host_value(std::string_view type, std::string_view name);

/// Type of a name that Shadertoy declares for all its shaders ("float" for iTime), or nothing.
std::optional<std::string_view> host_type(std::string_view name);

}  // namespace evenmesh::gl
