#include "values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace evenmesh::cli {
namespace {

std::string grouping_hint(const std::string& text) {
  std::string digits;
  std::copy_if(text.begin(), text.end(), std::back_inserter(digits), [](char c) { return c >= '0' && c <= '9'; });
  const bool grouped =
      !digits.empty() && digits.size() < text.size() && text.find_first_not_of("0123456789,'_ ") == std::string::npos;
  return grouped ? fmt::format("; write it without separators: {}", digits) : "";
}

}  // namespace

std::uint64_t whole_number(const std::string& option, const std::string& text, std::uint64_t lo, std::uint64_t hi) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool too_large = error == std::errc::result_out_of_range && stop == end;
  const std::string range = hi == std::numeric_limits<std::uint64_t>::max() ? fmt::format("of at least {}", lo)
                                                                            : fmt::format("between {} and {}", lo, hi);
  if ((error != std::errc() && !too_large) || stop != end) {
    throw InvalidInput(fmt::format("{} takes a whole number {}, not '{}'{}", option, range, text, grouping_hint(text)));
  }
  if (too_large || value < lo || value > hi) {
    throw InvalidInput(fmt::format("{} takes a whole number {}; {} is out of range", option, range, text));
  }
  return value;
}

double real_number(const std::string& option, const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw InvalidInput(fmt::format("{} takes a number, not '{}'", option, text));
  }
  return value;
}

double real_number(const std::string& option, const std::string& text, double lo, double hi) {
  const double value = real_number(option, text);
  if (value < lo || value > hi) {
    throw InvalidInput(fmt::format("{} takes a number between {} and {}; {} is out of range", option, lo, hi, text));
  }
  return value;
}

std::vector<double> real_numbers(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    values.push_back(real_number(option, text.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  if (values.size() != count) {
    throw InvalidInput(
        fmt::format("{} takes {} numbers with commas between them, not {} ('{}')", option, count, values.size(), text));
  }
  return values;
}

Box box(const std::string& option, const std::string& text) {
  const std::vector<double> v = real_numbers(option, text, 6);
  Box result;
  result.lo = {v[0], v[1], v[2]};
  result.hi = {v[3], v[4], v[5]};
  for (int axis = 0; axis < 3; ++axis) {
    if (!(result.lo[axis] < result.hi[axis])) {
      throw InvalidInput(fmt::format("{} x0,y0,z0,x1,y1,z1 needs {}0 below {}1; {} is not below {}", option,
                                     "xyz"[axis], "xyz"[axis], result.lo[axis], result.hi[axis]));
    }
  }
  return result;
}

std::pair<std::string, std::string> definition(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InvalidInput(fmt::format("{} takes name=value, for instance {} a=0.5, not '{}'", option, option, text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::size_t choice(const std::string& option, const std::string& text, const std::vector<std::string>& allowed) {
  const auto found = std::find(allowed.begin(), allowed.end(), text);
  if (found != allowed.end()) return static_cast<std::size_t>(found - allowed.begin());
  throw InvalidInput(fmt::format("{} takes one of {}, not '{}'", option, fmt::join(allowed, ", "), text));
}

void not_available(const std::string& what) {
  throw NotAvailable(what + " is not available in this version");
}

}  // namespace evenmesh::cli
