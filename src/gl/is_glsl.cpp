#include <algorithm>
#include <array>
#include <string>

#include "evenmesh/glsl.h"

namespace evenmesh {

bool is_glsl(std::string_view name, std::string_view first_bytes) {
  std::string small{name};
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  constexpr std::array<std::string_view, 4> endings{".glsl", ".frag", ".fs", ".fsh"};
  if (std::any_of(endings.begin(), endings.end(), [&](std::string_view e) { return small.ends_with(e); })) return true;
  const auto holds = [&](std::string_view word) { return first_bytes.find(word) != std::string_view::npos; };
  if (first_bytes.find('\0') != std::string_view::npos) return false;
  return first_bytes.starts_with("#version") || (holds("vec3 ") && (holds("mainImage") || holds("float map(")));
}

}  // namespace evenmesh
