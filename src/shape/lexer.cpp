#include "shape/lexer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <utility>

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

constexpr std::size_t longest_text = 100'000;

struct Character {
  std::uint32_t code = 0;  ///< Unicode, 0xfffd where the bytes are not UTF-8
  std::size_t bytes = 1;
};

Character character_at(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(i);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || i + bytes > text.size()) return {0xfffd, 1};
  std::uint32_t code = first & (0xffu >> (bytes + 1));
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(i + k) & 0xc0) != 0x80) return {0xfffd, 1};
    code = code << 6 | (byte(i + k) & 0x3f);
  }
  constexpr std::array<std::uint32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
  if (code < smallest[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {0xfffd, 1};
  return {code, bytes};
}

/// The digit that a superscript stands for, or -1.
int superscript_digit(std::uint32_t code) {
  if (code == 0xb9) return 1;
  if (code == 0xb2 || code == 0xb3) return static_cast<int>(code - 0xb0);
  return code == 0x2070 || (code >= 0x2074 && code <= 0x2079) ? static_cast<int>(code - 0x2070) : -1;
}

/// Operators as they come out of text processors, in ASCII.
char plain_symbol(std::uint32_t code) {
  switch (code) {
    case 0x2212:
    case 0x2013:
      return '-';  // minus sign, en dash
    case 0xb7:
    case 0xd7:
    case 0x22c5:
    case 0x2217:
      return '*';  // dots, cross, asterisk operator
    case 0xf7:
    case 0x2215:
      return '/';
    default:
      return code < 0x80 && std::string_view("+-*/^(),=").find(static_cast<char>(code)) != std::string_view::npos
                 ? static_cast<char>(code)
                 : '\0';
  }
}

bool is_space(std::uint32_t code) {
  return code == ' ' || (code >= 9 && code <= 13) || code == 0xa0;
}
bool is_digit(std::uint32_t code) {
  return code >= '0' && code <= '9';
}
bool is_letter(std::uint32_t code) {
  return (code >= 'a' && code <= 'z') || (code >= 'A' && code <= 'Z') || code == '_';
}

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  std::vector<Token> run() {
    if (text_.size() > longest_text)
      throw InvalidInput("the expression has " + std::to_string(text_.size()) + " bytes; at most " +
                         std::to_string(longest_text) + " are allowed");
    while (at_ < text_.size()) next();
    tokens_.push_back({0, column_, 0, {}});
    return std::move(tokens_);
  }

 private:
  void next() {
    const Character c = character_at(text_, at_);
    if (is_space(c.code)) return advance(c.bytes, 1);
    if (is_digit(c.code) || c.code == '.') return number();
    if (is_letter(c.code)) return identifier();
    if (superscript_digit(c.code) >= 0) return superscript();
    if (c.code == 0x3c0) return push('i', c.bytes, 1, "pi");
    if (text_.substr(at_, 2) == "**") return push('^', 2, 2);
    if (const char symbol = plain_symbol(c.code)) return push(symbol, c.bytes, 1);
    if (c.code == '[' || c.code == '{') fail_at(text_, column_, "use round brackets ( )");
    if (c.code == '<' || c.code == '>')
      fail_at(text_, column_, "no comparison is needed: the solid is where the expression is negative");
    fail_at(text_, column_, "unexpected character");
  }

  void advance(std::size_t bytes, std::size_t columns) {
    at_ += bytes;
    column_ += columns;
  }

  void push(char symbol, std::size_t bytes, std::size_t columns, std::string_view name = {}, double value = 0) {
    tokens_.push_back({symbol, column_, value, name.empty() ? text_.substr(at_, bytes) : name});
    advance(bytes, columns);
  }

  void number() {
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) fail_at(text_, column_, "this number is out of range");
    if (error != std::errc()) fail_at(text_, column_, "expected a number");
    const std::size_t bytes = static_cast<std::size_t>(end - (text_.data() + at_));
    push('n', bytes, bytes, {}, value);
    if (at_ < text_.size() && text_[at_] == '.') fail_at(text_, column_, "a number has two decimal points");
  }

  void identifier() {
    std::size_t bytes = 1;
    const auto belongs = [](unsigned char c) { return is_letter(c) || is_digit(c); };
    while (at_ + bytes < text_.size() && belongs(static_cast<unsigned char>(text_[at_ + bytes]))) ++bytes;
    push('i', bytes, bytes);
  }

  /// x²³ is x to the 23rd: a caret and one number.
  void superscript() {
    const std::size_t begin = at_, column = column_;
    double value = 0;
    while (at_ < text_.size()) {
      const Character c = character_at(text_, at_);
      if (superscript_digit(c.code) < 0) break;
      value = 10 * value + superscript_digit(c.code);
      advance(c.bytes, 1);
    }
    const std::string_view spelled = text_.substr(begin, at_ - begin);
    tokens_.push_back({'^', column, 0, spelled});
    tokens_.push_back({'n', column, value, spelled});
  }

  std::string_view text_;
  std::size_t at_ = 0, column_ = 1;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokenize(std::string_view text) {
  return Lexer(text).run();
}

void fail_at(std::string_view text, std::size_t column, const std::string& message) {
  constexpr std::size_t before = 60, after = 20;
  const std::size_t first = column > before ? column - before : 1, last = column + after;
  std::string excerpt = first > 1 ? "…" : "";
  std::size_t position = 1;
  for (std::size_t i = 0; i < text.size() && position <= last; ++position) {
    const Character c = character_at(text, i);
    if (position >= first) {
      if (c.code < 32 || (c.code >= 0x7f && c.code < 0xa0) || c.code == 0xfffd)
        excerpt += is_space(c.code) ? ' ' : '?';
      else
        excerpt += text.substr(i, c.bytes);
    }
    i += c.bytes;
  }
  if (position > last) excerpt += "…";
  const std::size_t indent = 2 + (first > 1 ? 1 : 0) + (column - first);
  throw InvalidInput("column " + std::to_string(column) + ": " + message + "\n  " + excerpt + "\n" +
                     std::string(indent, ' ') + "^");
}

}  // namespace evenmesh
