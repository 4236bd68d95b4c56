#pragma once
/// A user's shader, turned into code for our own.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gl/glsl_tokens.h"

namespace evenmesh::gl {

/// Rounds of all loops together that one evaluation may take; a little less than what llvmpipe takes before it leaves
/// loops without a word.
inline constexpr std::int32_t loop_budget = 65'000;

/// What came of it.
struct GlslSource {
  GlslText text;      ///< as it was given
  std::string entry;  ///< to be called as `entry(vec3)`
  /// One token, directive or call of a macro per line, so that every compiler's line numbers lead to tokens. It needs
  /// guard.glsl before it: loops ask em_tick().
  std::string code;
  std::vector<std::size_t> offsets;  ///< within the text, per line of `code`

  /// What a driver's log says, about the first mistake: "NAME:LINE:COLUMN: message", the line, a caret.
  std::string explain(std::string_view log) const;
};

/// Prepares a shader: what the entry does not need is left out, uniforms become constants with the values of
/// `definitions`, loops count their rounds. See shape_from_glsl() for what is understood.
///
/// @throws UnusableInput  with line, column and caret: bytes that are no shader, #include, textures that the entry
///                        needs, blocks and arrays of uniforms without values, half a loop in a macro
/// @throws InvalidInput   no such entry, or one of other arguments; values missing, unknown or of the wrong type
/// Guarantee: any text either gives a source, which compilers may still refuse, or throws.
/// Cost: O(size)
GlslSource prepare_glsl(GlslText text, const std::string& entry, const std::map<std::string, std::string>& definitions);

}  // namespace evenmesh::gl
