/// Fuzzes the readers of scenes, JSON and OpenSCAD's .csg; seeds are in tests/corpus/scene.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "evenmesh/error.h"
#include "evenmesh/scene.h"
#include "evenmesh/solid.h"

namespace {

void check(const evenmesh::Shape& shape) {
  if (const evenmesh::Compound* compound = shape.compound()) {
    if (compound->operands.empty()) std::abort();
    for (const evenmesh::Shape& operand : compound->operands) check(operand);
  }
  if (const evenmesh::Mesh* mesh = shape.mesh()) {
    if (mesh->triangles.empty()) std::abort();
    for (const evenmesh::Vec3& v : mesh->vertices) {
      if (!is_finite(v)) std::abort();
    }
    for (const evenmesh::Triangle& t : mesh->triangles) {
      for (const std::uint32_t v : t) {
        if (v >= mesh->vertices.size()) std::abort();
      }
    }
  }
}

/// Any bytes give a valid shape or a sentence. No folder: files are not what is fuzzed here.
void check(std::string_view bytes, std::string_view name) {
  try {
    check(evenmesh::parse_scene(bytes, name, "/nowhere", evenmesh::ExecutionContext::silent(), {.triangles = 100'000}));
  } catch (const evenmesh::UnusableInput&) {
  } catch (const evenmesh::NotAvailable&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check(bytes, "fuzz.json");
  check(bytes, "fuzz.csg");
  return 0;
}
