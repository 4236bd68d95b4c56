#pragma once
/// Units of length.

#include <optional>
#include <string>
#include <string_view>

namespace evenmesh {

/// What a length of 1 is. Files that say nothing of it have none.
enum class LengthUnit { micron, millimeter, centimeter, meter, inch, foot };

/// How many of `to` make one of `from`, correctly rounded: 25.4 millimeters an inch.
double conversion_factor(LengthUnit from, LengthUnit to);

/// "inch", as 3MF has it, and "inches".
std::string_view word_of(LengthUnit unit);
std::string_view plural_of(LengthUnit unit);
/// "in".
std::string_view abbreviation_of(LengthUnit unit);

/// The unit of an abbreviation or word; none of any other text.
std::optional<LengthUnit> unit_of_name(std::string_view name);
/// All abbreviations: "micron, mm, …".
std::string unit_names();

}  // namespace evenmesh
