#include "input.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "evenmesh/io.h"
#include "terminal.h"
#include "values.h"

namespace evenmesh::cli {
namespace {

/// What a name that is no mesh file stands for; empty where it is none, or where reading it will tell.
std::string other_than_mesh(InputKind kind, const std::string& name) {
  switch (kind) {
    case InputKind::scene:
      return name + " is a scene";
    case InputKind::shader:
      return name + " is a shader";
    case InputKind::dexels:
      return name + " holds dexels";
    default:
      return "";
  }
}

/// Refuses what names no mesh file.
void check_file(const std::string& command, const std::string& name) {
  const InputKind kind = kind_of_input(name);
  if (kind == InputKind::built_in) {
    throw InvalidInput(fmt::format("{} takes a mesh file; make one first: evenmesh mesh {} -o {}.ply", command, name,
                                   name.substr(name.find(':') + 1)));
  }
  if (const std::string what = other_than_mesh(kind, name); !what.empty()) {
    throw InvalidInput(fmt::format("{} takes a mesh file, {}; make a mesh of it first: evenmesh mesh {} -o x.ply",
                                   command, what, name));
  }
  if (kind == InputKind::volume) read_shape(name);  // says that it is not available
}

/// Whether options of shaders were given.
bool has_shader_options(const InputOptions& options) {
  return options.entry != InputOptions{}.entry || options.lipschitz || options.level != 0;
}

/// What shaders draw, with the mesh that is the only input, or without.
Shape read_drawing(const InputArguments& input, ExecutionContext& context) {
  Drawing drawing{.vertex = input.raster[0], .fragment = input.raster[1], .vertex_count = input.raster_vertices};
  if (!input.positional.empty()) drawing.geometry = read_mesh_file("mesh --raster", input.positional[0], context);
  return evenmesh::read_drawing(std::move(drawing), input.options);
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
  std::variant<Mesh, PointCloud> contents = read_file(command, name, context);
  if (Mesh* mesh = std::get_if<Mesh>(&contents)) return std::move(*mesh);
  throw UnusableInput(
      fmt::format("{}: holds no triangles, only {} points; make a mesh of it first: evenmesh mesh {} -o x.ply", name,
                  std::get<PointCloud>(contents).points.size(), name));
}

std::variant<Mesh, PointCloud> read_file(const std::string& command, const std::string& name,
                                         ExecutionContext& context) {
  check_file(command, name);
  FileContents contents = read_mesh_or_points(name, context);
  for (const Finding& finding : contents.findings) say(finding);
  return std::move(contents.what);
}

void check_input(const InputArguments& input, const InputCount& count) {
  if (!input.raster.empty()) {
    check_drawing(input);
  } else if (input.raster_vertices != 0) {
    throw InvalidInput("--raster-vertices is for --raster; give both or neither");
  }
  if (!input.raster.empty() && count.least <= 1) {
    if (has_shader_options(input.options))
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
  const bool shader = std::any_of(input.positional.begin(), input.positional.end(),
                                  [](const std::string& name) { return kind_of_input(name) == InputKind::shader; });
  const bool takes_parameters = shader || input.density || !input.expressions.empty();
  if (!takes_parameters && !input.options.definitions.empty()) {
    throw InvalidInput(
        "-D gives a parameter of an expression or a shader; it needs an expression after -e or --density, or a .glsl "
        "file");
  }
  if (!shader && has_shader_options(input.options)) {
    throw InvalidInput("--entry, --lipschitz and --level are for shaders; no input is a .glsl file");
  }
}

std::vector<Shape> read_shapes(const InputArguments& input, ExecutionContext& context) {
  if (!input.raster.empty()) return {read_drawing(input, context)};
  std::vector<Shape> shapes;
  for (const std::string& name : input.positional) shapes.push_back(read_shape(name, input.options, context));
  for (const std::string& expression : input.expressions)
    shapes.push_back(shape_from_expression(expression, parameters_of(input), input.options.bounds));
  return shapes;
}

std::map<std::string, double> parameters_of(const InputArguments& input) {
  std::map<std::string, double> parameters;
  for (const auto& [name, text] : input.options.definitions)
    parameters[name] = real_number(fmt::format("-D {}=", name), text);
  return parameters;
}

}  // namespace evenmesh::cli
