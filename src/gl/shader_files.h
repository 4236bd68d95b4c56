#pragma once
/// The files of src/gl/shaders, embedded at build time (cmake/shaders.cmake).

#include <string_view>
#include <vector>

namespace evenmesh::gl {

struct ShaderFile {
  std::string_view name;  ///< e.g. "field.glsl"
  std::string_view text;
};

/// All of them, in the order of their names.
const std::vector<ShaderFile>& shader_files();

}  // namespace evenmesh::gl
