/// STL (3D Systems 1989), text and binary. Corners with equal coordinates become one vertex; normals are passed over.

#include <fmt/format.h>

#include <algorithm>

#include "geometry/single_precision.h"
#include "io/binary.h"
#include "io/formats.h"
#include "io/text.h"
#include "io/weld.h"

namespace evenmesh {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

/// Word by word. The words after "solid" and "endsolid" are names, and a name may be any word, so their lines are
/// skipped.
class AsciiReader {
 public:
  explicit AsciiReader(const Source& source) : source_(source), p_(source.begin()), end_(source.end()) {}

  Mesh read() {
    bool ended = false;
    for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
      if (equals_ignoring_case(word, "vertex")) {
        if (!in_facet_) fail_at(source_, word.data(), "a vertex outside of a facet");
        facet_.push_back(read_point());
      } else if (equals_ignoring_case(word, "facet")) {
        begin_facet(word);
      } else if (equals_ignoring_case(word, "endfacet")) {
        end_facet(word);
      } else if (equals_ignoring_case(word, "solid") || equals_ignoring_case(word, "endsolid")) {
        ended = lower(word[0]) == 'e';
        if (in_facet_) fail_at(source_, word.data(), "the facet before it has no 'endfacet'");
        p_ = next_line(p_, end_);
      } else if (!equals_ignoring_case(word, "outer") && !equals_ignoring_case(word, "loop") &&
                 !equals_ignoring_case(word, "endloop")) {
        fail_at(source_, word.data(), fmt::format("{} is no keyword of an STL file", quoted(word)));
      }
    }
    if (in_facet_ || !ended) fail(source_, "ends without 'endsolid'; the file is truncated");
    return weld(source_, corners_.size() / 3, [&](std::size_t i) { return corners_[i]; });
  }

 private:
  void skip_space() {
    while (p_ < end_ && (is_blank(*p_) || *p_ == '\n')) ++p_;
  }
  bool at_word_end() const { return p_ == end_ || is_blank(*p_) || *p_ == '\n'; }
  std::string_view next_word() {
    skip_space();
    const char* from = p_;
    while (!at_word_end()) ++p_;
    return {from, static_cast<std::size_t>(p_ - from)};
  }

  Vec3 read_point() {
    Vec3 v;
    for (int a = 0; a < 3; ++a) {
      skip_space();
      const char* from = p_;
      if (!scan_number(p_, end_, v[a]) || !at_word_end()) {
        fail_at(source_, from, fmt::format("expected a coordinate of the vertex, found {}", found_at(source_, from)));
      }
    }
    return v;
  }

  void begin_facet(std::string_view word) {
    if (in_facet_) fail_at(source_, word.data(), "the facet before it has no 'endfacet'");
    in_facet_ = true;
    if (++facets_ % (1 << 16) == 0) source_.context->throw_if_cancelled();
    p_ = std::min(next_line(p_, end_), find_outer());  // "normal" and its numbers, or words for numbers: not needed
  }
  /// Files without line ends exist; then the normal ends where the loop begins.
  const char* find_outer() const {
    const char* q = p_;
    for (; end_ - q >= 5 && *q != '\n'; ++q) {
      if (lower(*q) == 'o' && equals_ignoring_case({q, 5}, "outer")) return q;
    }
    return end_;
  }

  void end_facet(std::string_view word) {
    if (!in_facet_ || facet_.size() < 3) fail_at(source_, word.data(), "a facet has fewer than three vertices");
    for (std::size_t i = 2; i < facet_.size(); ++i) {
      corners_.insert(corners_.end(), {facet_[0], facet_[i - 1], facet_[i]});
    }
    in_facet_ = false;
    facet_.clear();
  }

  const Source& source_;
  const char* p_;
  const char* end_;
  std::vector<Vec3> facet_, corners_;
  std::uint64_t facets_ = 0;
  bool in_facet_ = false;
};

Mesh read_binary(const Source& source) {
  if (source.bytes.size() < header_size)
    fail(source, "is too short for an STL file; it is truncated or something else");
  const std::uint64_t count = load<std::uint32_t>(source.begin() + 80);
  const std::uint64_t room = (source.bytes.size() - header_size) / facet_size;
  if (count > room) {
    fail(source, fmt::format("announces {} triangles, but holds {}; the file is truncated", count, room));
  }
  const char* facets = source.begin() + header_size;
  const auto corner = [&](std::size_t i) {
    const char* at = facets + facet_size * (i / 3) + 12 * (1 + i % 3);
    return Vec3{load<float>(at), load<float>(at + 4), load<float>(at + 8)};
  };
  return weld(source, count, corner);
}

}  // namespace

bool is_exact_binary_stl(std::string_view bytes) {
  return bytes.size() >= header_size &&
         bytes.size() == header_size + facet_size * load<std::uint32_t>(bytes.data() + 80);
}

bool is_ascii_stl(std::string_view bytes) {
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (!equals_ignoring_case(bytes.substr(0, 5), "solid")) return false;
  const std::string_view head = bytes.substr(0, 4096);
  if (head.find('\0') != std::string_view::npos) return false;
  std::string small(head.substr(5));
  std::transform(small.begin(), small.end(), small.begin(), lower);
  return small.find("facet") != std::string::npos || small.find("endsolid") != std::string::npos;
}

Mesh read_stl(const Source& original) {
  if (is_exact_binary_stl(original.bytes) || !is_ascii_stl(original.bytes)) return read_binary(original);
  std::string storage;
  const Source source = original.with(with_unix_lines(original.bytes, storage));
  return AsciiReader(source).read();
}

namespace {

/// What binary STL has no room for.
std::string stl_text(const Mesh& mesh) {
  std::string text = "solid evenmesh\n";
  text.reserve(300 * mesh.triangles.size() + 64);
  const auto put = [&](const char* word, const Vec3& v, bool single) {
    text += word;
    for (int axis = 0; axis < 3; ++axis) append_coordinate(text += ' ', v[axis], single);
    text += '\n';
  };
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    put("facet normal", normalized(cross(b - a, c - a)), true);
    text += "outer loop\n";
    for (const Vec3& v : {a, b, c}) put("vertex", v, false);
    text += "endloop\nendfacet\n";
  }
  return text += "endsolid evenmesh\n";
}

}  // namespace

std::string write_stl(const Mesh& mesh) {
  if (!fits_single_precision(mesh)) return stl_text(mesh);
  ByteWriter out(header_size + facet_size * mesh.triangles.size());
  out.put("binary STL");  // any text but "solid", which would make readers take it for text
  out.skip(80 - 10);
  out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    for (const Vec3& v : {normalized(cross(b - a, c - a)), a, b, c}) {
      for (int axis = 0; axis < 3; ++axis) out.put(static_cast<float>(v[axis]));
    }
    out.skip(2);
  }
  return out.take();
}

}  // namespace evenmesh
