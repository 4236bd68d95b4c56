#pragma once
/// Inputs of the commands: files, scenes, expressions, built-in shapes, standard input.

#include <cstddef>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/input.h"
#include "evenmesh/mesh.h"
#include "evenmesh/points.h"
#include "evenmesh/shape.h"

namespace evenmesh::cli {

/// Everything that may name an input on a command line.
struct InputArguments {
  std::vector<std::string> positional;   ///< file, "-", or "gallery:NAME"
  std::vector<std::string> expressions;  ///< -e
  InputOptions options;                  ///< --entry, --lipschitz, --level, --gl-device, --bounds, and -D
  std::vector<std::string> raster;       ///< --raster: vertex and fragment shader, files or "default"
  std::size_t raster_vertices = 0;       ///< --raster-vertices
  bool density = false;                  ///< --density is an expression, which -D gives parameters, too
};

/// How many inputs a command takes.
struct InputCount {
  std::size_t least = 1;
  std::size_t most = 1;
};

/// @throws InvalidInput  too few inputs, too many, or options of expressions and shaders without one
void check_input(const InputArguments& input, const InputCount& count = {});

/// The parameters of expressions among the definitions. @throws InvalidInput  one is not a number
std::map<std::string, double> parameters_of(const InputArguments& input);

/// The shapes that the checked arguments name: files and built-in shapes first, then expressions.
/// @throws InvalidInput   an expression or name that is wrong
/// @throws NotAvailable   an input kind that this version does not contain
/// @throws UnusableInput  a file that cannot be read
std::vector<Shape> read_shapes(const InputArguments& input, ExecutionContext& context);

/// A mesh file, or standard input for "-"; what was left out of it is said. Throws like read_shapes.
Mesh read_mesh_file(const std::string& command, const std::string& name, ExecutionContext& context);

/// A file of a mesh or of points, or standard input for "-"; what was left out of it is said. Throws like read_shapes.
std::variant<Mesh, PointCloud> read_file(const std::string& command, const std::string& name,
                                         ExecutionContext& context);

}  // namespace evenmesh::cli
