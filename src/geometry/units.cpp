#include "evenmesh/units.h"

#include <array>
#include <cstddef>

namespace evenmesh {
namespace {

struct Unit {
  double microns;
  std::string_view abbreviation, word, plural;
};

constexpr std::array<Unit, 6> units{{{1, "micron", "micron", "microns"},
                                     {1e3, "mm", "millimeter", "millimeters"},
                                     {1e4, "cm", "centimeter", "centimeters"},
                                     {1e6, "m", "meter", "meters"},
                                     {25400, "in", "inch", "inches"},
                                     {304800, "ft", "foot", "feet"}}};

const Unit& entry(LengthUnit unit) {
  return units[static_cast<std::size_t>(unit)];
}

}  // namespace

double conversion_factor(LengthUnit from, LengthUnit to) {
  return entry(from).microns / entry(to).microns;
}
std::string_view word_of(LengthUnit unit) {
  return entry(unit).word;
}
std::string_view plural_of(LengthUnit unit) {
  return entry(unit).plural;
}
std::string_view abbreviation_of(LengthUnit unit) {
  return entry(unit).abbreviation;
}

std::optional<LengthUnit> unit_of_name(std::string_view name) {
  for (std::size_t i = 0; i < units.size(); ++i)
    if (name == units[i].abbreviation || name == units[i].word) return static_cast<LengthUnit>(i);
  return {};
}

std::string unit_names() {
  std::string names;
  for (const Unit& unit : units) {
    if (!names.empty()) names += ", ";
    names += unit.abbreviation;
  }
  return names;
}

}  // namespace evenmesh
