#pragma once
/// Fast scanning of numbers in text: no locale, no copies, no sentinel behind the last byte.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>

#include "io/source.h"

namespace evenmesh {

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
inline char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
/// Equal up to the case of ASCII letters; `small` is lower case.
bool equals_ignoring_case(std::string_view text, std::string_view small);

/// Value of a decimal number too large or too small for a double: ±infinity or 0.
double saturated_number(const char* first, const char* last);

/// Reads a decimal number at `p` and moves `p` behind it; false, and `p` as it was, if there is none.
/// Out-of-range numbers saturate to infinity or zero.
inline bool scan_number(const char*& p, const char* end, double& value) {
  const char* first = p;
  if (first != end && *first == '+') ++first;  // which from_chars does not know
  const auto [last, error] = std::from_chars(first, end, value);
  if (error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) value = saturated_number(first, last);
  p = last;
  return true;
}

/// The same for a whole number in [-2^53, 2^53]; larger ones saturate.
inline bool scan_integer(const char*& p, const char* end, std::int64_t& value) {
  constexpr std::int64_t largest = std::int64_t{1} << 53;
  const char* q = p;
  const bool negative = q != end && *q == '-';
  if (negative || (q != end && *q == '+')) ++q;
  if (q == end || !is_digit(*q)) return false;
  std::int64_t magnitude = 0;
  for (; q != end && is_digit(*q); ++q) {
    magnitude = 10 * magnitude + (*q - '0');
    if (magnitude > largest) magnitude = largest;
  }
  value = negative ? -magnitude : magnitude;
  p = q;
  return true;
}

/// First byte behind the next line end, or `end`.
inline const char* next_line(const char* p, const char* end) {
  if (p == end) return end;
  const void* line_end = std::memchr(p, '\n', static_cast<std::size_t>(end - p));
  return line_end ? static_cast<const char*>(line_end) + 1 : end;
}

/// Appends the shortest decimal that gives the same 32-bit float back.
void append_number(std::string& text, float value);
void append_number(std::string& text, std::uint64_t value);
/// Appends the shortest decimal that gives the same double back or, `single`, the same 32-bit float.
void append_coordinate(std::string& text, double value, bool single);

}  // namespace evenmesh
