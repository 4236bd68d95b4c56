#pragma once
/// Values of options: from text to numbers, with sentences that name the option and its range.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evenmesh/error.h"
#include "evenmesh/mesh.h"
#include "evenmesh/names.h"
#include "evenmesh/options_json.h"

namespace evenmesh::cli {

/// A whole number in [lo, hi], digits only. @throws InvalidInput
std::uint64_t whole_number(const std::string& option, const std::string& text, std::uint64_t lo,
                           std::uint64_t hi = std::numeric_limits<std::uint64_t>::max());

/// A whole number in a range of MeshOptions. @throws InvalidInput
template <typename Number>
Number whole_number(const std::string& option, const std::string& text, const Range<Number>& range) {
  return static_cast<Number>(whole_number(option, text, range.lo, range.hi));
}

/// A finite number. @throws InvalidInput
double real_number(const std::string& option, const std::string& text);

/// A finite number in [lo, hi]. @throws InvalidInput
double real_number(const std::string& option, const std::string& text, double lo, double hi);

/// "a,b,c" as `count` finite numbers. @throws InvalidInput
std::vector<double> real_numbers(const std::string& option, const std::string& text, std::size_t count);

/// "x0,y0,z0,x1,y1,z1" with every lower bound below the upper one. @throws InvalidInput
Box box(const std::string& option, const std::string& text);

/// "name=value". @throws InvalidInput
std::pair<std::string, std::string> definition(const std::string& option, const std::string& text);

/// The index of `text` among `allowed`.
/// @throws InvalidInput
std::size_t choice(const std::string& option, const std::string& text, const std::vector<std::string>& allowed);

/// The enumerator of that name. @throws InvalidInput
template <typename Enum>
Enum choice(const std::string& option, const std::string& text) {
  const std::optional<Enum> found = value_of<Enum>(text);
  if (!found) throw InvalidInput(fmt::format("{} takes one of {}, not '{}'", option, joined_names<Enum>(), text));
  return *found;
}

/// Always throws NotAvailable: "WHAT is not available in this version".
[[noreturn]] void not_available(const std::string& what);

}  // namespace evenmesh::cli
