#include "gl/glsl_values.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "evenmesh/error.h"

namespace evenmesh::gl {
namespace {

struct PlainType {
  std::string_view name;
  std::size_t components;
  char kind;  ///< b, i, u, f
};

constexpr std::array<PlainType, 19> types{{{"bool", 1, 'b'},
                                           {"int", 1, 'i'},
                                           {"uint", 1, 'u'},
                                           {"float", 1, 'f'},
                                           {"bvec2", 2, 'b'},
                                           {"bvec3", 3, 'b'},
                                           {"bvec4", 4, 'b'},
                                           {"ivec2", 2, 'i'},
                                           {"ivec3", 3, 'i'},
                                           {"ivec4", 4, 'i'},
                                           {"uvec2", 2, 'u'},
                                           {"uvec3", 3, 'u'},
                                           {"uvec4", 4, 'u'},
                                           {"vec2", 2, 'f'},
                                           {"vec3", 3, 'f'},
                                           {"vec4", 4, 'f'},
                                           {"mat2", 4, 'f'},
                                           {"mat3", 9, 'f'},
                                           {"mat4", 16, 'f'}}};

const PlainType* find_type(std::string_view name) {
  for (const PlainType& type : types) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// One component as GLSL writes it, or nothing.
std::string component(char kind, std::string_view text) {
  if (text == "true" || text == "false") return kind == 'b' ? std::string(text) : "";
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* end = text.data() + text.size();
  if (kind == 'f') {
    float value = 0;
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end && std::isfinite(value) ? fmt::format("float({:.9g})", value) : "";
  }
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return "";
  if (kind == 'b') return value == 0 ? "false" : value == 1 ? "true" : "";
  if (kind == 'u') return value >= 0 && value <= 0xffffffffLL ? fmt::format("{}u", value) : "";
  return value > -0x80000000LL && value <= 0x7fffffffLL ? fmt::format("{}", value) : "";
}

[[noreturn]] void refuse(const PlainType& type, std::string_view name, std::string_view value) {
  const char* one = type.kind == 'b'   ? "true or false"
                    : type.kind == 'f' ? "a number"
                    : type.kind == 'i' ? "a whole number"
                                       : "a whole number from 0";
  const char* many = type.kind == 'b' ? "values true or false" : type.kind == 'f' ? "numbers" : "whole numbers";
  const std::string wants =
      type.components == 1 ? one : fmt::format("{} {} with commas between", type.components, many);
  throw InvalidInput(fmt::format("the uniform {} {} takes {}, not '{}'", type.name, name, wants, value.substr(0, 60)));
}

}  // namespace

bool is_plain_type(std::string_view type) {
  return find_type(type) != nullptr;
}

std::string glsl_value(std::string_view type_name, std::string_view name, std::string_view value) {
  const PlainType* type = find_type(type_name);
  if (type == nullptr) throw InvalidInput(fmt::format("a uniform of the type {} cannot be set", type_name));
  std::vector<std::string> parts;
  for (std::string_view rest = value; parts.size() <= type->components;) {
    const std::size_t comma = rest.find(',');
    parts.push_back(component(type->kind, trimmed(rest.substr(0, comma))));
    if (parts.back().empty()) refuse(*type, name, value);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  const bool matrix = type_name.starts_with("mat");
  if (parts.size() != type->components && (parts.size() != 1 || matrix)) refuse(*type, name, value);
  return fmt::format("{}({})", type_name, fmt::join(parts, ", "));
}

std::string host_value(std::string_view type, std::string_view name) {
  constexpr std::array<std::string_view, 19> zero{
      "iTime", "iTimeDelta", "iFrame",  "iFrameRate",  "iMouse", "iDate", "time",   "iGlobalTime", "u_time", "u_mouse",
      "mouse", "frame",      "u_frame", "iSampleRate", "u_date", "date",  "iDelta", "uTime",       "uMouse"};
  if (name == "iResolution" || name == "resolution" || name == "u_resolution" || name == "uResolution") {
    if (type == "vec3") return "vec3(1024.0, 1024.0, 1.0)";
    return fmt::format("{}(1024)", type);
  }
  for (const std::string_view known : zero) {
    if (name == known) return fmt::format("{}(0)", type);
  }
  return "";
}

std::optional<std::string_view> host_type(std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 9> all{{{"iTime", "float"},
                                                                {"iTimeDelta", "float"},
                                                                {"iGlobalTime", "float"},
                                                                {"iFrameRate", "float"},
                                                                {"iSampleRate", "float"},
                                                                {"iFrame", "int"},
                                                                {"iMouse", "vec4"},
                                                                {"iDate", "vec4"},
                                                                {"iResolution", "vec3"}}};
  for (const auto& [known, type] : all) {
    if (name == known) return type;
  }
  return {};
}

}  // namespace evenmesh::gl
