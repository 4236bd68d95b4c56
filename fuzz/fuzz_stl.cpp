/// Fuzzes the STL reader; seeds are in tests/corpus/stl.

#include "fuzz_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return evenmesh::fuzz_mesh(data, size, "fuzz.stl");
}
