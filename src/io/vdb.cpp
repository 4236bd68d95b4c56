/// OpenVDB volumes, out: loads the plugin that writes them.

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <system_error>

#include "core/platform.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "io/vdb/plugin.h"

namespace evenmesh {
namespace {

namespace fs = std::filesystem;

/// Beside the program, where it was installed to, and where the program was moved to with all of it.
void* open_plugin() {
  std::error_code unknown;
  const fs::path program = program_folder();
  const std::array<fs::path, 3> folders{program, program.parent_path() / "lib" / "evenmesh", EVENMESH_PLUGINS};
  std::string reason;
  for (const fs::path& folder : folders) {
    const fs::path file = folder / vdb::plugin_name;
    if (!fs::exists(file, unknown)) continue;
    if (void* handle = load_library(file, reason)) return handle;
  }
  if (!reason.empty())
    throw NotAvailable("OpenVDB files need OpenVDB, which does not load (" + reason +
                       "); install it (Debian: apt install libopenvdb-dev)");
  throw NotAvailable(
      fmt::format("OpenVDB files need {} beside the program, which is built where OpenVDB is there; install "
                  "it (Debian: apt install libopenvdb-dev libboost-dev) and build evenmesh again",
                  vdb::plugin_name));
}

void* plugin() {
  static void* const handle = open_plugin();
  return handle;
}

}  // namespace

void require_vdb() {
  plugin();
}

std::string serialize_vdb(const SparseVolume& volume) {
  if (!(volume.side > 0)) throw InvalidInput("the voxels of a volume need a side above 0");
  if (volume.values.size() != volume.voxels.size()) throw InvalidInput("a volume needs one value for each voxel");
  const auto serialize = reinterpret_cast<vdb::Serialize*>(find_symbol(plugin(), vdb::serialize_name));
  std::string bytes;
  if (serialize == nullptr || !serialize(volume, bytes))
    throw UnusableInput("the volume cannot be written: " + (bytes.empty() ? "another version's plugin" : bytes));
  return bytes;
}

}  // namespace evenmesh
