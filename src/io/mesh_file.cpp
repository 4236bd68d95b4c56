/// Reading and writing meshes, reading points: recognition, checks, and the choice among the formats.

#include <fmt/format.h>

#include <new>
#include <stdexcept>
#include <variant>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "geometry/single_precision.h"
#include "io/bytes.h"
#include "io/formats.h"
#include "io/text.h"

namespace evenmesh {
namespace {

using MeshOrPoints = std::variant<Mesh, PointCloud>;

Mesh read_as(MeshFormat format, const Source& source) {
  switch (format) {
    case MeshFormat::ply:
      return read_ply(source).mesh;
    case MeshFormat::obj:
      return read_obj(source);
    case MeshFormat::stl:
      return read_stl(source);
    case MeshFormat::off:
      return read_off(source);
    case MeshFormat::glb:
      return read_gltf(source);
    case MeshFormat::threemf:
      return read_threemf(source);
  }
  throw InvalidInput("the mesh format is none of the six; take one of MeshFormat");
}

/// Points that are not finite are left out. Normals that are not say nothing and become zero; where all are, there are
/// none.
PointCloud checked(const Source& source, PointCloud cloud) {
  leave_out_infinite(source, cloud);
  if (cloud.points.empty()) fail(source, "holds no point whose coordinates are all finite numbers; export it again");
  bool any = false;
  for (Vec3& n : cloud.normals) {
    if (!is_finite(n)) n = {};
    any = any || n != Vec3{};
  }
  if (!any) cloud.normals.clear();
  return cloud;
}

MeshOrPoints read_mesh_format(MeshFormat format, const Source& source) {
  Mesh mesh = read_as(format, source);
  if (mesh.triangles.empty() && !mesh.vertices.empty()) {
    if (format == MeshFormat::off) return checked(source, {std::move(mesh.vertices), {}});
    if (format == MeshFormat::obj) return checked(source, obj_points(source, std::move(mesh.vertices)));
  }
  // Of loose triangles the reader has left out some already.
  const bool any = !mesh.triangles.empty() || !source.findings->empty();
  leave_out_infinite(source, mesh);
  if (!mesh.triangles.empty()) return mesh;
  if (any) fail(source, "holds no triangle whose coordinates are all finite numbers; export the file again");
  if (mesh.vertices.empty()) fail(source, "holds no triangles; export the file again, with its faces");
  fail(source, fmt::format("holds no triangles, only {} points; export the file again, with its faces, or its points "
                           "as PLY or XYZ",
                           mesh.vertices.size()));
}

MeshOrPoints read_ply_file(const Source& source) {
  PlyContents contents = read_ply(source);
  if (!contents.mesh.triangles.empty()) {
    leave_out_infinite(source, contents.mesh);
    if (contents.mesh.triangles.empty())
      fail(source, "holds no triangle whose coordinates are all finite numbers; export the file again");
    return std::move(contents.mesh);
  }
  if (contents.mesh.vertices.empty()) fail(source, "holds no triangles and no points; export the file again");
  return checked(source, {std::move(contents.mesh.vertices), std::move(contents.normals)});
}

/// Tables of numbers tell little, so that the name has a say, too: OFF without its first word is one as well.
bool is_point_file(const Source& source) {
  return is_point_name(source.name) || (format_of_name(source.name) != MeshFormat::off && is_point_text(source.bytes));
}

MeshOrPoints read_recognized(const Source& source) {
  std::optional<MeshFormat> format = format_of_content(source.bytes);
  if (!format && is_dexel_file(source.bytes)) {
    fail(source, "holds dexels, not a mesh; make a mesh of it first, or name it under 'dexels' in a scene");
  }
  if (is_pcd(source.bytes)) return checked(source, read_pcd(source));
  if (!format && is_point_file(source)) return checked(source, read_point_text(source));
  if (!format) format = format_of_name(source.name);
  if (!format) {
    fail(source,
         "is no file of a mesh or points that can be recognized; PLY, OBJ, STL, OFF, GLB, glTF, 3MF, XYZ, PTS, "
         "PWN and PCD can be read");
  }
  return format == MeshFormat::ply ? read_ply_file(source) : read_mesh_format(*format, source);
}

FileContents parse(Source source) {
  FileContents contents;
  source.findings = &contents.findings;
  if (source.bytes.starts_with("\xef\xbb\xbf")) source.bytes.remove_prefix(3);  // byte order mark of UTF-8
  if (source.bytes.empty()) fail(source, "is empty; export it again");
  try {
    contents.what = read_recognized(source);
    return contents;
  } catch (const std::bad_alloc&) {
    fail(source, "does not fit into the memory; reduce it or use a larger machine");
  }
}

FileContents load(const std::filesystem::path& path, ExecutionContext& context) {
  context.throw_if_cancelled();
  const std::string name = name_of_input(path);
  try {
    const FileBytes bytes = load_file(path);
    context.throw_if_cancelled();
    return with_threads(context, [&] { return parse({bytes.view(), name, &context}); });
  } catch (const std::bad_alloc&) {
    throw UnusableInput(name + ": does not fit into the memory; reduce it or use a larger machine");
  }
}

Mesh mesh_of(FileContents contents, std::string_view name) {
  if (Mesh* mesh = std::get_if<Mesh>(&contents.what)) return std::move(*mesh);
  throw UnusableInput(fmt::format("{}: holds no triangles, only {} points; export the file again, with its faces", name,
                                  std::get<PointCloud>(contents.what).points.size()));
}

PointCloud points_of(FileContents contents, std::string_view name) {
  if (PointCloud* cloud = std::get_if<PointCloud>(&contents.what)) return std::move(*cloud);
  throw UnusableInput(
      fmt::format("{}: holds a mesh, not points; save its vertices as XYZ, or as PLY without faces", name));
}

/// All formats hold 32-bit floats: coordinates that overflow one would come back as infinity.
void require_writable(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& v = mesh.vertices[i];
    for (int a = 0; a < 3; ++a) {
      if (std::isfinite(static_cast<float>(v[a]))) continue;
      throw InvalidInput(fmt::format(
          "vertex {} cannot be written: its coordinate {} does not fit into a 32-bit float; scale the mesh down", i,
          v[a]));
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      if (v < mesh.vertices.size()) continue;
      throw InvalidInput(fmt::format("triangle {} cannot be written: it refers to vertex {}, but there are {}", i, v,
                                     mesh.vertices.size()));
    }
  }
}

}  // namespace

Mesh parse_mesh(std::string_view bytes, std::string_view name) {
  return mesh_of(parse({bytes, name, &ExecutionContext::silent()}), name);
}

Mesh read_mesh(const std::filesystem::path& path, ExecutionContext& context) {
  return mesh_of(load(path, context), name_of_input(path));
}

PointCloud parse_points(std::string_view bytes, std::string_view name) {
  return points_of(parse({bytes, name, &ExecutionContext::silent()}), name);
}

PointCloud read_points(const std::filesystem::path& path, ExecutionContext& context) {
  return points_of(load(path, context), name_of_input(path));
}

FileContents parse_mesh_or_points(std::string_view bytes, std::string_view name, ExecutionContext& context) {
  context.throw_if_cancelled();
  return with_threads(context, [&] { return parse({bytes, name, &context}); });
}

FileContents read_mesh_or_points(const std::filesystem::path& path, ExecutionContext& context) {
  return load(path, context);
}

std::optional<Finding> unit_remark(const Mesh& mesh, MeshFormat format) {
  if (!mesh.unit || format == MeshFormat::threemf) return {};
  const bool glb = format == MeshFormat::glb;
  const bool usual =
      *mesh.unit == LengthUnit::millimeter || (format != MeshFormat::stl && *mesh.unit == LengthUnit::meter);
  const std::string unit(plural_of(*mesh.unit));
  if (glb && *mesh.unit != LengthUnit::meter)
    return make_finding(FindingCode::unit_converted, {{"name", "GLB is in meters"},
                                                      {"from", unit},
                                                      {"to", "meters"},
                                                      {"factor", conversion_factor(*mesh.unit, LengthUnit::meter)}});
  if (glb || usual) return {};
  const char* name = format == MeshFormat::stl   ? "STL"
                     : format == MeshFormat::obj ? "OBJ"
                     : format == MeshFormat::ply ? "PLY"
                                                 : "OFF";
  return make_finding(FindingCode::unit_lost, {{"format", name}, {"unit", unit}, {"usual", "mm"}});
}

std::vector<Vec3> stored_vertices(const Mesh& mesh, MeshFormat format) {
  if (fits_single_precision(mesh)) return in_single_precision(mesh.vertices);
  std::vector<Vec3> vertices = mesh.vertices;
  if (format != MeshFormat::glb) return vertices;
  const Vec3 origin = gltf_translation(mesh);
  for (Vec3& v : vertices) v -= origin;
  vertices = in_single_precision(vertices);
  for (Vec3& v : vertices) v += origin;
  return vertices;
}

std::string serialize_mesh(const Mesh& mesh, MeshFormat format) {
  require_writable(mesh);
  switch (format) {
    case MeshFormat::ply:
      return write_ply(mesh);
    case MeshFormat::obj:
      return write_obj(mesh);
    case MeshFormat::stl:
      return write_stl(mesh);
    case MeshFormat::off:
      return write_off(mesh);
    case MeshFormat::glb:
      return write_gltf(mesh);
    case MeshFormat::threemf:
      return write_threemf(mesh);
  }
  throw InvalidInput("the mesh format is none of the six; take one of MeshFormat");
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, std::optional<MeshFormat> format) {
  const std::string name = path.string();
  if (!format) {
    format = format_of_name(name);
    if (format == MeshFormat::glb && !name.empty() && lower(name.back()) == 'f') {
      throw InvalidInput(fmt::format("{}: text glTF is not written; name it .glb", name));
    }
  }
  if (!format && path == "-") {
    throw InvalidInput("standard output has no extension to tell the format; name it: ply, obj, stl, off, glb or 3mf");
  }
  if (!format) {
    throw InvalidInput(
        fmt::format("{}: the extension does not tell the format; use .ply, .obj, .stl, .off, .glb or .3mf", name));
  }
  write_file(path, serialize_mesh(mesh, *format));
}

}  // namespace evenmesh
