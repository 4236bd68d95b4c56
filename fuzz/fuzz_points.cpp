/// Fuzzes the readers of points; seeds are in tests/corpus/points.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace {

/// Any bytes give finite points and as many normals, or none, or a sentence.
void check(std::string_view bytes, std::string_view name) {
  try {
    const evenmesh::PointCloud cloud = evenmesh::parse_points(bytes, name);
    if (cloud.points.empty()) std::abort();
    if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size()) std::abort();
    for (const evenmesh::Vec3& p : cloud.points) {
      if (!is_finite(p)) std::abort();
    }
    for (const evenmesh::Vec3& n : cloud.normals) {
      if (!is_finite(n)) std::abort();
    }
  } catch (const evenmesh::UnusableInput&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check(bytes, "fuzz.xyz");
  check(bytes, "fuzz.pwn");  // six columns mean something else there
  return 0;
}
