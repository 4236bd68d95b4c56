#include "gl/glsl_emit.h"

#include <fmt/format.h>

#include <algorithm>

namespace evenmesh::gl {
namespace {

/// In the body of a macro.
void replace_in_macro(const GlslText& text, GlslToken& directive, Replacement replacement) {
  const DefineParts parts = split_define(directive.text);
  if (parts.name.empty()) return;
  std::vector<GlslToken> body = tokenize_macro(text, parts.body, directive.offset);
  const auto is_odd = [&](const GlslToken& t) { return t.is_word() && replacement(t.text) != t.text; };
  if (std::none_of(body.begin(), body.end(), is_odd)) return;
  directive.text = "define " + parts.name + parts.arguments;
  for (const GlslToken& token : body) directive.text.append(" ").append(replacement(token.text));
}

/// Index behind the call of a macro whose name is at `i`; i + 1 where it is none.
std::size_t call_end(const std::vector<GlslToken>& tokens, std::size_t i, const GlslOutline& outline) {
  const auto macro = outline.macros.find(tokens[i].text);
  if (macro == outline.macros.end() || !macro->second.has_arguments) return i + 1;
  std::size_t depth = 0;
  for (std::size_t k = i + 1; k < tokens.size() && !tokens[k].is_directive(); ++k) {
    if (tokens[k].is("(")) ++depth;
    if (depth == 0) return i + 1;
    if (tokens[k].is(")") && --depth == 0) return k + 1;
  }
  return i + 1;
}

}  // namespace

void replace_words(const GlslText& text, std::vector<GlslToken>& tokens, Replacement replacement) {
  for (GlslToken& token : tokens) {
    if (token.is_word()) token.text = replacement(token.text);
    if (token.is_directive()) replace_in_macro(text, token, replacement);
  }
}

void clean_directives(std::vector<GlslToken>& tokens, const std::map<std::string, std::string>& macros) {
  for (GlslToken& token : tokens) {
    if (!token.is_directive()) continue;
    const std::string name = directive_name(token.text);
    const DefineParts define = split_define(token.text);
    const bool given = !define.name.empty() && define.arguments.empty() && macros.contains(define.name);
    if (name == "version" || name == "extension" || name == "line" || name == "pragma" || given) token.text = "";
  }
}

void emit_glsl(GlslSource& source, const std::vector<GlslToken>& tokens, const GlslOutline& outline,
               const Definitions& given) {
  for (const auto& [name, value] : given.macros) {
    source.code += fmt::format("#define {} {}\n", name, value);
    source.offsets.push_back(0);
  }
  for (const std::string& line : given.constants) {
    source.code += line + "\n";
    source.offsets.push_back(0);
  }
  for (std::size_t i = 0; i < tokens.size();) {
    const GlslToken& token = tokens[i];
    if (token.is_directive()) {
      if (!token.text.empty()) {
        source.code += "#" + token.text + "\n";
        source.offsets.push_back(token.offset);
      }
      ++i;
      continue;
    }
    // The arguments of a macro must not be apart: preprocessors differ in what they make of lines there.
    std::string line;
    for (const std::size_t end = call_end(tokens, i, outline); i < end; ++i) {
      if (tokens[i].text.empty()) continue;
      (line += line.empty() ? "" : " ") += tokens[i].before + tokens[i].text + tokens[i].after;
    }
    if (line.empty()) continue;
    source.code += line + "\n";
    source.offsets.push_back(token.offset);
  }
}

}  // namespace evenmesh::gl
