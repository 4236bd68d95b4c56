#pragma once
/// What every reader gets, and how it complains.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/findings.h"
#include "evenmesh/mesh.h"
#include "evenmesh/points.h"

namespace evenmesh {

/// Vertex counts stay below this, so that every index fits into 32 bits.
inline constexpr std::uint64_t max_vertices = 0xffffffffu;

/// The bytes of a file with the name that messages give it.
struct Source {
  std::string_view bytes;
  std::string_view name;
  ExecutionContext* context = nullptr;
  std::vector<Finding>* findings = nullptr;  ///< what there is to say of it; nullptr: nobody listens

  /// The same file, its bytes read otherwise.
  Source with(std::string_view other) const { return {other, name, context, findings}; }
  const char* begin() const { return bytes.data(); }
  const char* end() const { return bytes.data() + bytes.size(); }
};

/// Throws UnusableInput "name: what".
[[noreturn]] void fail(const Source& source, std::string_view what);
/// Throws UnusableInput "name: line N: what", N counted from 1 up to `where`.
[[noreturn]] void fail_at(const Source& source, const char* where, std::string_view what);
/// The blank-delimited word at `where`, in quotes, shortened and printable; or "the end of the file" or "… line".
std::string found_at(const Source& source, const char* where);
/// `text` in quotes, shortened and printable.
std::string quoted(std::string_view text);

/// Adds to the source's findings.
void remark(const Source& source, Finding finding);

/// Leaves out vertices that are not finite, and the triangles at them, or points; a finding tells how many.
void leave_out_infinite(const Source& source, Mesh& mesh);
void leave_out_infinite(const Source& source, PointCloud& cloud);
/// The finding of that. @param what  "vertex", "point", "triangle"
void remark_infinite(const Source& source, std::size_t count, std::string_view what, std::size_t triangles = 0);

/// Text files of old Macs end lines with \r alone; gives them \n. Otherwise returns `bytes` itself.
std::string_view with_unix_lines(std::string_view bytes, std::string& storage);

/// Bounds what instancing (nodes of a scene, components of an assembly) may multiply: a few bytes could otherwise stand
/// for more triangles than fit into any memory.
class InstanceBudget {
 public:
  /// A visit of a node costs as much as a few elements; in a file it takes more bytes than them, too.
  static constexpr std::uint64_t visit = 32;

  explicit InstanceBudget(const Source& source) : source_(source), left_(1'000'000 + 4 * source.bytes.size()) {}
  /// More bytes were unpacked; even without repetitions they may stand for more elements than the packed file has
  /// bytes.
  void add(std::uint64_t bytes) { left_ += bytes; }
  /// @param count  vertices and triangles about to be made, or `visit`
  void spend(std::uint64_t count);

 private:
  const Source& source_;
  std::uint64_t left_;
};

/// Appends a polygon as a fan around its first corner; next() gives corner after corner, `count` times. Polygons of
/// more than three are to be looked at again when all vertices are known (polygons.h).
template <typename Next>
void append_fan(std::vector<Triangle>& triangles, std::uint64_t count, const Next& next) {
  if (count == 0) return;
  const std::uint32_t first = next();
  if (count == 1) return;
  std::uint32_t previous = next();
  for (std::uint64_t i = 2; i < count; ++i) {
    const std::uint32_t current = next();
    triangles.push_back({first, previous, current});
    previous = current;
  }
}

/// Corners of a triangle strip, one by one; every second triangle is turned. Triangles with a repeated corner only join
/// pieces of a strip and are left out.
class StripCursor {
 public:
  void restart() { length_ = 0; }
  void add(std::uint32_t corner, std::vector<Triangle>& triangles) {
    if (length_ >= 2 && a_ != b_ && b_ != corner && corner != a_) {
      triangles.push_back(length_ % 2 == 0 ? Triangle{a_, b_, corner} : Triangle{b_, a_, corner});
    }
    a_ = b_;
    b_ = corner;
    ++length_;
  }

 private:
  std::uint32_t a_ = 0, b_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace evenmesh
