#pragma once
/// The header of a PLY file: which elements follow, with which properties.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/source.h"

namespace evenmesh::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> count_type;  ///< of lists
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  bool has_lists() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const Property& p) { return p.count_type.has_value(); });
  }
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  const char* body = nullptr;
};

/// Bytes of a value in a binary file.
std::size_t size_of(Type type);
inline bool is_integer(Type type) {
  return type != Type::float32 && type != Type::float64;
}

/// Reads up to the line after "end_header". @throws UnusableInput  with the line at fault
Header parse_header(const Source& source);

}  // namespace evenmesh::ply
