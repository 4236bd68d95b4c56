#include "gl/glsl_outline.h"

#include <algorithm>
#include <cctype>

namespace evenmesh::gl {
namespace {

/// Compilers are recursive. They were seen to survive 50 times this on the stack they run on.
constexpr std::size_t deepest = 200;
/// Operators of one statement nest, too: a + b + c is (a + b) + c.
constexpr std::size_t longest_statement = 40'000;

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_qualifier(const std::string& word) {
  static const std::set<std::string> all{"const", "in",      "highp",     "mediump", "lowp",
                                         "flat",  "precise", "invariant", "smooth",  "centroid"};
  return all.contains(word);
}

class Outliner {
 public:
  Outliner(const GlslText& text, const std::vector<GlslToken>& tokens) : text_(text), t_(tokens) {}

  GlslOutline run() {
    for (i_ = 0; i_ < t_.size(); ++i_) {
      if (t_[i_].is_directive()) {
        directive(t_[i_]);
      } else {
        token(t_[i_]);
      }
    }
    if (inside_) end_function(t_.size());
    return std::move(outline_);
  }

 private:
  void directive(const GlslToken& token) {
    const std::string name = directive_name(token.text);
    if (name == "include") fail_in_glsl(text_, token.offset, "nothing can be included; paste the text here instead");
    if (name == "define") define(token);
    if (name == "if" || name == "ifdef" || name == "ifndef") depths_.push_back(depth_);
    if ((name == "else" || name == "elif") && !depths_.empty()) {
      if (inside_ && depths_.back() == 0) {
        outline_.tangled = true;
        end_function(i_);
      }
      depth_ = depths_.back();
    }
    if (name == "endif" && !depths_.empty()) depths_.pop_back();
    if (name.starts_with("if") || name == "elif" || name == "undef") {
      for (const GlslToken& word : tokenize_macro(text_, token.text, token.offset)) {
        if (word.is_word()) outline_.conditions.insert(word.text);
      }
      for (const char* own : {"if", "ifdef", "ifndef", "elif", "undef", "defined"}) outline_.conditions.erase(own);
    }
  }

  void define(const GlslToken& token) {
    const DefineParts parts = split_define(token.text);
    if (parts.name.empty()) return;
    GlslMacro& macro = outline_.macros[parts.name];
    macro.name = parts.name;
    macro.has_arguments = macro.has_arguments || !parts.arguments.empty();
    for (const GlslToken& word : tokenize_macro(text_, parts.body, token.offset)) {
      if (word.is_word()) macro.words.insert(word.text);
    }
  }

  void token(const GlslToken& token) {
    if (depth_ == 0 && begin_ == none) begin_ = i_;
    statement_ = token.is(";") || token.is("{") || token.is("}") ? 0 : statement_ + 1;
    if (statement_ > longest_statement) fail_in_glsl(text_, token.offset, "this statement is too long; split it");
    if (token.is("(") || token.is("[")) ++brackets_;
    if ((token.is(")") || token.is("]")) && brackets_ > 0) --brackets_;
    if (token.is("{")) {
      brackets_ = 0;
      if (depth_++ == 0) inside_ = begin_function();
    }
    if (depth_ + brackets_ > deepest) fail_in_glsl(text_, token.offset, "brackets nest too deep here; simplify this");
    if (token.is("}") && depth_ > 0 && --depth_ == 0 && inside_) end_function(i_ + 1);
    if (token.is(";") && depth_ == 0) {
      if (begin_ != i_) outline_.globals.push_back({{begin_, i_ + 1}});
      begin_ = none;
    }
  }

  /// Whether '{' at i_ follows "type name(arguments)".
  bool begin_function() {
    std::size_t close = i_;
    while (close > begin_ && t_[close - 1].is_directive()) --close;
    if (close <= begin_ || !t_[close - 1].is(")")) return false;
    --close;
    std::size_t open = close, nested = 0;
    for (;; --open) {
      if (t_[open].is(")")) ++nested;
      if (t_[open].is("(") && --nested == 0) break;
      if (open == begin_) return false;
    }
    if (open < begin_ + 2 || !t_[open - 1].is_word()) return false;
    function_ = {t_[open - 1].text, t_[open - 2].text, arguments({open + 1, close}), t_[open - 1].offset, {begin_, 0}};
    return true;
  }

  std::vector<std::string> arguments(TokenRange range) const {
    std::vector<std::string> types;
    std::string type;
    for (std::size_t i = range.begin; i <= range.end; ++i) {
      if (i == range.end || t_[i].is(",")) {
        if (!type.empty() && type != "void") types.push_back(type);
        type.clear();
      } else if (t_[i].is("out") || t_[i].is("inout")) {
        type = t_[i].text + " ";
      } else if (t_[i].is_word() && !is_qualifier(t_[i].text) && (type.empty() || type.back() == ' ')) {
        type += t_[i].text;
      } else if (t_[i].is("[")) {
        type += "[]";
      }
    }
    return types;
  }

  void end_function(std::size_t end) {
    function_.tokens.end = end;
    outline_.functions.push_back(function_);
    inside_ = false;
    begin_ = none;
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  const GlslText& text_;
  const std::vector<GlslToken>& t_;
  GlslOutline outline_{};
  std::size_t i_ = 0, begin_ = none;  ///< current token; first one of the declaration it belongs to
  std::size_t depth_ = 0, brackets_ = 0, statement_ = 0;
  std::vector<std::size_t> depths_{};  ///< of the conditionals that are open
  bool inside_ = false;                ///< a function's body
  GlslFunction function_{};
};

}  // namespace

GlslOutline outline_glsl(const GlslText& text, const std::vector<GlslToken>& tokens) {
  return Outliner(text, tokens).run();
}

std::string directive_name(std::string_view directive) {
  const auto end = std::find_if_not(directive.begin(), directive.end(), is_word_character);
  return {directive.begin(), end};
}

DefineParts split_define(std::string_view directive) {
  if (directive_name(directive) != "define") return {};
  directive.remove_prefix(6);
  directive.remove_prefix(std::min(directive.find_first_not_of(' '), directive.size()));
  DefineParts parts{directive_name(directive)};
  directive.remove_prefix(parts.name.size());
  if (directive.starts_with("(")) {
    const std::size_t end = directive.find(')');
    if (end == std::string_view::npos) return {};
    parts.arguments = directive.substr(0, end + 1);
    directive.remove_prefix(end + 1);
  }
  parts.body = directive;
  return parts;
}

}  // namespace evenmesh::gl
