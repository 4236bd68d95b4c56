#pragma once
/// What the fuzzers of the mesh readers share: any bytes give a valid mesh or a sentence.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {

/// @param name  its extension decides where the content alone does not
inline int fuzz_mesh(const std::uint8_t* data, std::size_t size, std::string_view name) {
  try {
    const Mesh mesh = parse_mesh({reinterpret_cast<const char*>(data), size}, name);
    if (mesh.triangles.empty()) std::abort();
    for (const Vec3& v : mesh.vertices) {
      if (!is_finite(v)) std::abort();
    }
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t v : t) {
        if (v >= mesh.vertices.size()) std::abort();
      }
    }
  } catch (const UnusableInput&) {
  }
  return 0;
}

}  // namespace evenmesh
