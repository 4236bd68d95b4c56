#include "gl/glsl_needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "evenmesh/error.h"

namespace evenmesh::gl {
namespace {

const std::vector<std::string> point{"vec3"};

bool has_a_value(const GlslFunction& f) {
  return f.result == "float" || f.result == "vec2" || f.result == "vec3" || f.result == "vec4";
}

/// "; did you mean --entry DE?" or the functions that could be meant.
std::string other_entries(const GlslOutline& outline) {
  static const std::set<std::string> usual{"map",      "sdf",     "SDF",  "sdScene",  "scene",
                                           "sceneSDF", "de",      "DE",   "distance", "f",
                                           "GetDist",  "getDist", "dist", "field",    "implicit"};
  std::vector<std::string> good, all;
  for (const GlslFunction& f : outline.functions) {
    if (f.arguments != point || !has_a_value(f)) continue;
    std::vector<std::string>& names = usual.contains(f.name) ? good : all;
    if (std::count(names.begin(), names.end(), f.name) == 0) names.push_back(f.name);
  }
  if (!good.empty()) return fmt::format("; did you mean --entry {}?", fmt::join(good, " or "));
  if (all.empty()) return ", and no other function of one vec3 either";
  const bool more = all.size() > 8;
  all.resize(std::min<std::size_t>(all.size(), 8));
  return fmt::format("; its functions of one vec3 are {}{} (--entry)", fmt::join(all, ", "), more ? " ..." : "");
}

/// A prototype needs nothing itself, and neither does what is given from outside.
bool needs_something(const GlslGlobal& global, const std::vector<GlslToken>& tokens) {
  const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(global.tokens.begin);
  const auto end = tokens.begin() + static_cast<std::ptrdiff_t>(global.tokens.end);
  const auto holds = [&](std::string_view what) {
    return std::any_of(begin, end, [&](const GlslToken& token) { return token.is(what); });
  };
  const bool outside = holds("uniform") || holds("varying") || holds("attribute") || holds("in") || holds("out");
  return holds("=") || (!outside && !holds(")"));
}

class Search {
 public:
  Search(const GlslOutline& outline, const std::vector<GlslToken>& tokens) : outline_(outline), tokens_(tokens) {
    for (const GlslFunction& f : outline.functions) functions_.emplace(f.name, &f);
  }

  std::set<std::string> run(const std::string& entry) {
    need(entry);
    for (const GlslGlobal& global : outline_.globals) {
      if (needs_something(global, tokens_)) need_all(global.tokens);
    }
    while (!open_.empty()) {
      const std::string name = open_.back();
      open_.pop_back();
      const auto [first, last] = functions_.equal_range(name);
      for (auto f = first; f != last; ++f) need_all(f->second->tokens);
      const auto macro = outline_.macros.find(name);
      if (macro == outline_.macros.end()) continue;
      for (const std::string& word : macro->second.words) need(word);
    }
    return std::move(needed_);
  }

 private:
  void need(const std::string& name) {
    if (needed_.insert(name).second) open_.push_back(name);
  }

  void need_all(TokenRange range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (tokens_[i].is_word()) need(tokens_[i].text);
    }
  }

  const GlslOutline& outline_;
  const std::vector<GlslToken>& tokens_;
  std::multimap<std::string, const GlslFunction*> functions_{};
  std::set<std::string> needed_{};
  std::vector<std::string> open_{};
};

}  // namespace

void check_entry(const GlslText& text, const GlslOutline& outline, const std::string& entry) {
  if (outline.macros.contains(entry)) return;
  const GlslFunction* found = nullptr;
  for (const GlslFunction& f : outline.functions) {
    if (f.name != entry) continue;
    if (found == nullptr || f.arguments == point) found = &f;
  }
  if (found == nullptr)
    throw InvalidInput(
        fmt::format("{}: there is no function {}(vec3){}", text.name, entry.substr(0, 60), other_entries(outline)));
  if (found->arguments != point)
    throw InvalidInput(glsl_message(
        text, found->offset,
        fmt::format(
            "{}({}) is no entry, which takes one vec3; add a function that calls it, and name that with --entry", entry,
            fmt::join(found->arguments, ", "))));
  if (!has_a_value(*found))
    throw InvalidInput(
        glsl_message(text, found->offset,
                     fmt::format("{}(vec3) gives {}; an entry gives float, vec2, vec3 or vec4", entry, found->result)));
}

std::set<std::string> needed_names(const GlslOutline& outline, const std::vector<GlslToken>& tokens,
                                   const std::string& entry) {
  return Search{outline, tokens}.run(entry);
}

}  // namespace evenmesh::gl
