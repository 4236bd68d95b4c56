#pragma once
/// What of a shader its entry needs.

#include <set>
#include <string>

#include "gl/glsl_outline.h"

namespace evenmesh::gl {

/// @throws InvalidInput  there is no function or macro `entry` of one vec3 with a float, vec2, vec3 or vec4; names
///                       those that would do
void check_entry(const GlslText& text, const GlslOutline& outline, const std::string& entry);

/// All words that the entry, what it calls, and the constants outside of functions use; too many rather than too few.
std::set<std::string> needed_names(const GlslOutline& outline, const std::vector<GlslToken>& tokens,
                                   const std::string& entry);

}  // namespace evenmesh::gl
