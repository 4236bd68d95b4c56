/// Which format is it?

#include <algorithm>
#include <array>
#include <string>

#include "evenmesh/io.h"
#include "io/formats.h"
#include "io/text.h"

namespace evenmesh {
namespace {

/// First line that is neither empty nor a comment (#), without blanks in front.
std::string_view first_statement(std::string_view bytes) {
  while (!bytes.empty()) {
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n\v\f"), bytes.size()));
    const std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
    if (!line.starts_with('#')) return line;
    bytes.remove_prefix(line.size());
  }
  return {};
}

std::string_view first_word(std::string_view line) {
  return line.substr(0, line.find_first_of(" \t"));
}

/// OFF, COFF, NOFF, STOFF, STCN4nOFF …
bool is_off_word(std::string_view word) {
  return word.size() <= 9 && word.ends_with("OFF") &&
         word.substr(0, word.size() - 3).find_first_not_of("STCN4n") == std::string_view::npos;
}

bool is_obj_word(std::string_view word) {
  constexpr std::array<std::string_view, 12> words{"v", "vn", "vt",     "vp",     "f",      "o",
                                                   "g", "s",  "mtllib", "usemtl", "usemap", "l"};
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The words are short and some are English, so a vertex is asked for as well.
bool looks_like_obj(std::string_view bytes) {
  const std::string_view line = first_statement(bytes);
  if (!is_obj_word(first_word(line)) || first_word(line).size() == line.size()) return false;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    while (at < bytes.size() && (is_blank(bytes[at]) || bytes[at] == '\n')) ++at;
    const std::string_view rest = bytes.substr(at);
    if (rest.size() > 2 && rest[0] == 'v' && is_blank(rest[1])) {
      const std::size_t number = rest.find_first_not_of(" \t", 1);
      return number != std::string_view::npos &&
             (is_digit(rest[number]) || std::string_view("+-.nNiI\\").find(rest[number]) != std::string_view::npos);
    }
    at = bytes.find_first_of("\r\n", at);
    if (at == std::string_view::npos) break;
  }
  return false;
}

bool looks_like_gltf(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  return bytes.starts_with('{') && bytes.find("\"asset\"") != std::string_view::npos;
}

}  // namespace

std::optional<MeshFormat> format_of_name(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, MeshFormat>, 7> extensions{{{".ply", MeshFormat::ply},
                                                                               {".obj", MeshFormat::obj},
                                                                               {".stl", MeshFormat::stl},
                                                                               {".off", MeshFormat::off},
                                                                               {".glb", MeshFormat::glb},
                                                                               {".gltf", MeshFormat::glb},
                                                                               {".3mf", MeshFormat::threemf}}};
  const std::size_t dot = name.find_last_of("./\\");
  if (dot == std::string_view::npos || name[dot] != '.') return {};
  for (const auto& [extension, format] : extensions) {
    if (equals_ignoring_case(name.substr(dot), extension)) return format;
  }
  return {};
}

std::optional<MeshFormat> format_of_content(std::string_view bytes) {
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::ply;
  if (bytes.starts_with("glTF")) return MeshFormat::glb;
  if (bytes.starts_with(std::string_view("PK\3\4", 4))) return MeshFormat::threemf;
  if (is_exact_binary_stl(bytes) || is_ascii_stl(bytes)) return MeshFormat::stl;
  if (is_off_word(first_word(first_statement(bytes)))) return MeshFormat::off;
  if (looks_like_gltf(bytes)) return MeshFormat::glb;
  if (looks_like_obj(bytes)) return MeshFormat::obj;
  return {};
}

}  // namespace evenmesh
