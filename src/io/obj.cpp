/// OBJ (Wavefront 1992): positions and polygons, in any of the forms v, v/vt, v//vn, v/vt/vn; the rest is passed over.

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "geometry/single_precision.h"
#include "io/formats.h"
#include "io/polygons.h"
#include "io/text.h"

namespace evenmesh {
namespace {

/// Files are read in pieces of about this many bytes, in parallel; pieces do not depend on the number of threads.
constexpr std::size_t piece_size = 1 << 20;
/// So that an index relative to the vertices before cannot wrap around in 32 bits.
constexpr std::uint64_t max_vertices = std::uint64_t{1} << 31;

/// What a piece may refer to; known only after all pieces were read.
struct Limits {
  std::uint64_t before = 0, total = 0;
};

struct Piece {
  const char* begin = nullptr;
  const char* end = nullptr;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<Fan> fans;  ///< of the piece's triangles
  std::vector<std::size_t>
      relative;  ///< corners (3 · triangle + i) counted from the piece's own first vertex, modulo 2^32
  std::exception_ptr error;
};

class PieceReader {
 public:
  PieceReader(const Source& source, Piece& piece, std::optional<Limits> limits = {})
      : source_(source), piece_(piece), limits_(limits), p_(piece.begin), end_(piece.end) {}

  void read() {
    while (p_ < end_) {
      while (p_ < end_ && is_blank(*p_)) ++p_;
      if (end_ - p_ >= 2 && is_blank(p_[1])) {
        if (*p_ == 'v') {
          ++p_;
          read_vertex();
        } else if (*p_ == 'f') {
          ++p_;
          read_face();
        }
      }
      p_ = next_line(p_, end_);
    }
  }

 private:
  /// Skips blanks and continued line ends (backslash, newline); false at the end of the statement.
  bool next_word() {
    while (p_ < end_) {
      if (is_blank(*p_)) {
        ++p_;
      } else if (*p_ == '\\') {
        const char* q = p_ + 1;
        while (q < end_ && is_blank(*q)) ++q;
        if (q == end_ || *q != '\n') return true;
        p_ = q + 1;
      } else {
        return *p_ != '\n' && *p_ != '#';
      }
    }
    return false;
  }
  bool at_word_end() const { return p_ == end_ || is_blank(*p_) || *p_ == '\n' || *p_ == '#' || *p_ == '\\'; }

  void read_vertex() {
    Vec3 v;
    for (int a = 0; a < 3; ++a) {
      const char* from = (next_word(), p_);
      if (!scan_number(p_, end_, v[a]) || !at_word_end()) {
        fail_at(source_, from, fmt::format("expected a coordinate of the vertex, found {}", found_at(source_, from)));
      }
    }
    piece_.vertices.push_back(v);
  }

  void read_face() {
    std::uint32_t first = 0, previous = 0;
    bool first_relative = false, previous_relative = false;
    const std::size_t begin = piece_.triangles.size();
    for (std::size_t count = 0; next_word(); ++count) {
      bool relative = false;
      const std::uint32_t current = read_corner(relative);
      if (count == 0) {
        first = current;
        first_relative = relative;
      }
      if (count >= 2) {
        const std::size_t corner = 3 * piece_.triangles.size();
        piece_.triangles.push_back({first, previous, current});
        if (first_relative) piece_.relative.push_back(corner);
        if (previous_relative) piece_.relative.push_back(corner + 1);
        if (relative) piece_.relative.push_back(corner + 2);
      }
      previous = current;
      previous_relative = relative;
    }
    if (const std::size_t made = piece_.triangles.size() - begin; made > 1) piece_.fans.push_back({begin, made});
  }

  /// "7", "7/1", "7//2", "7/1/2"; negative numbers count back from the last vertex before the statement.
  std::uint32_t read_corner(bool& relative) {
    const char* from = p_;
    std::int64_t index = 0;
    if (!scan_integer(p_, end_, index) || !(at_word_end() || *p_ == '/')) {
      fail_at(source_, from, fmt::format("expected a vertex index, found {}", found_at(source_, from)));
    }
    while (!at_word_end()) ++p_;
    if (index == 0) fail_at(source_, from, "vertex index 0; OBJ files count from 1, negative ones from the end");
    relative = index < 0;
    const auto here = static_cast<std::int64_t>(piece_.vertices.size());
    if (limits_) {
      const auto before = static_cast<std::int64_t>(limits_->before);
      const bool valid = relative ? before + here + index >= 0 : static_cast<std::uint64_t>(index) <= limits_->total;
      if (!valid) out_of_range(from, index, relative ? limits_->before + piece_.vertices.size() : limits_->total);
    }
    const bool representable = index > -static_cast<std::int64_t>(max_vertices) && index < std::int64_t{0xffffffff};
    if (!representable) relative = false;
    if (!representable) return 0xffffffff;
    return static_cast<std::uint32_t>(relative ? here + index : index - 1);
  }

  [[noreturn]] void out_of_range(const char* from, std::int64_t index, std::uint64_t count) const {
    fail_at(source_, from,
            fmt::format("vertex index {} is out of range ({} {} vertices)", index,
                        index < 0 ? "before this line there are" : "the file has", count));
  }

  const Source& source_;
  Piece& piece_;
  std::optional<Limits> limits_;
  const char* p_;
  const char* end_;
};

/// Cuts at line ends that no backslash continues.
std::vector<Piece> cut(std::string_view bytes) {
  std::vector<Piece> pieces;
  const char* end = bytes.data() + bytes.size();
  for (const char* at = bytes.data(); at < end;) {
    const char* stop = static_cast<std::size_t>(end - at) <= piece_size ? end : next_line(at + piece_size, end);
    const auto continued = [&] {
      const char* q = stop - 1;
      while (q > at && (is_blank(q[-1]))) --q;
      return stop < end && q > at && q[-1] == '\\';
    };
    while (continued()) stop = next_line(stop, end);
    pieces.emplace_back();
    pieces.back().begin = at;
    pieces.back().end = stop;
    at = stop;
  }
  return pieces;
}

/// Reads the piece once more, now that the counts are known, to find the statement at fault.
[[noreturn]] void report_range(const Source& source, const Piece& piece, const Limits& limits) {
  Piece again;
  again.begin = piece.begin;
  again.end = piece.end;
  PieceReader(source, again, limits).read();
  fail(source, "a vertex index is out of range");
}

/// Turns relative indices into absolute ones; true if all are in range.
bool resolve(Piece& piece, const Limits& limits) {
  for (const std::size_t corner : piece.relative) {
    piece.triangles[corner / 3][corner % 3] += static_cast<std::uint32_t>(limits.before);
  }
  std::uint32_t largest = 0;
  for (const Triangle& t : piece.triangles) largest = std::max({largest, t[0], t[1], t[2]});
  return piece.triangles.empty() || largest < limits.total;
}

Mesh join(const Source& source, std::vector<Piece>& pieces) {
  std::vector<Limits> limits(pieces.size() + 1);
  std::vector<std::size_t> triangles(pieces.size() + 1);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    limits[i + 1].before = limits[i].before + pieces[i].vertices.size();
    triangles[i + 1] = triangles[i] + pieces[i].triangles.size();
  }
  const std::uint64_t total = limits.back().before;
  if (total > max_vertices) fail(source, "has more than 2,147,483,648 vertices; split it");
  std::vector<char> valid(pieces.size());
  parallel_tasks(*source.context, pieces.size(), [&](std::size_t i) {
    limits[i].total = total;
    valid[i] = resolve(pieces[i], limits[i]);
  });
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!valid[i]) report_range(source, pieces[i], limits[i]);
  }
  Mesh mesh;
  if (pieces.size() == 1) {
    mesh = {std::move(pieces[0].vertices), std::move(pieces[0].triangles)};
    mend_fans(source, pieces[0].fans, mesh);
    return mesh;
  }
  mesh.vertices.resize(total);
  mesh.triangles.resize(triangles.back());
  parallel_tasks(*source.context, pieces.size(), [&](std::size_t i) {
    std::copy(pieces[i].vertices.begin(), pieces[i].vertices.end(), mesh.vertices.data() + limits[i].before);
    std::copy(pieces[i].triangles.begin(), pieces[i].triangles.end(), mesh.triangles.data() + triangles[i]);
  });
  std::vector<Fan> fans;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (const Fan& fan : pieces[i].fans) fans.push_back({triangles[i] + fan.first, fan.count});
  mend_fans(source, fans, mesh);
  return mesh;
}

}  // namespace

Mesh read_obj(const Source& original) {
  std::string storage;
  const Source source = original.with(with_unix_lines(original.bytes, storage));
  std::vector<Piece> pieces = cut(source.bytes);
  parallel_tasks(*source.context, pieces.size(), [&](std::size_t i) {
    try {
      PieceReader(source, pieces[i]).read();
    } catch (const UnusableInput&) {
      pieces[i].error = std::current_exception();  // the first in the file is told, whichever thread was first
    }
  });
  for (const Piece& piece : pieces) {
    if (piece.error) std::rethrow_exception(piece.error);
  }
  return join(source, pieces);
}

PointCloud obj_points(const Source& original, std::vector<Vec3> vertices) {
  std::string storage;
  const Source source = original.with(with_unix_lines(original.bytes, storage));
  PointCloud cloud{std::move(vertices), {}};
  for (const char* p = source.begin(); p < source.end(); p = next_line(p, source.end())) {
    while (p < source.end() && is_blank(*p)) ++p;
    const char* from = p;
    while (p < source.end() && !is_blank(*p) && *p != '\n') ++p;
    const std::string_view word(from, static_cast<std::size_t>(p - from));
    if (word == "f") fail_at(source, from, "holds no triangles; its faces have fewer than three corners");
    if (word == "l" || word == "curv" || word == "surf")
      fail_at(source, from, "holds lines or curves, but no faces; export it as a mesh, or its points as XYZ");
    if (word != "vn") continue;
    Vec3 n;
    for (int a = 0; a < 3; ++a) {
      while (p < source.end() && is_blank(*p)) ++p;
      if (!scan_number(p, source.end(), n[a])) n = {};
    }
    cloud.normals.push_back(n);
  }
  if (cloud.normals.size() != cloud.points.size()) cloud.normals.clear();
  return cloud;
}

std::string write_obj(const Mesh& mesh) {
  std::string text;
  const bool single = fits_single_precision(mesh);
  text.reserve((single ? 32 : 60) * mesh.vertices.size() + 24 * mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) {
    text += 'v';
    for (int a = 0; a < 3; ++a) append_coordinate(text += ' ', v[a], single);
    text += '\n';
  }
  for (const Triangle& t : mesh.triangles) {
    text += 'f';
    for (const std::uint32_t v : t) append_number(text += ' ', std::uint64_t{v} + 1);
    text += '\n';
  }
  return text;
}

}  // namespace evenmesh
