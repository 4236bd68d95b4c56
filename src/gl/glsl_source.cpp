#include "gl/glsl_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "evenmesh/error.h"
#include "gl/glsl_loops.h"
#include "gl/glsl_needs.h"
#include "gl/glsl_outline.h"
#include "gl/glsl_uniforms.h"

namespace evenmesh::gl {
namespace {

bool draws_a_picture(const std::string& function) {
  static const std::set<std::string> names{"main", "mainImage", "mainVR", "mainSound", "mainCubemap"};
  return names.contains(function);
}

/// What a word stands for where there is no picture, or where desktop GLSL reserves what WebGL allows.
std::string_view replacement(std::string_view word) {
  static const std::map<std::string_view, std::string_view> words{{"gl_FragCoord", "em_FragCoord"},
                                                                  {"gl_FragColor", "em_FragColor"},
                                                                  {"gl_FragData", "em_FragData"},
                                                                  {"gl_FragDepth", "em_FragDepth"},
                                                                  {"dFdx", "em_derivative"},
                                                                  {"dFdy", "em_derivative"},
                                                                  {"fwidth", "em_derivative"},
                                                                  {"sample", "em_sample"},
                                                                  {"shared", "em_shared"},
                                                                  {"buffer", "em_buffer"},
                                                                  {"patch", "em_patch"},
                                                                  {"subroutine", "em_subroutine"},
                                                                  {"active", "em_active"},
                                                                  {"filter", "em_filter"}};
  const auto found = words.find(word);
  return found == words.end() ? word : found->second;
}

void blank(std::vector<GlslToken>& tokens, TokenRange range) {
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (!tokens[i].is_directive()) tokens[i].text.clear();
  }
}

/// The same in the body of a macro.
void replace_in_macro(const GlslText& text, GlslToken& directive) {
  const DefineParts parts = split_define(directive.text);
  if (parts.name.empty()) return;
  std::vector<GlslToken> body = tokenize_macro(text, parts.body, directive.offset);
  const auto is_odd = [](const GlslToken& t) { return t.is_word() && replacement(t.text) != t.text; };
  if (std::none_of(body.begin(), body.end(), is_odd)) return;
  directive.text = "define " + parts.name + parts.arguments;
  for (const GlslToken& token : body) directive.text.append(" ").append(replacement(token.text));
}

/// Directives that would be in the way: versions and extensions are ours to choose, lines are counted by us.
void clean_directives(std::vector<GlslToken>& tokens, const std::map<std::string, std::string>& macros) {
  for (GlslToken& token : tokens) {
    if (!token.is_directive()) continue;
    const std::string name = directive_name(token.text);
    const DefineParts define = split_define(token.text);
    const bool given = !define.name.empty() && define.arguments.empty() && macros.contains(define.name);
    if (name == "version" || name == "extension" || name == "line" || name == "pragma" || given) token.text = "";
  }
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

void emit(GlslSource& source, const std::vector<GlslToken>& tokens, const GlslOutline& outline) {
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

/// Finds "LINE(COLUMN): error: what", "LINE) : error C1: what", "ERROR: 0:LINE: what" in one line of a log.
bool read_complaint(std::string_view line, std::size_t& number, std::string& what) {
  const std::size_t error = std::min(line.find("error"), line.find("ERROR"));
  if (error == std::string_view::npos) return false;
  std::size_t at = line.starts_with("ERROR: ") ? 7 : 0;
  const auto digits = [&](std::size_t from) {
    return std::min(line.find_first_not_of("0123456789", from), line.size()) - from;
  };
  at += digits(at);
  if (at >= line.size() || (line[at] != ':' && line[at] != '(') || digits(at + 1) == 0 || digits(at + 1) > 9)
    return false;
  number = 0;
  std::size_t end = at + 1;
  for (; end < line.size() && line[end] >= '0' && line[end] <= '9'; ++end) number = 10 * number + (line[end] - '0');
  // The message: behind "error:" or "error C1234:", else behind the number.
  const std::size_t colon = line.find(": ", std::max(end, error));
  what = line.substr(colon != std::string_view::npos && error > end ? colon + 2 : std::min(end + 2, line.size()));
  return true;
}

}  // namespace

std::string GlslSource::explain(std::string_view log) const {
  const std::string_view whole = log;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    std::size_t line = 0;
    std::string what;
    const bool ours = read_complaint(log.substr(0, end), line, what) && line >= 1 && line <= offsets.size();
    if (ours) return glsl_message(text, offsets[line - 1], what);
    log.remove_prefix(std::min(end + 1, log.size()));
  }
  return fmt::format("{}: the driver does not compile this: {}", text.name, whole.substr(0, 500));
}

GlslSource prepare_glsl(GlslText text, const std::string& entry,
                        const std::map<std::string, std::string>& definitions) {
  GlslSource source{std::move(text), std::string(replacement(entry)), {}, {}};
  std::vector<GlslToken> tokens = tokenize_glsl(source.text);
  const GlslOutline outline = outline_glsl(source.text, tokens);
  check_entry(source.text, outline, entry);
  const std::set<std::string> needed = needed_names(outline, tokens, entry);
  for (const GlslFunction& function : outline.functions) {
    const bool needless = !outline.tangled && !needed.contains(function.name);
    if (draws_a_picture(function.name) || needless) blank(tokens, function.tokens);
  }
  const Definitions given = set_uniforms(source.text, tokens, outline, needed, definitions);
  for (GlslToken& token : tokens) {
    if (token.is_word()) token.text = replacement(token.text);
    if (token.is_directive()) replace_in_macro(source.text, token);
  }
  clean_directives(tokens, given.macros);
  limit_loops(source.text, tokens);
  for (const auto& [name, value] : given.macros) {
    source.code += fmt::format("#define {} {}\n", name, value);
    source.offsets.push_back(0);
  }
  for (const std::string& line : given.constants) {
    source.code += line + "\n";
    source.offsets.push_back(0);
  }
  emit(source, tokens, outline);
  return source;
}

}  // namespace evenmesh::gl
