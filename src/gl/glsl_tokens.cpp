#include "gl/glsl_tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "evenmesh/error.h"

namespace evenmesh::gl {
namespace {

constexpr std::size_t longest_text = 1'000'000;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}
bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}

class Scanner {
 public:
  /// @param code  within the text, or a macro's body, whose tokens all stand at `offset`
  Scanner(const GlslText& text, std::string_view code, const std::size_t* offset)
      : text_(text), code_(code), offset_(offset) {}

  std::vector<GlslToken> run() {
    if (code_.starts_with("\xef\xbb\xbf")) at_ = 3;  // byte order mark
    bool line_begins = true;
    while (skip(line_begins)) {
      if (code_[at_] == '#' && line_begins && offset_ == nullptr) {
        directive();
        line_begins = true;
        continue;
      }
      line_begins = false;
      token();
    }
    return std::move(tokens_);
  }

 private:
  std::size_t place() const { return offset_ != nullptr ? *offset_ : at_; }
  bool at(std::string_view what) const { return code_.substr(at_, what.size()) == what; }

  /// Bytes of "\\\n" at `at_`, or 0.
  std::size_t continuation() const {
    if (at("\\\r\n")) return 3;
    return at("\\\n") || at("\\\r") ? 2 : 0;
  }

  void skip_comment() {
    if (at("//")) {
      while (at_ < code_.size() && !is_line_end(code_[at_])) at_ += std::max<std::size_t>(continuation(), 1);
      return;
    }
    const std::size_t end = code_.find("*/", at_ + 2);
    if (end == std::string_view::npos) fail_in_glsl(text_, place(), "this comment is never closed");
    at_ = end + 2;
  }

  /// Over blanks and comments; false at the end.
  bool skip(bool& line_begins) {
    while (at_ < code_.size()) {
      if (const std::size_t bytes = continuation()) {
        at_ += bytes;
      } else if (is_space(code_[at_])) {
        line_begins = line_begins || is_line_end(code_[at_]);
        ++at_;
      } else if (at("//") || at("/*")) {
        skip_comment();
      } else {
        return true;
      }
    }
    return false;
  }

  void directive() {
    GlslToken token{TokenKind::directive, {}, at_};
    ++at_;
    while (at_ < code_.size() && !is_line_end(code_[at_])) {
      if (const std::size_t bytes = continuation()) {
        at_ += bytes;
        token.text += ' ';
      } else if (at("//") || at("/*")) {
        skip_comment();
        token.text += ' ';
      } else {
        token.text += code_[at_] == '\t' ? ' ' : code_[at_];
        ++at_;
      }
    }
    const std::size_t first = token.text.find_first_not_of(' ');
    token.text.erase(0, std::min(first, token.text.size()));
    token.text.erase(token.text.find_last_not_of(' ') + 1);
    tokens_.push_back(std::move(token));
  }

  void push(TokenKind kind, std::size_t bytes) {
    tokens_.push_back({kind, std::string(code_.substr(at_, bytes)), place()});
    at_ += bytes;
  }

  void token() {
    const char c = code_[at_];
    std::size_t end = at_ + 1;
    const auto next = [&] { return end < code_.size() ? code_[end] : '\0'; };
    if (is_letter(c)) {
      while (is_letter(next()) || is_digit(next())) ++end;
      return push(TokenKind::word, end - at_);
    }
    if (is_digit(c) || (c == '.' && is_digit(next()))) {
      const bool hex = c == '0' && (next() == 'x' || next() == 'X');
      while (is_letter(next()) || is_digit(next()) || next() == '.' ||
             (!hex && (next() == '+' || next() == '-') && (code_[end - 1] == 'e' || code_[end - 1] == 'E')))
        ++end;
      return push(TokenKind::number, end - at_);
    }
    push(TokenKind::symbol, symbol_length());
  }

  std::size_t symbol_length() const {
    constexpr std::array<std::string_view, 23> longer{
        "<<=", ">>=", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
        "==",  "!=",  "<=", ">=", "&&", "||", "^^", "<<", ">>", "##", "::"};
    for (const std::string_view symbol : longer) {
      if (at(symbol)) return symbol.size();
    }
    if (std::string_view("()[]{}.,;:?+-*/%<>=!&|^~#").find(code_[at_]) != std::string_view::npos) return 1;
    fail_in_glsl(text_, place(), "no GLSL has this character");
  }

  const GlslText& text_;
  std::string_view code_;
  const std::size_t* offset_;
  std::size_t at_ = 0;
  std::vector<GlslToken> tokens_{};
};

}  // namespace

std::vector<GlslToken> tokenize_glsl(const GlslText& text) {
  if (text.text.size() > longest_text)
    throw UnusableInput(fmt::format("{}: a shader of {} bytes; at most {} are read, so take out what is not needed",
                                    text.name, text.text.size(), longest_text));
  if (std::all_of(text.text.begin(), text.text.end(), is_space))
    throw UnusableInput(text.name + ": is empty; save the shader again");
  const auto no_text = [](char c) { return (static_cast<unsigned char>(c) < 32 && !is_space(c)) || c == 127; };
  if (std::any_of(text.text.begin(), text.text.end(), no_text))
    throw UnusableInput(text.name + ": is not text, so it is no shader");
  return Scanner(text, text.text, nullptr).run();
}

std::vector<GlslToken> tokenize_macro(const GlslText& text, std::string_view body, std::size_t offset) {
  return Scanner(text, body, &offset).run();
}

bool ends_line(const GlslText& text, std::size_t offset) {
  const char c = text.text[offset];
  return c == '\n' || (c == '\r' && (offset + 1 == text.text.size() || text.text[offset + 1] != '\n'));
}

std::size_t glsl_line(const GlslText& text, std::size_t offset) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < std::min(offset, text.text.size()); ++i) line += ends_line(text, i);
  return line;
}

std::string glsl_message(const GlslText& text, std::size_t offset, std::string_view what) {
  const std::string_view all = text.text;
  offset = std::min(offset, all.size());
  const std::size_t before = offset == 0 ? std::string_view::npos : all.find_last_of("\r\n", offset - 1);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const std::size_t end = std::min(all.find_first_of("\r\n", offset), all.size());
  constexpr std::size_t longest = 60;
  const std::size_t shown_from = offset - begin > longest ? offset - longest : begin;
  std::string excerpt = shown_from > begin ? "..." : "", indent(excerpt.size(), ' ');
  std::size_t column = 1;
  for (std::size_t i = begin; i < std::min(end, offset + longest); ++i) {
    const auto byte = static_cast<unsigned char>(all[i]);
    const bool continues = (byte & 0xc0) == 0x80;
    if (i < offset && !continues) ++column;
    if (i < shown_from || continues) continue;
    excerpt += byte < 32 ? ' ' : byte < 127 ? all[i] : '?';
    if (i < offset) indent += ' ';
  }
  return fmt::format("{}:{}:{}: {}\n  {}\n  {}^", text.name, glsl_line(text, offset), column, what, excerpt, indent);
}

void fail_in_glsl(const GlslText& text, std::size_t offset, std::string_view what) {
  throw UnusableInput(glsl_message(text, offset, what));
}

}  // namespace evenmesh::gl
