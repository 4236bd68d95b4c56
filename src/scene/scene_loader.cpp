#include "scene/scene_loader.h"

#include <system_error>
#include <utility>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {

namespace fs = std::filesystem;

namespace {

/// In quotes, without what would confuse a terminal.
std::string shown(const fs::path& path) {
  std::string text = path.string();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  constexpr std::size_t longest = 200;  // the end tells more
  if (text.size() > longest) text = "…" + text.substr(text.size() - longest);
  return "'" + text + "'";
}

}  // namespace

fs::path SceneLoader::file(const std::string& name) const {
  if (name.empty() || name.find('\0') != std::string::npos) throw UnusableInput("needs the name of a file");
  const fs::path path = (folder_ / name).lexically_normal();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw UnusableInput("there is no file " + shown(path) + "; paths are relative to the folder of the scene");
  }
  // Pipes and devices could keep a reader waiting for ever.
  if (!fs::is_regular_file(status)) throw UnusableInput(shown(path) + " is not a regular file");
  return path;
}

template <typename Read>
Shape SceneLoader::once(std::map<fs::path, Shape>& known, const std::string& name, const Read& read) {
  const fs::path path = file(name);
  auto found = known.find(path);
  if (found == known.end()) found = known.emplace(path, read(path, path.filename().string())).first;
  return found->second;
}

Shape SceneLoader::in_scene_unit(Shape shape) {
  if (!unit_) unit_ = shape.unit;
  return unit_ ? converted(shape, *unit_) : shape;
}

Shape SceneLoader::mesh_file(const std::string& name) {
  return once(meshes_, name, [&](const fs::path& path, const std::string& title) {
    if (const std::string ending = path.extension().string(); ending == ".csg" || ending == ".json") {
      throw UnusableInput(title +
                          ": is a scene, not a mesh; copy what it holds into this one, or make a mesh of it first");
    }
    FileContents contents = read_mesh_or_points(path, context_);
    Mesh* mesh = std::get_if<Mesh>(&contents.what);
    if (mesh == nullptr) throw UnusableInput(title + ": holds points, not a mesh; name it under 'points'");
    Shape shape = shape_from_mesh(std::move(*mesh), title);
    shape.findings = std::move(contents.findings);
    return in_scene_unit(std::move(shape));
  });
}

Shape SceneLoader::point_file(const std::string& name) {
  return once(points_, name, [&](const fs::path& path, const std::string& title) {
    FileContents contents = read_mesh_or_points(path, context_);
    PointCloud* cloud = std::get_if<PointCloud>(&contents.what);
    if (cloud == nullptr) throw UnusableInput(title + ": holds a mesh, not points; name it under 'mesh'");
    Shape shape = shape_from_points(std::move(*cloud), title);
    shape.findings = std::move(contents.findings);
    return shape;
  });
}

Shape SceneLoader::dexel_file(const std::string& name) {
  return once(dexels_, name, [&](const fs::path& path, const std::string& title) {
    return shape_from_dexels(read_dexels(path, context_), title);
  });
}

Shape SceneLoader::shader_file(const std::string& name, const GlslOptions& options) const {
  return read_glsl(file(name), options);
}

Shape SceneLoader::raster_files(const std::string& vertex, const std::string& fragment, RasterOptions options) const {
  const auto path = [&](const std::string& name) { return name == "default" ? fs::path() : file(name); };
  return read_raster(path(vertex), path(fragment), std::move(options));
}

Shape SceneLoader::placed(const Shape& shape, const Affine* placement) {
  if (placement == nullptr) return shape;
  if (const Mesh* mesh = shape.mesh()) spend(mesh->triangles.size());
  if (const PointCloud* cloud = shape.points()) spend(cloud->points.size());
  return transformed(shape, *placement);
}

void SceneLoader::spend(std::uint64_t count) {
  if (count > left_) {
    throw UnusableInput("asks for more triangles than a scene may have (100,000,000); split it, or use fewer copies");
  }
  left_ -= count;
}

}  // namespace evenmesh
