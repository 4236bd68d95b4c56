/// Scene files: recognition, limits, and the choice between the two readers.

#include "evenmesh/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <system_error>

#include "evenmesh/error.h"
#include "evenmesh/io.h"
#include "io/bytes.h"
#include "io/text.h"
#include "scene/csg_tree.h"
#include "scene/scene_loader.h"

namespace evenmesh {

namespace fs = std::filesystem;

namespace {

bool has_extension(std::string_view name, std::string_view extension) {
  return name.size() > extension.size() && equals_ignoring_case(name.substr(name.size() - extension.size()), extension);
}

[[noreturn]] void refuse_size(std::string_view name, std::uint64_t bytes, std::size_t limit) {
  throw UnusableInput(
      fmt::format("{}: has {} bytes, but a scene may have {} at most; move its meshes into files of "
                  "their own",
                  name, bytes, limit));
}

std::string_view without_byte_order_mark(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  return bytes;
}

}  // namespace

bool is_scene(std::string_view name, std::string_view first_bytes) {
  if (format_of_content(first_bytes)) return false;
  if (has_extension(name, ".csg") || has_extension(name, ".json") || has_extension(name, ".scad")) return true;
  std::string_view bytes = without_byte_order_mark(first_bytes);
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (begins_like_csg(bytes)) return !format_of_name(name);
  return bytes.starts_with('{') && format_of_name(name) != MeshFormat::glb;
}

Shape parse_scene(std::string_view bytes, std::string_view name, const fs::path& folder, ExecutionContext& context,
                  const SceneLimits& limits) {
  if (bytes.size() > limits.bytes) refuse_size(name, bytes.size(), limits.bytes);
  const Source source{without_byte_order_mark(bytes), name, &context};
  if (source.bytes.empty()) fail(source, "is empty; export it again");
  if (has_extension(name, ".scad")) {
    fail(source, "is a program of OpenSCAD, which has to be evaluated first: openscad -o x.csg x.scad");
  }
  const bool csg = has_extension(name, ".csg") || (!has_extension(name, ".json") && begins_like_csg(source.bytes));
  try {
    SceneLoader loader(folder, limits, context);
    Shape scene = csg ? read_csg_scene(source, loader, limits) : read_json_scene(source, loader, limits);
    scene.unit = loader.unit();
    return scene;
  } catch (const std::bad_alloc&) {
    fail(source, "does not fit into the memory; reduce it or use a larger machine");
  }
}

Shape read_scene(const fs::path& path, ExecutionContext& context) {
  context.throw_if_cancelled();
  const std::string name = name_of_input(path);
  const SceneLimits limits;
  std::error_code unknown;  // of pipes; they are measured when they are read
  if (path != "-" && fs::is_regular_file(path, unknown)) {
    const std::uintmax_t bytes = fs::file_size(path, unknown);
    if (!unknown && bytes > limits.bytes) refuse_size(name, bytes, limits.bytes);
  }
  const FileBytes bytes = load_file(path);
  return parse_scene(bytes.view(), name, path == "-" ? fs::path() : path.parent_path(), context, limits);
}

Shape read_glsl(const fs::path& path, const GlslOptions& options) {
  return shape_from_glsl(std::string(load_file(path).view()), options, name_of_input(path));
}

Shape read_raster(const fs::path& vertex, const fs::path& fragment, RasterOptions options, std::string name) {
  const auto read = [](const fs::path& path, std::string& text, std::string& title) {
    if (path.empty()) return;
    text = load_file(path).view();
    title = name_of_input(path);
    if (text.empty()) throw UnusableInput(title + ": is empty; give 'default' for the built-in shader");
  };
  read(vertex, options.vertex, options.vertex_name);
  read(fragment, options.fragment, options.fragment_name);
  return shape_from_raster(options, std::move(name));
}

}  // namespace evenmesh
