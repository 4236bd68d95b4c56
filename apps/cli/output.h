#pragma once
/// Outputs of the commands: checked before the work starts, written all or nothing.

#include <optional>
#include <string>
#include <string_view>

#include "evenmesh/io.h"
#include "evenmesh/mesh.h"

namespace evenmesh::cli {

/// Where a mesh goes.
struct MeshOutput {
  std::string path;  ///< "-" is standard output
  MeshFormat format = MeshFormat::ply;
};

/// @param format  text of --format, "" when not given
/// @throws InvalidInput  no -o, an unknown extension, a folder that is missing or must not be written to
MeshOutput check_mesh_output(const std::string& path, const std::string& format);

/// @throws InvalidInput  the folder of a text or picture is missing, or `path` is a folder itself
void check_output(const std::string& option, const std::string& path);

/// @throws WriteFailed
void write_output(const MeshOutput& output, const Mesh& mesh);
/// Writes `bytes` to a file, or to standard output for "-". @throws WriteFailed
void write_output(const std::string& path, std::string_view bytes);

}  // namespace evenmesh::cli
