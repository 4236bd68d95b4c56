#include "gl/glsl_loops.h"

#include <fmt/format.h>

#include "gl/glsl_outline.h"

namespace evenmesh::gl {
namespace {

class Rewriter {
 public:
  Rewriter(const GlslText& text, std::vector<GlslToken>& tokens) : text_(text), t_(tokens) {}

  void run() {
    std::size_t line = 1, offset = 0;
    for (std::size_t i = 0; i < t_.size(); ++i) {
      if (!t_[i].is("for") && !t_[i].is("while")) continue;
      for (; offset < t_[i].offset; ++offset) line += ends_line(text_, offset);
      line_ = line;
      if (t_[i].is("for")) {
        for_loop(i);
      } else {
        wrap(i + 2, head_end(i), i);
      }
    }
  }

 private:
  /// The ')' that closes the head of the loop at `i`; notes its semicolons.
  std::size_t head_end(std::size_t i) {
    constexpr std::string_view advice = "the head of this loop is partly in a macro; write it out";
    semicolons_.clear();
    if (i + 1 >= t_.size() || !t_[i + 1].is("(")) fail_in_glsl(text_, t_[i].offset, advice);
    std::size_t depth = 0;
    for (std::size_t k = i + 1; k < t_.size(); ++k) {
      if (t_[k].is("(")) ++depth;
      if (t_[k].is(")") && --depth == 0) return k;
      if (t_[k].is(";") && depth == 1) semicolons_.push_back(k);
      if (t_[k].is("{") || t_[k].is("}")) break;
    }
    fail_in_glsl(text_, t_[i].offset, advice);
  }

  void for_loop(std::size_t i) {
    head_end(i);
    if (semicolons_.size() != 2)
      fail_in_glsl(text_, t_[i].offset, "the head of this loop needs two semicolons, and not in a macro or after #if");
    if (has_tokens(semicolons_[0] + 1, semicolons_[1])) return wrap(semicolons_[0] + 1, semicolons_[1], i);
    t_[semicolons_[1]].before = fmt::format("em_tick(true, {}u)", line_);
  }

  bool has_tokens(std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i) {
      if (!t_[i].is_directive()) return true;
    }
    return false;
  }

  void wrap(std::size_t begin, std::size_t end, std::size_t loop) {
    while (begin < end && t_[begin].is_directive()) ++begin;
    while (begin < end && t_[end - 1].is_directive()) --end;
    if (begin >= end) fail_in_glsl(text_, t_[loop].offset, "this loop has no condition");
    // while (bool go = f()): the value is what counts
    for (std::size_t i = begin; i + 2 < end && t_[i].is_word() && t_[i + 1].is_word(); ++i) {
      if (t_[i + 2].is("=") && i + 3 < end) {
        begin = i + 3;
        break;
      }
    }
    t_[begin].before = "em_tick((";
    t_[end - 1].after = fmt::format("), {}u)", line_);
  }

  const GlslText& text_;
  std::vector<GlslToken>& t_;
  std::vector<std::size_t> semicolons_{};
  std::size_t line_ = 1;
};

bool has_loop(const std::vector<GlslToken>& tokens) {
  for (const GlslToken& token : tokens) {
    if (token.is("for") || token.is("while")) return true;
  }
  return false;
}

}  // namespace

void limit_loops(const GlslText& text, std::vector<GlslToken>& tokens) {
  for (GlslToken& token : tokens) {
    if (!token.is_directive()) continue;
    const DefineParts parts = split_define(token.text);
    if (parts.name.empty()) continue;
    std::vector<GlslToken> body = tokenize_macro(text, parts.body, token.offset);
    if (!has_loop(body)) continue;
    Rewriter{text, body}.run();
    token.text = "define " + parts.name + parts.arguments;
    for (const GlslToken& part : body) token.text += " " + part.before + " " + part.text + part.after;
  }
  Rewriter{text, tokens}.run();
}

}  // namespace evenmesh::gl
