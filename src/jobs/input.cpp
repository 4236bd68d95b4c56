#include "evenmesh/input.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>
#include <utility>
#include <variant>

#include "evenmesh/error.h"
#include "evenmesh/glsl.h"
#include "evenmesh/io.h"
#include "evenmesh/raster.h"
#include "evenmesh/scene.h"
#include "evenmesh/solid.h"

namespace evenmesh {
namespace {

constexpr std::string_view gallery_prefix = "gallery:";
constexpr std::size_t head_size = 4096;

struct PlannedKind {
  std::string_view extension;
  std::string_view what;
};
constexpr std::array planned_kinds{
    PlannedKind{".vdb", "reading an OpenVDB volume"},
    PlannedKind{".nii", "reading a NIfTI volume"},
    PlannedKind{".nii.gz", "reading a NIfTI volume"},
    PlannedKind{".nrrd", "reading an NRRD volume"},
};

bool ends_with_ignoring_case(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() && std::equal(ending.rbegin(), ending.rend(), text.rbegin(), [](char a, char b) {
           return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b);
         });
}

const PlannedKind* planned_kind(std::string_view name) {
  const auto kind = std::find_if(planned_kinds.begin(), planned_kinds.end(),
                                 [&](const PlannedKind& k) { return ends_with_ignoring_case(name, k.extension); });
  return kind == planned_kinds.end() ? nullptr : &*kind;
}

/// The first bytes of a file, empty where there is none: whoever reads it says what is wrong with it.
std::string head_of(const std::string& name) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(name, unknown)) return "";
  std::ifstream file(name, std::ios::binary);
  std::string head(head_size, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

GlslOptions shader_options(const InputOptions& options) {
  return {.entry = options.entry,
          .definitions = options.definitions,
          .lipschitz = options.lipschitz,
          .level = options.level,
          .bounds = options.bounds,
          .device = options.device};
}

Shape shape_of(FileContents contents, const std::string& title) {
  auto* points = std::get_if<PointCloud>(&contents.what);
  Shape shape = points ? shape_from_points(std::move(*points), title)
                       : shape_from_mesh(std::get<Mesh>(std::move(contents.what)), title);
  shape.findings = std::move(contents.findings);
  return shape;
}

[[noreturn]] void refuse_volume(const std::string& name) {
  const PlannedKind* kind = planned_kind(name);
  throw NotAvailable(std::string(kind ? kind->what : "reading a volume") + " (" + name +
                     ") is not available in this version");
}

}  // namespace

InputKind kind_of_input(std::string_view name, std::string_view head) {
  // Names of shaders come first: their text is free.
  if (is_glsl(name, "")) return InputKind::shader;
  if (is_scene(name, head)) return InputKind::scene;
  if (is_glsl(name, head)) return InputKind::shader;
  const bool mesh = format_of_content(head).has_value();
  if (is_dexel_file(head) || (ends_with_ignoring_case(name, ".tdx") && !mesh)) return InputKind::dexels;
  // A mesh may have a misleading name.
  if (planned_kind(name) && !head.empty() && !mesh) return InputKind::volume;
  return InputKind::mesh_or_points;
}

InputKind kind_of_input(const std::string& name) {
  if (name.starts_with(gallery_prefix)) return InputKind::built_in;
  if (name == "-") return InputKind::standard_input;
  return kind_of_input(name, head_of(name));
}

Shape parse_shape(std::string_view bytes, const std::string& name, const InputOptions& options,
                  const std::filesystem::path& folder, ExecutionContext& context) {
  const std::string title = name == "-" ? "standard input" : name;
  switch (kind_of_input(name, bytes.substr(0, head_size))) {
    case InputKind::scene:
      return parse_scene(bytes, title, folder, context);
    case InputKind::shader:
      return shape_from_glsl(std::string(bytes), shader_options(options), title);
    case InputKind::dexels:
      return shape_from_dexels(parse_dexels(bytes, title), title);
    case InputKind::volume:
      refuse_volume(name);
    default:
      return shape_of(parse_mesh_or_points(bytes, title, context), title);
  }
}

Shape read_shape(const std::string& name, const InputOptions& options, ExecutionContext& context) {
  switch (kind_of_input(name)) {
    case InputKind::built_in:
      return gallery_shape(std::string_view(name).substr(gallery_prefix.size()));
    case InputKind::standard_input:
      return parse_shape(read_bytes("-"), "-", options, {}, context);
    case InputKind::scene:
      return read_scene(name, context);
    case InputKind::shader:
      return read_glsl(name, shader_options(options));
    case InputKind::dexels:
      return shape_from_dexels(read_dexels(name, context), name);
    case InputKind::volume:
      refuse_volume(name);
    case InputKind::mesh_or_points:
      break;
  }
  return shape_of(read_mesh_or_points(name, context), name);
}

std::vector<Shape> in_one_unit(std::vector<Shape> shapes, std::optional<LengthUnit> wanted) {
  for (const Shape& shape : shapes)
    if (!wanted) wanted = shape.unit;
  if (!wanted) return shapes;
  for (Shape& shape : shapes) {
    if (shape.unit.value_or(*wanted) != *wanted) shape = converted(shape, *wanted);
    shape.unit = wanted;
  }
  return shapes;
}

Shape read_drawing(Drawing drawing, const InputOptions& options) {
  RasterOptions raster{.vertex_count = drawing.vertex_count,
                       .bounds = options.bounds,
                       .definitions = options.definitions,
                       .device = options.device};
  if (drawing.geometry) raster.geometry = std::move(*drawing.geometry);
  const auto path = [](const std::string& name) { return name == "default" ? "" : name; };
  return read_raster(path(drawing.vertex), path(drawing.fragment), std::move(raster), "raster");
}

}  // namespace evenmesh
