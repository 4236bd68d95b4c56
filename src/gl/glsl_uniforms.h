#pragma once
/// What comes from outside of a shader.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "gl/glsl_outline.h"

namespace evenmesh::gl {

/// Definitions that are not uniforms of the shader itself.
struct Definitions {
  std::map<std::string, std::string> macros{};
  std::vector<std::string> constants{};  ///< declarations of what hosts of shaders declare: "const float iTime = …;"
};

/// Turns uniforms into constants, in place: with the value of `definitions`, else with the file's, else (those of
/// known hosts of shaders) 0. Takes out what comes from vertices or goes into pictures.
/// @param needed  see needed_names(); what is not in it needs no value
/// @throws UnusableInput  textures and blocks that are needed; see prepare_glsl()
/// @throws InvalidInput   a definition that fits nothing, a uniform without a value
Definitions set_uniforms(const GlslText& text, std::vector<GlslToken>& tokens, const GlslOutline& outline,
                         const std::set<std::string>& needed, const std::map<std::string, std::string>& definitions);

}  // namespace evenmesh::gl
