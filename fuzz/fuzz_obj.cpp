/// Fuzzes the OBJ reader; seeds are in tests/corpus/obj.

#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return evenmesh::fuzz_mesh(data, size, "fuzz.obj");
}
