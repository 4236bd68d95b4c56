#pragma once
/// A user's tokens, written for a compiler.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gl/glsl_outline.h"
#include "gl/glsl_source.h"
#include "gl/glsl_uniforms.h"

namespace evenmesh::gl {

/// What a word becomes; itself where it stays.
using Replacement = std::string_view (*)(std::string_view word);

/// Replaces words, in the bodies of macros, too.
void replace_words(const GlslText& text, std::vector<GlslToken>& tokens, Replacement replacement);

/// Directives that would be in the way go: versions and extensions are ours to choose, lines are counted by us, macros
/// that are given replace those of the file.
void clean_directives(std::vector<GlslToken>& tokens, const std::map<std::string, std::string>& macros);

/// Appends what was given, then the tokens, to the source's code, a line for each, and where each comes from.
void emit_glsl(GlslSource& source, const std::vector<GlslToken>& tokens, const GlslOutline& outline,
               const Definitions& given);

}  // namespace evenmesh::gl
