#pragma once
/// MeshOptions as JSON, and the ranges of their numbers.

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "evenmesh/mesh_shape.h"

namespace evenmesh {

/// Both ends are allowed.
template <typename Number>
struct Range {
  Number lo;
  Number hi;
};

/// Ranges of the whole numbers in MeshOptions; mesh_shape() refuses others.
namespace ranges {
inline constexpr Range<std::size_t> vertices{4, 1'000'000'000};
inline constexpr Range<std::size_t> resolution{8, 8192};
inline constexpr Range<unsigned> thickness{1, 20};
inline constexpr Range<std::size_t> max_cycle{3, 8};
inline constexpr Range<std::size_t> iterations{0, 10'000};
}  // namespace ranges

/// All options as one JSON object, keys in the order of the struct. What is not set is left out; enumerators are names
/// (names.h).
///
/// | key | value |
/// |---|---|
/// | `vertices`, `resolution`, `thickness`, `max_cycle`, `iterations`, `seed` | whole number |
/// | `edge_length` (model units), `evenness`, `tolerance` | number |
/// | `method`, `quality`, `optimizer`, `start`, `connect`, `topology`, `placement` | name |
/// | `wrap`, `fill_cavities` | true or false |
/// | `features` | angle in degrees, or "off" |
/// | `bounds` | six numbers x0, y0, z0, x1, y1, z1, model units |
/// | `density` | "uniform", or the text given to density_from_expression(); with `density_parameters`, numbers by name
/// |
///
/// A density that is a function of the caller's own has no text, and numbers that are not finite have none in JSON:
/// both are null, which options_from_json() refuses.
/// Guarantee: options_from_json(options_json(o)) has the same value in every field, to the last bit.
std::string options_json(const MeshOptions& options);

/// Options from such an object; keys may be missing, in any order. `features` may also be "auto": the default.
///
/// @param json  text of one JSON object
/// @param base  what holds where a key is missing
/// @throws InvalidInput  one sentence that names the key and what it takes: text that is no JSON object, an unknown key
///         (with those probably meant), a wrong type or name, a whole number out of its range, an expression that does
///         not parse. Numbers that are not whole, and what contradicts each other, are left to mesh_shape().
/// Guarantee: any text either gives options or throws.
MeshOptions options_from_json(std::string_view json, const MeshOptions& base = {});

}  // namespace evenmesh
