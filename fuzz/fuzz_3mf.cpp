/// Fuzzes the 3MF reader; seeds are in tests/corpus/3mf.

#include "fuzz_mesh.h"
#include "io/zip.h"

/// Zip checksums keep mutations away from what lies behind them, so bytes that are no archive are put into one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.starts_with("PK")) return evenmesh::fuzz_mesh(data, size, "fuzz.3mf");
  const std::string archive = evenmesh::zip_bytes({{"3D/3dmodel.model", bytes}});
  return evenmesh::fuzz_mesh(reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size(), "fuzz.3mf");
}
