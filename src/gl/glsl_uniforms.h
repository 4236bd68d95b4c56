#pragma once
/// What comes from outside of a shader.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "gl/glsl_outline.h"

namespace evenmesh::gl {

/// An input or output of a shader that draws.
struct StageVariable {
  std::string type;
  std::size_t offset = 0;  ///< within the text
};

/// A shader that draws: uniforms that it may have beside those with values, and their types.
using StageUniforms = std::map<std::string, std::string>;

/// Definitions that are not uniforms of the shader itself.
struct Definitions {
  std::map<std::string, std::string> macros{};
  std::vector<std::string> constants{};  ///< declarations of what hosts of shaders declare: "const float iTime = …;"
  std::map<std::string, StageVariable> inputs{}, outputs{};  ///< of a stage
};

/// Turns uniforms into constants, in place: with the value of `definitions`, else with the file's, else (those of
/// known hosts of shaders) 0. Takes out what comes from vertices or goes into pictures.
/// @param needed  see needed_names(); what is not in it needs no value
/// @param stage   of a shader that draws: inputs and outputs stay, and these uniforms; null: of a function
/// @throws UnusableInput  textures and blocks that are needed; see prepare_glsl()
/// @throws InvalidInput   a definition that fits nothing, a uniform without a value
Definitions set_uniforms(const GlslText& text, std::vector<GlslToken>& tokens, const GlslOutline& outline,
                         const std::set<std::string>& needed, const std::map<std::string, std::string>& definitions,
                         const StageUniforms* stage = nullptr);

}  // namespace evenmesh::gl
