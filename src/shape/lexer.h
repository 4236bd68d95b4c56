#pragma once
/// Splits the text of an expression into tokens.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace evenmesh {

/// `symbol` is the character of an operator or bracket ('^' also for superscripts), 'n' a number, 'i' an identifier, 0
/// the end.
struct Token {
  char symbol = 0;
  std::size_t column = 1;  ///< 1-based, in characters, not bytes
  double number = 0;
  std::string_view text;
};

/// Tokens of a whole text; the last one is the end.
/// @throws InvalidInput  a character that stands for nothing, a number out of range, a text longer than 100,000 bytes
std::vector<Token> tokenize(std::string_view text);

/// Throws InvalidInput: "column C: MESSAGE", the text (or the part of it around the column) and a caret under the
/// column.
[[noreturn]] void fail_at(std::string_view text, std::size_t column, const std::string& message);

}  // namespace evenmesh
