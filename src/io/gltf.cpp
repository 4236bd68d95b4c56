/// glTF 2.0 (Khronos; ISO/IEC 12113): GLB and .gltf with embedded buffers. Triangles, strips and fans of the scene's
/// nodes, placed; materials, skins, morphs and animations are passed over.
///
/// The reader is small and its own because tinygltf 2.7 lets exceptions of the standard library escape on damaged files
/// and leaves every bound of the data to its caller.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "geometry/single_precision.h"
#include "io/affine.h"
#include "io/binary.h"
#include "io/formats.h"
#include "io/gltf_data.h"
#include "io/weld.h"

namespace evenmesh {
namespace {

enum class Mode { triangles = 4, strip = 5, fan = 6 };

class SceneReader {
 public:
  explicit SceneReader(const Source& source) : source_(source), data_(source), budget_(source) {}

  Mesh read() {
    const Json& nodes = data_.list("nodes");
    if (nodes.empty()) {
      for (std::size_t i = 0; i < data_.list("meshes").size(); ++i) place(i, {});
    } else {
      walk(roots(nodes), nodes);
    }
    mesh_.unit = LengthUnit::meter;  // by definition (glTF 2.0, §3.4)
    return std::move(mesh_);
  }

 private:
  struct Visit {
    std::size_t node = 0, depth = 0;
    PartPlacement outer;
  };

  /// Nodes of the default scene; without scenes, all nodes that are nobody's child.
  std::vector<std::size_t> roots(const Json& nodes) const {
    const Json& scenes = data_.list("scenes");
    if (!scenes.empty()) {
      const std::size_t scene = data_.index(data_.root(), "scene", scenes.size()).value_or(0);
      return data_.indices(scenes[scene], "nodes", nodes.size());
    }
    std::vector<char> child(nodes.size());
    for (const Json& node : nodes) {
      for (const std::size_t i : data_.indices(node, "children", nodes.size())) child[i] = 1;
    }
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!child[i]) found.push_back(i);
    }
    return found;
  }

  /// Depth first, in the order of the file.
  void walk(const std::vector<std::size_t>& from, const Json& nodes) {
    std::vector<Visit> stack;
    const auto push = [&](const std::vector<std::size_t>& children, std::size_t depth, const PartPlacement& outer) {
      budget_.spend(InstanceBudget::visit * children.size());
      for (auto child = children.rbegin(); child != children.rend(); ++child) stack.push_back({*child, depth, outer});
    };
    push(from, 0, {});
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      if (visit.depth > nodes.size()) fail(source_, "has nodes that are children of themselves; export the file again");
      const Json& node = nodes[visit.node];
      const PartPlacement placement = visit.outer * local_placement(node);
      if (const auto mesh = data_.index(node, "mesh", data_.list("meshes").size())) place(*mesh, placement);
      push(data_.indices(node, "children", nodes.size()), visit.depth + 1, placement);
    }
  }

  PartPlacement local_placement(const Json& node) const {
    if (node.contains("matrix")) {
      const auto m = data_.numbers<16>(node, "matrix", {});
      return {{Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
    }
    const auto t = data_.numbers<3>(node, "translation", {0, 0, 0});
    const auto s = data_.numbers<3>(node, "scale", {1, 1, 1});
    const auto q = data_.numbers<4>(node, "rotation", {0, 0, 0, 1});
    const double squared = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const double f = squared > 0 ? 2 / squared : 0;  // divides by |q|², as files hold rounded quaternions
    const double xx = f * q[0] * q[0], yy = f * q[1] * q[1], zz = f * q[2] * q[2], xy = f * q[0] * q[1];
    const double xz = f * q[0] * q[2], yz = f * q[1] * q[2], wx = f * q[3] * q[0], wy = f * q[3] * q[1];
    const double wz = f * q[3] * q[2];
    return {{s[0] * Vec3{1 - yy - zz, xy + wz, xz - wy}, s[1] * Vec3{xy - wz, 1 - xx - zz, yz + wx},
             s[2] * Vec3{xz + wy, yz - wx, 1 - xx - yy}},
            {t[0], t[1], t[2]}};
  }

  /// Primitives that share positions share vertices.
  void place(std::size_t mesh, const PartPlacement& placement) {
    std::map<std::size_t, std::uint32_t> base_of_accessor;
    for (const Json& primitive : data_.list_in(data_.list("meshes")[mesh], "primitives")) {
      source_.context->throw_if_cancelled();
      budget_.spend(InstanceBudget::visit);
      const std::size_t mode = data_.index(primitive, "mode", 7).value_or(4);
      if (mode < 4) continue;  // points and lines
      if (!primitive.contains("attributes")) continue;
      const auto position = data_.index(primitive["attributes"], "POSITION", data_.list("accessors").size());
      if (!position) continue;
      const auto indices = data_.index(primitive, "indices", data_.list("accessors").size());
      append(*position, indices, static_cast<Mode>(mode), placement, base_of_accessor);
    }
  }

  void append(std::size_t position, std::optional<std::size_t> indices, Mode mode, const PartPlacement& placement,
              std::map<std::size_t, std::uint32_t>& base_of_accessor) {
    const Accessor points = data_.positions(position);
    if (!indices && mode == Mode::triangles) {  // loose triangles, as in STL
      budget_.spend(2 * points.count);
      const Mesh part = weld(source_, points.count / 3, [&](std::size_t i) { return points.point(i); });
      return append_placed(source_, part, placement, mesh_);
    }
    auto base = base_of_accessor.find(position);
    if (base == base_of_accessor.end()) {
      budget_.spend(points.count);
      base = base_of_accessor.emplace(position, static_cast<std::uint32_t>(mesh_.vertices.size())).first;
      Mesh part;
      part.vertices.reserve(points.count);
      for (std::size_t i = 0; i < points.count; ++i) part.vertices.push_back(points.point(i));
      append_placed(source_, part, placement, mesh_);
    }
    const Accessor list = indices ? data_.indices_of(*indices) : Accessor{};
    const std::size_t corners = indices ? list.count : points.count;
    budget_.spend(corners);
    const std::size_t first = mesh_.triangles.size();
    std::size_t i = 0;
    const auto next = [&] {
      const std::uint64_t index = indices ? list.integer(i) : i;
      ++i;
      if (index >= points.count) {
        fail(source_, fmt::format("vertex index {} is out of range (accessor {} has {} vertices)", index, position,
                                  points.count));
      }
      return static_cast<std::uint32_t>(index) + base->second;
    };
    assemble(mode, corners, next);
    if (placement.mirrors()) {
      for (std::size_t k = first; k < mesh_.triangles.size(); ++k)
        std::swap(mesh_.triangles[k][1], mesh_.triangles[k][2]);
    }
  }

  template <typename Next>
  void assemble(Mode mode, std::size_t corners, const Next& next) {
    if (mode == Mode::fan) {
      append_fan(mesh_.triangles, corners, next);
    } else if (mode == Mode::strip) {
      StripCursor strip;
      for (std::size_t i = 0; i < corners; ++i) strip.add(next(), mesh_.triangles);
    } else {
      for (std::size_t i = 0; i + 2 < corners; i += 3) {
        const std::uint32_t a = next(), b = next(), c = next();
        mesh_.triangles.push_back({a, b, c});
      }
    }
  }

  const Source& source_;
  GltfData data_;
  InstanceBudget budget_;
  Mesh mesh_;
};

}  // namespace

Mesh read_gltf(const Source& source) {
  return SceneReader(source).read();
}

Vec3 gltf_translation(const Mesh& mesh) {
  return fits_single_precision(mesh) ? Vec3{} : mesh.bounds().center();
}

std::string write_gltf(const Mesh& mesh) {
  const Vec3 origin = gltf_translation(mesh);
  const bool moved = origin != Vec3{};
  Box box;
  for (const Vec3& v : mesh.vertices) box.add(v - origin);
  if (mesh.vertices.empty()) box.add({});
  const auto triple = [](const Vec3& v) {
    return fmt::format("[{},{},{}]", static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
  };
  const double scale = mesh.unit ? conversion_factor(*mesh.unit, LengthUnit::meter) : 1;
  const std::string scaling = scale == 1 ? "" : fmt::format(R"(,"scale":[{0},{0},{0}])", scale);
  const Vec3 to = scale * origin;
  const std::string shift = moved ? fmt::format(R"(,"translation":[{},{},{}])", to.x, to.y, to.z) : "";
  const std::size_t points = 12 * mesh.vertices.size(), indices = 12 * mesh.triangles.size();
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"evenmesh"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":4}}]}}],)"
      R"("buffers":[{{"byteLength":{}}}],"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{},"target":34963}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":{},"max":{}}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}]}})",
      scaling + shift, points + indices, points, points, indices, mesh.vertices.size(), triple(box.lo), triple(box.hi),
      3 * mesh.triangles.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + json.size() + 8 + points + indices;
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw UnusableInput("a GLB file of more than 4 GB cannot be written; use PLY");
  }
  ByteWriter out(size);
  out.put("glTF");
  out.put(std::uint32_t{2});
  out.put(static_cast<std::uint32_t>(size));
  out.put(static_cast<std::uint32_t>(json.size()));
  out.put("JSON");
  out.put(json);
  out.put(static_cast<std::uint32_t>(points + indices));
  out.put(std::string_view("BIN\0", 4));
  for (const Vec3& v : mesh.vertices) {
    for (int a = 0; a < 3; ++a) out.put(static_cast<float>(v[a] - origin[a]));
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) out.put(v);
  }
  return out.take();
}

}  // namespace evenmesh
