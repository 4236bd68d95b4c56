/// Reading and writing meshes: recognition, checks, and the choice among the formats.

#include <fmt/format.h>

#include <new>
#include <stdexcept>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "io/bytes.h"
#include "io/formats.h"
#include "io/text.h"

namespace evenmesh {
namespace {

Mesh read_as(MeshFormat format, const Source& source) {
  switch (format) {
    case MeshFormat::ply:
      return read_ply(source);
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

Mesh parse(Source source) {
  if (source.bytes.starts_with("\xef\xbb\xbf")) source.bytes.remove_prefix(3);  // byte order mark of UTF-8
  if (source.bytes.empty()) fail(source, "is empty; export the mesh again");
  std::optional<MeshFormat> format = format_of_content(source.bytes);
  if (!format) format = format_of_name(source.name);
  if (!format) {
    fail(source, "is no mesh file that can be recognized; PLY, OBJ, STL, OFF, GLB, glTF and 3MF can be read");
  }
  Mesh mesh;
  try {
    mesh = read_as(*format, source);
  } catch (const std::bad_alloc&) {
    fail(source, "does not fit into the memory; reduce the mesh or use a larger machine");
  }
  if (mesh.triangles.empty() && !mesh.vertices.empty()) {
    fail(source, fmt::format("holds no triangles, only {} points; point clouds are not available in this version, "
                             "convert it to a mesh",
                             mesh.vertices.size()));
  }
  if (mesh.triangles.empty()) fail(source, "holds no triangles; export the file again, with its faces");
  return mesh;
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
  return parse({bytes, name, &Run::silent()});
}

Mesh read_mesh(const std::filesystem::path& path, Run& run) {
  run.throw_if_cancelled();
  const std::string name = name_of_input(path);
  try {
    const FileBytes bytes = load_file(path);
    run.throw_if_cancelled();
    return with_threads(run, [&] { return parse({bytes.view(), name, &run}); });
  } catch (const std::bad_alloc&) {
    throw UnusableInput(name + ": does not fit into the memory; reduce it or use a larger machine");
  }
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
