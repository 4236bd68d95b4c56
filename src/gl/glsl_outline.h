#pragma once
/// What a shader's text declares: functions, uniforms, macros; found without compiling it.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "gl/glsl_tokens.h"

namespace evenmesh::gl {

/// Half-open range of tokens.
struct TokenRange {
  std::size_t begin = 0, end = 0;
};

struct GlslFunction {
  std::string name;
  std::string result;                  ///< its type
  std::vector<std::string> arguments;  ///< types; with "out " or "inout " in front where they are written to
  std::size_t offset = 0;              ///< of the name
  TokenRange tokens{};                 ///< all of it
};

/// One declaration outside of functions, up to its semicolon; not structs' members.
struct GlslGlobal {
  TokenRange tokens{};  ///< with the semicolon
};

struct GlslMacro {
  std::string name;
  bool has_arguments = false;
  std::set<std::string> words{};  ///< in its body
};

struct GlslOutline {
  std::vector<GlslFunction> functions{};
  std::vector<GlslGlobal> globals{};
  std::map<std::string, GlslMacro> macros{};
  std::set<std::string> conditions{};  ///< names that #if, #ifdef and the like ask for
  /// Conditional parts share the body of a function, so that its end is not known for certain.
  bool tangled = false;
};

/// @throws UnusableInput  #include; too deep nesting for the compilers of drivers
/// Cost: O(tokens)
GlslOutline outline_glsl(const GlslText& text, const std::vector<GlslToken>& tokens);

/// A directive `define NAME(arguments) body`: where its parts are within the text; empty name where it is none.
struct DefineParts {
  std::string name;
  std::string arguments{};  ///< with brackets; empty: none
  std::string body{};
};
DefineParts split_define(std::string_view directive);

/// First word of a directive: "define", "ifdef", …
std::string directive_name(std::string_view directive);

}  // namespace evenmesh::gl
