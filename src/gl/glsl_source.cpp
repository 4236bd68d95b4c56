#include "gl/glsl_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "evenmesh/error.h"
#include "gl/glsl_emit.h"
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
  replace_words(source.text, tokens, replacement);
  clean_directives(tokens, given.macros);
  limit_loops(source.text, tokens);
  emit_glsl(source, tokens, outline, given);
  return source;
}

}  // namespace evenmesh::gl
