#pragma once
/// JSON text to a tree, refused in a sentence where it is none.

#include <cstddef>
#include <nlohmann/json.hpp>

#include "io/source.h"

namespace evenmesh {

/// Parses JSON; comments (// and /* */) are allowed.
/// @param depth  of objects and arrays within each other, at most
/// @throws UnusableInput  with line and column: no JSON, a key that occurs twice in one object, too deep
nlohmann::json parse_json_text(const Source& source, std::size_t depth);

}  // namespace evenmesh
