#pragma once
/// A user's vertex and fragment shader, turned into a pair that hands over its fragments.

#include <map>
#include <string>

#include "gl/glsl_source.h"
#include "gl/program.h"

namespace evenmesh::gl {

/// What of it the driver compiles.
struct RasterSource {
  GlslSource vertex{}, fragment{};
  std::string vertex_text{}, fragment_text{};  ///< complete

  /// "NAME:LINE:COLUMN: what", the line, and a caret, of the stage that does not compile.
  std::string explain(const ShaderError& error) const;
};

/// Prepares both: uniforms become constants with the values of `definitions`, except those that views set; main() is
/// called by ours (shaders/raster_*.glsl), loops count their rounds. See raster.h for what is understood.
///
/// @param vertex, fragment  empty texts: the built-in ones
/// @throws UnusableInput  as prepare_glsl(); another vertex attribute than position and normal
/// @throws InvalidInput   no main(); values missing, unknown or of the wrong type
/// Cost: O(size)
RasterSource prepare_raster(GlslText vertex, GlslText fragment, const std::map<std::string, std::string>& definitions);

}  // namespace evenmesh::gl
