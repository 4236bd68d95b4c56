/// PLY, the Polygon File Format (Turk, Stanford 1994): ascii and binary of both byte orders, any elements and
/// properties.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "core/parallel.h"
#include "geometry/single_precision.h"
#include "io/binary.h"
#include "io/formats.h"
#include "io/ply_header.h"
#include "io/polygons.h"
#include "io/text.h"

namespace evenmesh {
namespace {

using namespace ply;

// ---- Values of the body: ascii or binary, one after the other
// -----------------------------------------------------------

class AsciiValues {
 public:
  AsciiValues(const Source& source, const char* at) : source_(source), at_(at) {}

  double number(Type) {
    skip_space();
    double value = 0;
    const char* from = at_;
    if (!scan_number(at_, source_.end(), value) || !at_delimiter()) wrong(from, "a number");
    return value;
  }
  std::int64_t integer(Type) {
    skip_space();
    std::int64_t value = 0;
    const char* from = at_;
    if (!scan_integer(at_, source_.end(), value) || !at_delimiter()) wrong(from, "a whole number");
    return value;
  }
  void skip(Type, std::uint64_t count) {
    for (; count > 0; --count) {
      skip_space();
      if (at_ == source_.end()) wrong(at_, "a value");
      while (!at_delimiter()) ++at_;
    }
  }
  [[noreturn]] void refuse(std::string_view what) const { fail_at(source_, at_, what); }
  std::size_t left() const { return static_cast<std::size_t>(source_.end() - at_); }
  static std::size_t min_size(Type) { return 1; }

 private:
  void skip_space() {
    while (at_ != source_.end() && (is_blank(*at_) || *at_ == '\n')) ++at_;
  }
  bool at_delimiter() const { return at_ == source_.end() || is_blank(*at_) || *at_ == '\n'; }
  [[noreturn]] void wrong(const char* where, std::string_view expected) const {
    fail_at(source_, where, fmt::format("expected {}, found {}", expected, found_at(source_, where)));
  }

  const Source& source_;
  const char* at_;
};

class BinaryValues {
 public:
  BinaryValues(const Source& source, const char* at, bool swap) : source_(source), at_(at), swap_(swap) {}

  double number(Type type) { return decode(type, take(size_of(type)), swap_); }
  std::int64_t integer(Type type) { return static_cast<std::int64_t>(number(type)); }  // exact: 32 bits at most
  void skip(Type type, std::uint64_t count) {
    if (count > left() / size_of(type)) truncated();
    at_ += count * size_of(type);
  }
  const char* take(std::size_t size) {
    if (left() < size) truncated();
    const char* taken = at_;
    at_ += size;
    return taken;
  }
  [[noreturn]] void refuse(std::string_view what) const { fail(source_, what); }
  std::size_t left() const { return static_cast<std::size_t>(source_.end() - at_); }
  bool swap() const { return swap_; }
  static std::size_t min_size(Type type) { return size_of(type); }

  static double decode(Type type, const char* bytes, bool swap) {
    switch (type) {
      case Type::int8:
        return load<std::int8_t>(bytes);
      case Type::uint8:
        return load<std::uint8_t>(bytes);
      case Type::int16:
        return load<std::int16_t>(bytes, swap);
      case Type::uint16:
        return load<std::uint16_t>(bytes, swap);
      case Type::int32:
        return load<std::int32_t>(bytes, swap);
      case Type::uint32:
        return load<std::uint32_t>(bytes, swap);
      case Type::float32:
        return load<float>(bytes, swap);
      default:
        return load<double>(bytes, swap);
    }
  }

 private:
  [[noreturn]] void truncated() const { fail(source_, "ends before its last element; the file is truncated"); }

  const Source& source_;
  const char* at_;
  bool swap_;
};

// ---- Elements -------------------------------------------------------------------------------------------------------

template <typename Values>
class BodyReader {
 public:
  BodyReader(const Source& source, const Header& header, Values values)
      : source_(source), header_(header), values_(std::move(values)) {}

  PlyContents read() {
    for (const Element& element : header_.elements) {
      if (element.name == "vertex") {
        if (vertices_known_) values_.refuse("has two 'vertex' elements");
        vertex_count_ = element.count;
        vertices_known_ = true;
      } else if (is_surface(element)) {
        faces_announced_ = faces_announced_ || element.count > 0;
      }
    }
    if (!vertices_known_) fail(source_, "has no 'vertex' element; export the file again, as a mesh");
    for (const Element& element : header_.elements) {
      check_size(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (is_surface(element)) {
        read_faces(element);
      } else {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) skip_row(element, 0);
      }
    }
    mend_fans(source_, fans_, mesh_);
    return {std::move(mesh_), std::move(normals_)};
  }

 private:
  using Columns = std::array<std::size_t, 3>;  ///< places of three properties in their element

  static bool is_surface(const Element& element) { return element.name == "face" || element.name == "tristrips"; }

  /// Counts are checked against the bytes that are left before anything is allocated.
  void check_size(const Element& element) const {
    std::uint64_t row = 0;
    for (const Property& p : element.properties) row += Values::min_size(p.count_type.value_or(p.type));
    if (row > 0 && element.count > values_.left() / row) {
      values_.refuse(fmt::format("announces {} elements '{}', but only {} bytes are left; the file is truncated",
                                 element.count, element.name, values_.left()));
    }
  }

  void skip_property(const Property& p) {
    if (!p.count_type) return values_.skip(p.type, 1);
    const std::int64_t count = values_.integer(*p.count_type);
    if (count < 0) values_.refuse("has a list of negative length");
    values_.skip(p.type, static_cast<std::uint64_t>(count));
  }
  void skip_row(const Element& element, std::size_t first) {
    for (std::size_t i = first; i < element.properties.size(); ++i) skip_property(element.properties[i]);
  }

  /// The place of a property that is one number, or none.
  static std::optional<std::size_t> find_number(const Element& element, std::string_view name) {
    const auto p = std::find_if(element.properties.begin(), element.properties.end(),
                                [&](const Property& candidate) { return candidate.name == name; });
    if (p == element.properties.end() || p->count_type) return {};
    return static_cast<std::size_t>(p - element.properties.begin());
  }
  Columns coordinate_columns(const Element& element) const {
    Columns columns{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::string name(1, "xyz"[a]);
      const auto found = find_number(element, name);
      if (!found) {
        fail(source_, fmt::format("its vertices have no property '{}'; export the file again, with positions", name));
      }
      columns[a] = *found;
    }
    return columns;
  }
  static std::optional<Columns> normal_columns(const Element& element) {
    const auto x = find_number(element, "nx"), y = find_number(element, "ny"), z = find_number(element, "nz");
    if (!x || !y || !z) return {};
    return Columns{*x, *y, *z};
  }

  void read_vertices(const Element& element) {
    if (element.count > max_vertices) values_.refuse("has more than 4,294,967,295 vertices; split it");
    const Columns xyz = coordinate_columns(element);
    const std::optional<Columns> normal = faces_announced_ ? std::nullopt : normal_columns(element);
    mesh_.vertices.resize(element.count);
    if (normal) normals_.resize(element.count);
    if constexpr (std::is_same_v<Values, BinaryValues>) {
      if (!element.has_lists()) {
        const char* rows = values_.take(element.count * place_of(element, element.properties.size()));
        read_fixed_columns(element, rows, xyz, mesh_.vertices);
        if (normal) read_fixed_columns(element, rows, *normal, normals_);
        return;
      }
    }
    for (std::size_t v = 0; v < element.count; ++v) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const auto axis = std::find(xyz.begin(), xyz.end(), i) - xyz.begin();
        const auto normal_axis = normal ? std::find(normal->begin(), normal->end(), i) - normal->begin() : 3;
        if (axis < 3) {
          mesh_.vertices[v][static_cast<int>(axis)] = values_.number(element.properties[i].type);
        } else if (normal_axis < 3) {
          normals_[v][static_cast<int>(normal_axis)] = values_.number(element.properties[i].type);
        } else {
          skip_property(element.properties[i]);
        }
      }
    }
  }

  /// Bytes in front of a property in a row without lists.
  static std::size_t place_of(const Element& element, std::size_t property) {
    std::size_t place = 0;
    for (std::size_t i = 0; i < property; ++i) place += size_of(element.properties[i].type);
    return place;
  }

  /// Rows of one size, in parallel.
  void read_fixed_columns(const Element& element, const char* rows, const Columns& columns,
                          std::vector<Vec3>& vectors) const {
    std::array<std::size_t, 3> offset{};
    std::array<Type, 3> type{};
    for (std::size_t a = 0; a < 3; ++a) {
      offset[a] = place_of(element, columns[a]);
      type[a] = element.properties[columns[a]].type;
    }
    const std::size_t stride = place_of(element, element.properties.size());
    const bool swap = values_.swap();
    const bool plain = !swap && std::all_of(type.begin(), type.end(), [](Type t) { return t == Type::float32; });
    parallel_for(*source_.context, vectors.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const char* row = rows + i * stride;
        if (plain) {
          vectors[i] = {load<float>(row + offset[0]), load<float>(row + offset[1]), load<float>(row + offset[2])};
        } else {
          vectors[i] = {BinaryValues::decode(type[0], row + offset[0], swap),
                        BinaryValues::decode(type[1], row + offset[1], swap),
                        BinaryValues::decode(type[2], row + offset[2], swap)};
        }
      }
    });
  }

  std::uint32_t checked_index(std::int64_t index) const {
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
      values_.refuse(fmt::format("vertex index {} is out of range (the file has {} vertices)", index, vertex_count_));
    }
    return static_cast<std::uint32_t>(index);
  }

  void read_faces(const Element& element) {
    std::size_t list = 0;
    while (list < element.properties.size() && element.properties[list].name != "vertex_indices" &&
           element.properties[list].name != "vertex_index") {
      ++list;
    }
    if (element.count == 0) return;
    if (list == element.properties.size()) fail(source_, "its faces have no property 'vertex_indices'");
    const Property& p = element.properties[list];
    if (!p.count_type || !is_integer(p.type)) fail(source_, "'vertex_indices' must be a list of whole numbers");
    mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
    const bool strips = element.name == "tristrips";
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % (1 << 16) == 0) source_.context->throw_if_cancelled();
      if constexpr (std::is_same_v<Values, BinaryValues>) {
        if (!strips && element.properties.size() == 1 && read_plain_triangle(p)) continue;
      }
      for (std::size_t k = 0; k < list; ++k) skip_property(element.properties[k]);
      const std::int64_t count = values_.integer(*p.count_type);
      if (count < 0) values_.refuse("has a list of negative length");
      strips ? read_strip(p.type, count) : read_polygon(p.type, count);
      skip_row(element, list + 1);
    }
  }

  /// The common row — one byte 3, then three 32-bit indices — without a decision per value.
  bool read_plain_triangle(const Property& p) {
    if (size_of(*p.count_type) != 1 || size_of(p.type) != 4 || values_.swap() || values_.left() < 13) return false;
    BinaryValues row = values_;
    const char* bytes = row.take(13);
    if (bytes[0] != 3) return false;
    const Triangle t{load<std::uint32_t>(bytes + 1), load<std::uint32_t>(bytes + 5), load<std::uint32_t>(bytes + 9)};
    if (std::max({t[0], t[1], t[2]}) >= vertex_count_) return false;  // the general way finds the words for it
    mesh_.triangles.push_back(t);
    values_.take(13);
    return true;
  }

  void read_polygon(Type type, std::int64_t count) {
    if (count > 3) fans_.push_back({mesh_.triangles.size(), static_cast<std::size_t>(count) - 2});
    append_fan(mesh_.triangles, static_cast<std::uint64_t>(count),
               [&] { return checked_index(values_.integer(type)); });
  }

  void read_strip(Type type, std::int64_t count) {
    StripCursor strip;
    for (; count > 0; --count) {
      const std::int64_t index = values_.integer(type);
      if (index == -1) {
        strip.restart();
      } else {
        strip.add(checked_index(index), mesh_.triangles);
      }
    }
  }

  const Source& source_;
  const Header& header_;
  Values values_;
  Mesh mesh_;
  std::vector<Fan> fans_;
  std::vector<Vec3> normals_;
  std::uint64_t vertex_count_ = 0;
  bool vertices_known_ = false, faces_announced_ = false;
};

}  // namespace

PlyContents read_ply(const Source& source) {
  const Header header = parse_header(source);
  if (header.encoding == Encoding::ascii) {
    return BodyReader(source, header, AsciiValues(source, header.body)).read();
  }
  const bool swap = header.encoding == Encoding::big_endian;
  return BodyReader(source, header, BinaryValues(source, header.body, swap)).read();
}

std::string write_ply(const Mesh& mesh) {
  const bool single = fits_single_precision(mesh);
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {0}\nproperty {2} x\nproperty {2} y\nproperty {2} z\n"
      "element face {1}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size(), single ? "float" : "double");
  ByteWriter out(header.size() + (single ? 12 : 24) * mesh.vertices.size() + 13 * mesh.triangles.size());
  out.put(header);
  for (const Vec3& v : mesh.vertices) {
    for (int a = 0; a < 3; ++a) single ? out.put(static_cast<float>(v[a])) : out.put(v[a]);
  }
  for (const Triangle& t : mesh.triangles) {
    out.put(std::uint8_t{3});
    for (const std::uint32_t v : t) out.put(v);
  }
  return out.take();
}

}  // namespace evenmesh
