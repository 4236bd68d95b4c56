#pragma once
/// Loops that end.

#include <vector>

#include "gl/glsl_tokens.h"

namespace evenmesh::gl {

/// Rewrites the condition of each loop, c, to em_tick(c, line), in place; loops in the bodies of macros, too.
/// @throws UnusableInput  a loop whose head is not all in one place
void limit_loops(const GlslText& text, std::vector<GlslToken>& tokens);

}  // namespace evenmesh::gl
