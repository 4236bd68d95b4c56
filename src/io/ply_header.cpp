#include "io/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "io/text.h"

namespace evenmesh::ply {
namespace {

std::optional<Type> type_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> names{{{"char", Type::int8},
                                                                     {"uchar", Type::uint8},
                                                                     {"short", Type::int16},
                                                                     {"ushort", Type::uint16},
                                                                     {"int", Type::int32},
                                                                     {"uint", Type::uint32},
                                                                     {"float", Type::float32},
                                                                     {"double", Type::float64},
                                                                     {"int8", Type::int8},
                                                                     {"uint8", Type::uint8},
                                                                     {"int16", Type::int16},
                                                                     {"uint16", Type::uint16},
                                                                     {"int32", Type::int32},
                                                                     {"uint32", Type::uint32},
                                                                     {"float32", Type::float32},
                                                                     {"float64", Type::float64}}};
  for (const auto& [known, type] : names) {
    if (known == name) return type;
  }
  return {};
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_blank(line[i])) ++i;
    const std::size_t first = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    if (i > first) words.push_back(line.substr(first, i - first));
  }
  return words;
}

Encoding parse_encoding(const Source& source, const char* line, std::string_view word) {
  if (word == "ascii") return Encoding::ascii;
  if (word == "binary_little_endian") return Encoding::little_endian;
  if (word == "binary_big_endian") return Encoding::big_endian;
  fail_at(source, line, fmt::format("format {} is unknown; use ascii or binary_little_endian", quoted(word)));
}

Property parse_property(const Source& source, const char* line, const std::vector<std::string_view>& words) {
  const auto type = [&](std::string_view word) {
    const std::optional<Type> known = type_of(word);
    if (!known) fail_at(source, line, fmt::format("property type {} is unknown", quoted(word)));
    return *known;
  };
  if (words.size() >= 5 && words[1] == "list") {
    const Property property{std::string(words[4]), type(words[3]), type(words[2])};
    if (!is_integer(*property.count_type)) fail_at(source, line, "the length of a list must have an integer type");
    return property;
  }
  if (words.size() < 3 || words[1] == "list") fail_at(source, line, "the property has no type or no name");
  return {std::string(words[2]), type(words[1]), {}};
}

Element parse_element(const Source& source, const char* line, const std::vector<std::string_view>& words) {
  std::int64_t count = 0;
  if (words.size() < 3) fail_at(source, line, "the element has no name or no count");
  const char* digits = words[2].data();
  if (!scan_integer(digits, words[2].data() + words[2].size(), count) || count < 0) {
    fail_at(source, line, fmt::format("expected the number of elements, found {}", quoted(words[2])));
  }
  return {std::string(words[1]), static_cast<std::uint64_t>(count), {}};
}

}  // namespace

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

Header parse_header(const Source& source) {
  if (!source.bytes.starts_with("ply")) fail(source, "does not begin with 'ply', so it is no PLY file");
  const std::size_t first_end = source.bytes.find_first_of("\r\n");
  if (first_end == std::string_view::npos)
    fail(source, "the PLY header has no line after 'ply'; the file is truncated");
  // A lone \r ends lines only if it ends the first: behind a \r\n header, binary data may begin with any byte.
  const bool mac = source.bytes[first_end] == '\r' && source.bytes.substr(first_end + 1, 1) != "\n";
  Header header;
  bool format_seen = false;
  for (std::size_t at = first_end; true;) {
    at = source.bytes.find(mac ? '\r' : '\n', at);
    if (at == std::string_view::npos) fail(source, "the PLY header has no 'end_header'; the file is truncated");
    const char* line = source.begin() + ++at;
    const std::string_view rest = source.bytes.substr(at);
    const auto words = words_of(rest.substr(0, rest.find_first_of(mac ? "\r" : "\n")));
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format") {
      header.encoding = parse_encoding(source, line, words.size() > 1 ? words[1] : "");
      format_seen = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(source, line, words));
    } else if (words[0] == "property") {
      if (header.elements.empty()) fail_at(source, line, "a property comes before the first element");
      header.elements.back().properties.push_back(parse_property(source, line, words));
    } else if (words[0] == "end_header") {
      const std::size_t end = source.bytes.find(mac ? '\r' : '\n', at);
      header.body = end == std::string_view::npos ? source.end() : source.begin() + end + 1;
      if (!format_seen) fail(source, "the PLY header has no 'format' line; add one, e.g. 'format ascii 1.0'");
      return header;
    } else {
      fail_at(source, line, fmt::format("{} is no keyword of a PLY header", quoted(words[0])));
    }
  }
}

}  // namespace evenmesh::ply
