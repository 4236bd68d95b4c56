#include "io/text.h"

#include <algorithm>

namespace evenmesh {

bool equals_ignoring_case(std::string_view text, std::string_view small) {
  return text.size() == small.size() &&
         std::equal(text.begin(), text.end(), small.begin(), [](char a, char b) { return lower(a) == b; });
}

double saturated_number(const char* first, const char* last) {
  const bool negative = first != last && *first == '-';
  if (negative) ++first;
  // Position of the first significant digit relative to the decimal point decides the order of magnitude.
  std::int64_t magnitude = 0;
  bool significant = false, point = false;
  const char* p = first;
  for (; p != last && (is_digit(*p) || *p == '.'); ++p) {
    if (*p == '.') {
      point = true;
      continue;
    }
    significant = significant || *p != '0';
    if (significant && !point) ++magnitude;
    if (!significant && point) --magnitude;
  }
  if (p != last && lower(*p) == 'e') {
    std::int64_t exponent = 0;
    if (scan_integer(++p, last, exponent)) magnitude += exponent;
  }
  const double value = significant && magnitude > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  return negative ? -value : value;
}

namespace {
template <typename Number>
void append(std::string& text, Number value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}
}  // namespace

void append_number(std::string& text, float value) {
  append(text, value);
}
void append_number(std::string& text, std::uint64_t value) {
  append(text, value);
}
void append_coordinate(std::string& text, double value, bool single) {
  single ? append(text, static_cast<float>(value)) : append(text, value);
}

}  // namespace evenmesh
