#pragma once
/// GLSL as tokens.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace evenmesh::gl {

/// A text and its name, for messages.
struct GlslText {
  std::string text;
  std::string name;
};

enum class TokenKind { word, number, symbol, directive };

struct GlslToken {
  TokenKind kind = TokenKind::symbol;
  std::string text{};      ///< of a directive: the whole of it, continued lines joined, comments blank, without '#'
  std::size_t offset = 0;  ///< where it begins
  std::string before{}, after{};  ///< what is added around it

  bool is(std::string_view other) const { return text == other && kind != TokenKind::directive; }
  bool is_word() const { return kind == TokenKind::word; }
  bool is_directive() const { return kind == TokenKind::directive; }
};

/// All tokens; comments are dropped.
/// @throws UnusableInput  more than 1 MB, bytes that no text has, characters that no shader has, an endless comment
/// Cost: O(size); some 130 bytes per token.
std::vector<GlslToken> tokenize_glsl(const GlslText& text);

/// The same for a piece of code without directives: the body of a macro. `offset` goes to all tokens.
std::vector<GlslToken> tokenize_macro(const GlslText& text, std::string_view body, std::size_t offset);

/// Whether a line ends with the character at an offset: \n, \r, or the last one of \r\n.
bool ends_line(const GlslText& text, std::size_t offset);

/// Line of an offset, from 1.
std::size_t glsl_line(const GlslText& text, std::size_t offset);

/// "NAME:LINE:COLUMN: what", the line, and a caret.
std::string glsl_message(const GlslText& text, std::size_t offset, std::string_view what);

/// Throws UnusableInput with glsl_message().
[[noreturn]] void fail_in_glsl(const GlslText& text, std::size_t offset, std::string_view what);

}  // namespace evenmesh::gl
