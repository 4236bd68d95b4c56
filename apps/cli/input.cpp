#include "input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "evenmesh/glsl.h"
#include "evenmesh/io.h"
#include "evenmesh/scene.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

constexpr std::string_view gallery_prefix = "gallery:";

struct PlannedKind {
  std::string_view extension, what;
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

/// The first bytes of a file, empty where there is none: whoever reads it says what is wrong with it.
std::string head_of(const std::string& name) {
  std::error_code unknown;
  if (name == "-" || !std::filesystem::is_regular_file(name, unknown)) return "";
  std::ifstream file(name, std::ios::binary);
  std::string head(4096, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

bool names_a_scene(const std::string& name) {
  return is_scene(name, head_of(name));
}

bool names_a_shader(const std::string& name) {
  return !name.starts_with(gallery_prefix) && is_glsl(name, head_of(name));
}

/// Refuses inputs that are documented but not built yet, unless the file holds a mesh under a misleading name.
void refuse_planned_kinds(const std::string& name) {
  const auto kind = std::find_if(planned_kinds.begin(), planned_kinds.end(),
                                 [&](const PlannedKind& k) { return ends_with_ignoring_case(name, k.extension); });
  if (kind == planned_kinds.end()) return;
  const std::string head = head_of(name);
  if (!head.empty() && !format_of_content(head)) not_available(fmt::format("{} ({})", kind->what, name));
}

bool names_dexels(const std::string& name) {
  const std::string head = head_of(name);
  return is_dexel_file(head) || (ends_with_ignoring_case(name, ".tdx") && !format_of_content(head));
}

/// Refuses what names no file, or a file that cannot be read yet.
void check_file(const std::string& command, const std::string& name) {
  if (name.starts_with(gallery_prefix)) {
    throw InvalidInput(fmt::format("{} takes a mesh file; make one first: evenmesh mesh {} -o {}.ply", command, name,
                                   name.substr(gallery_prefix.size())));
  }
  if (names_a_scene(name)) {
    throw InvalidInput(
        fmt::format("{} takes a mesh file, {} is a scene; make a mesh of it first: evenmesh mesh {} -o x.ply", command,
                    name, name));
  }
  if (names_a_shader(name)) {
    throw InvalidInput(
        fmt::format("{} takes a mesh file, {} is a shader; make a mesh of it first: evenmesh mesh {} -o x.ply", command,
                    name, name));
  }
  if (names_dexels(name)) {
    throw InvalidInput(
        fmt::format("{} takes a mesh file, {} holds dexels; make a mesh of it first: evenmesh mesh {} -o x.ply",
                    command, name, name));
  }
  refuse_planned_kinds(name);
}

GlslOptions shader_options(const InputArguments& input, const Box& bounds) {
  return {.entry = input.entry,
          .definitions = input.definitions,
          .lipschitz = input.lipschitz,
          .level = input.level,
          .bounds = bounds,
          .device = input.gl_device};
}

Shape shape_of(std::variant<Mesh, PointCloud> contents, const std::string& title) {
  if (auto* points = std::get_if<PointCloud>(&contents)) return shape_from_points(std::move(*points), title);
  return shape_from_mesh(std::get<Mesh>(std::move(contents)), title);
}

/// Recognized by content alone; relative paths in a scene start from the working folder.
Shape read_standard_input(const GlslOptions& shader, ExecutionContext& context) {
  const std::string bytes = read_bytes("-"), title = "standard input";
  if (is_dexel_file(bytes)) return shape_from_dexels(parse_dexels(bytes, title), title);
  const std::string_view head = std::string_view(bytes).substr(0, 4096);
  if (is_scene("-", head)) return parse_scene(bytes, title, {}, context);
  if (is_glsl("-", head)) return shape_from_glsl(bytes, shader, title);
  return shape_of(parse_mesh_or_points(bytes, title, context), title);
}

Shape read_one(const std::string& name, const GlslOptions& shader, ExecutionContext& context) {
  if (name.starts_with(gallery_prefix)) return gallery_shape(name.substr(gallery_prefix.size()));
  if (name == "-") return read_standard_input(shader, context);
  if (names_a_shader(name)) return read_glsl(name, shader);
  if (names_a_scene(name)) return read_scene(name, context);
  if (names_dexels(name)) return shape_from_dexels(read_dexels(name, context), name);
  refuse_planned_kinds(name);
  return shape_of(read_mesh_or_points(name, context), name);
}

/// What shaders draw, with the mesh that is the only input, or without.
Shape read_drawing(const InputArguments& input, const Box& bounds, ExecutionContext& context) {
  RasterOptions options{.vertex_count = input.raster_vertices,
                        .bounds = bounds,
                        .definitions = input.definitions,
                        .device = input.gl_device};
  if (!input.positional.empty()) options.geometry = read_mesh_file("mesh --raster", input.positional[0], context);
  const auto path = [](const std::string& name) { return name == "default" ? "" : name; };
  return read_raster(path(input.raster[0]), path(input.raster[1]), std::move(options), "raster");
}

/// Of --raster, which may have one mesh to draw.
void check_drawing(const InputArguments& input) {
  const auto is = [&](std::size_t i, const char* name) { return input.raster[i] == name; };
  const bool reads_twice = (is(0, "-") && is(1, "-")) ||
                           (!input.positional.empty() && input.positional[0] == "-" && (is(0, "-") || is(1, "-")));
  if (reads_twice) throw InvalidInput("only one of the inputs can come from standard input");
  if (!input.expressions.empty()) throw InvalidInput("--raster draws a mesh or vertices; it takes no expression");
  if (input.positional.size() > 1)
    throw InvalidInput(
        fmt::format("--raster draws one mesh, not '{}' and '{}', too", input.positional[0], input.positional[1]));
  if (input.positional.empty() && input.raster_vertices == 0)
    throw InvalidInput("--raster has nothing to draw; name a mesh file, or give --raster-vertices");
  if (!input.positional.empty() && input.raster_vertices != 0)
    throw InvalidInput("--raster draws a mesh or --raster-vertices; give one of them");
}

}  // namespace

Mesh read_mesh_file(const std::string& command, const std::string& name, ExecutionContext& context) {
  check_file(command, name);
  return read_mesh(name, context);
}

std::variant<Mesh, PointCloud> read_file(const std::string& command, const std::string& name,
                                         ExecutionContext& context) {
  check_file(command, name);
  return read_mesh_or_points(name, context);
}

void check_input(const InputArguments& input, const InputCount& count) {
  if (!input.raster.empty()) {
    check_drawing(input);
  } else if (input.raster_vertices != 0) {
    throw InvalidInput("--raster-vertices is for --raster; give both or neither");
  }
  if (!input.raster.empty() && count.least <= 1) {
    if (input.entry != InputArguments{}.entry || input.lipschitz || input.level != 0)
      throw InvalidInput("--entry, --lipschitz and --level are for functions in GLSL; --raster draws");
    return;
  }
  const std::size_t given = input.positional.size() + input.expressions.size();
  if (given == 0) {
    throw InvalidInput(
        "no input; name a mesh file, a scene, a shader, '-' for standard input, gallery:NAME, or an expression after "
        "-e");
  }
  if (given < count.least) {
    throw InvalidInput(fmt::format("{} input where {} or more are needed", given, count.least));
  }
  if (given > count.most) {  // which is then 1
    throw InvalidInput(fmt::format("{} inputs where one is taken: '{}' and '{}'{}", given,
                                   input.positional.empty() ? input.expressions[0] : input.positional[0],
                                   input.expressions.empty() ? input.positional[1] : input.expressions.back(),
                                   given > 2 ? ", …" : ""));
  }
  if (std::count(input.positional.begin(), input.positional.end(), "-") > 1) {
    throw InvalidInput("only one of the inputs can come from standard input");
  }
  const bool shader = std::any_of(input.positional.begin(), input.positional.end(), names_a_shader);
  if (input.expressions.empty() && !shader && !input.definitions.empty()) {
    throw InvalidInput(
        "-D gives a parameter of an expression or a shader; it needs an expression after -e, or a .glsl file");
  }
  if (!shader && (input.entry != InputArguments{}.entry || input.lipschitz || input.level != 0)) {
    throw InvalidInput("--entry, --lipschitz and --level are for shaders; no input is a .glsl file");
  }
}

std::vector<Shape> read_shapes(const InputArguments& input, const Box& bounds, ExecutionContext& context) {
  if (!input.raster.empty()) return {read_drawing(input, bounds, context)};
  std::vector<Shape> shapes;
  for (const std::string& name : input.positional)
    shapes.push_back(read_one(name, shader_options(input, bounds), context));
  for (const std::string& expression : input.expressions) {
    shapes.push_back(shape_from_expression(expression, parameters_of(input), bounds));
  }
  return shapes;
}

std::map<std::string, double> parameters_of(const InputArguments& input) {
  std::map<std::string, double> parameters;
  for (const auto& [name, text] : input.definitions) parameters[name] = real_number(fmt::format("-D {}=", name), text);
  return parameters;
}

}  // namespace evenmesh::cli
