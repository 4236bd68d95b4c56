/// OFF (Geomview): OFF, COFF, NOFF, STOFF and their mixtures, as text; colours, normals and texture coordinates are
/// passed over.

#include <fmt/format.h>

#include "geometry/single_precision.h"
#include "io/formats.h"
#include "io/polygons.h"
#include "io/text.h"

namespace evenmesh {
namespace {

/// Reads line by line: comments and empty lines are skipped, and so is the rest of a line that holds more than is asked
/// for.
class OffReader {
 public:
  explicit OffReader(const Source& source) : source_(source), p_(source.begin()), end_(source.end()) {}

  Mesh read() {
    read_keyword();
    skip_to_content();
    const std::uint64_t vertices = read_count("the number of vertices");
    skip_to_content();
    const std::uint64_t faces = read_count("the number of faces");
    p_ = next_line(p_, end_);  // the number of edges, which many programs leave out or get wrong
    // A vertex takes six bytes at least ("0 0 0\n", the last one five), a face two.
    const auto left = static_cast<std::uint64_t>(end_ - p_);
    if (vertices > (left + 1) / 6 || faces > (left + 1) / 2) {
      fail(source_, fmt::format("announces {} vertices and {} faces, but only {} bytes follow; the file is truncated",
                                vertices, faces, left));
    }
    if (vertices > max_vertices) fail(source_, "has more than 4,294,967,295 vertices; split it");
    mesh_.vertices.reserve(vertices);
    for (std::uint64_t i = 0; i < vertices; ++i) read_vertex(i);
    mesh_.triangles.reserve(faces);
    for (std::uint64_t i = 0; i < faces; ++i) read_face(i);
    if (faces > 0 && mesh_.triangles.empty())
      fail(source_, "holds no triangles; its faces have fewer than three corners");
    mend_fans(source_, fans_, mesh_);
    return std::move(mesh_);
  }

 private:
  void skip_blanks() {
    while (p_ < end_ && is_blank(*p_)) ++p_;
  }
  void skip_to_content() {
    for (skip_blanks(); p_ < end_ && (*p_ == '\n' || *p_ == '#'); skip_blanks()) p_ = next_line(p_, end_);
  }
  bool at_word_end() const { return p_ == end_ || is_blank(*p_) || *p_ == '\n' || *p_ == '#'; }

  void read_keyword() {
    skip_to_content();
    if (p_ < end_ && is_digit(*p_)) return;  // Geomview allows the word to be left out
    const char* from = p_;
    while (!at_word_end()) ++p_;
    const std::string_view word(from, static_cast<std::size_t>(p_ - from));
    if (!word.ends_with("OFF"))
      fail_at(source_, from, fmt::format("expected 'OFF', found {}", found_at(source_, from)));
    if (word.find_first_of("4n") != std::string_view::npos) {
      fail_at(source_, from,
              fmt::format("{} holds points of other than three dimensions; only OFF, COFF, NOFF and STOFF "
                          "are surfaces in space",
                          quoted(word)));
    }
    skip_blanks();
    if (source_.bytes.substr(static_cast<std::size_t>(p_ - source_.begin())).starts_with("BINARY")) {
      fail_at(source_, from, "binary OFF is not available in this version; save it as text OFF or as PLY");
    }
  }

  [[noreturn]] void wrong(const char* from, std::string_view expected) const {
    fail_at(source_, from, fmt::format("expected {}, found {}", expected, found_at(source_, from)));
  }
  std::int64_t read_integer(std::string_view expected) {
    skip_blanks();
    const char* from = p_;
    std::int64_t value = 0;
    if (!scan_integer(p_, end_, value) || !at_word_end()) wrong(from, expected);
    return value;
  }
  std::uint64_t read_count(std::string_view expected) {
    const char* from = p_;
    const std::int64_t count = read_integer(expected);
    if (count < 0) wrong(from, expected);
    return static_cast<std::uint64_t>(count);
  }

  void require_more(std::string_view what, std::uint64_t i) {
    skip_to_content();
    if (p_ == end_) fail(source_, fmt::format("ends before {} {} (counted from 0); the file is truncated", what, i));
  }

  void read_vertex(std::uint64_t i) {
    if (i % (1 << 16) == 0) source_.context->throw_if_cancelled();
    require_more("vertex", i);
    Vec3 v;
    for (int a = 0; a < 3; ++a) {
      skip_blanks();
      const char* from = p_;
      if (!scan_number(p_, end_, v[a]) || !at_word_end()) wrong(from, "a coordinate of the vertex");
    }
    mesh_.vertices.push_back(v);
    p_ = next_line(p_, end_);
  }

  void read_face(std::uint64_t i) {
    if (i % (1 << 16) == 0) source_.context->throw_if_cancelled();
    require_more("face", i);
    const std::uint64_t corners = read_count("the number of corners of the face");
    if (corners > 3) fans_.push_back({mesh_.triangles.size(), corners - 2});
    append_fan(mesh_.triangles, corners, [&] {
      const std::int64_t index = read_integer("a vertex index");
      if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size()) {
        fail_at(
            source_, p_,
            fmt::format("vertex index {} is out of range (the file has {} vertices)", index, mesh_.vertices.size()));
      }
      return static_cast<std::uint32_t>(index);
    });
    p_ = next_line(p_, end_);
  }

  const Source& source_;
  const char* p_;
  const char* end_;
  Mesh mesh_;
  std::vector<Fan> fans_;
};

}  // namespace

Mesh read_off(const Source& original) {
  std::string storage;
  const Source source = original.with(with_unix_lines(original.bytes, storage));
  return OffReader(source).read();
}

std::string write_off(const Mesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  const bool single = fits_single_precision(mesh);
  text.reserve((single ? 32 : 60) * mesh.vertices.size() + 24 * mesh.triangles.size() + text.size());
  for (const Vec3& v : mesh.vertices) {
    for (int a = 0; a < 3; ++a) append_coordinate(a == 0 ? text : text += ' ', v[a], single);
    text += '\n';
  }
  for (const Triangle& t : mesh.triangles) {
    text += '3';
    for (const std::uint32_t v : t) append_number(text += ' ', std::uint64_t{v});
    text += '\n';
  }
  return text;
}

}  // namespace evenmesh
