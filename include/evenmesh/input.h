#pragma once
/// Whatever can be meshed, by one name: files of every kind, built-in shapes, standard input; and what shaders draw.
/// Expressions are shape_from_expression() of shape.h.

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"

namespace evenmesh {

/// What an input's name or first bytes say that it is.
enum class InputKind {
  built_in,        ///< "gallery:NAME"
  standard_input,  ///< "-": to be recognized when it has been read
  scene,           ///< JSON or OpenSCAD's .csg (scene.h)
  shader,          ///< a function in GLSL (glsl.h)
  dexels,          ///< .tdx
  volume,          ///< .vdb, .nii, .nii.gz, .nrrd: not available in this version
  mesh_or_points,  ///< all else, missing files included: whoever reads them says what is wrong
};

/// The kind of an input, by content first, extension second. Reads at most 4 kB of it.
InputKind kind_of_input(const std::string& name);
/// The same for bytes in memory.
/// @param first_bytes  4096 or more of them, or all
InputKind kind_of_input(std::string_view name, std::string_view first_bytes);

/// What shaders need beside their text. Other inputs take nothing of it.
struct InputOptions {
  Box bounds{};                                      ///< where the surface is sought, model units; empty: to be found
  std::map<std::string, std::string> definitions{};  ///< values of uniforms and macros, as GlslOptions
  std::string entry = "map";                         ///< as GlslOptions, as all below
  std::optional<double> lipschitz{};                 ///< > 0
  double level = 0;                                  ///< of the function on the surface
  std::string device{};                              ///< that runs shaders
};

/// Any input as a shape.
/// @param name  a file, "-" for standard input, or "gallery:NAME"
/// @throws UnusableInput  one sentence that names the file and what is wrong with it
/// @throws InvalidInput   no such built-in shape; and as shape_from_glsl
/// @throws NotAvailable   a kind that this version does not read
/// Guarantee: any sequence of bytes either gives a shape or throws. Cost: O(bytes) time and memory.
Shape read_shape(const std::string& name, const InputOptions& options = {},
                 ExecutionContext& context = ExecutionContext::silent());

/// The same from memory.
/// @param name    for its extension and in messages; "-" stands for standard input
/// @param folder  that relative paths in a scene start from
Shape parse_shape(std::string_view bytes, const std::string& name, const InputOptions& options = {},
                  const std::filesystem::path& folder = {}, ExecutionContext& context = ExecutionContext::silent());

/// Shapes with all lengths in one unit: the one wanted, or else that of the first shape that has one.
///
/// Shapes in another unit are scaled, with a finding; those of which none is known are taken to be in this one.
/// @throws InvalidInput  as transformed()
std::vector<Shape> in_one_unit(std::vector<Shape> shapes, std::optional<LengthUnit> wanted = {});

/// A pair of shaders, and what they draw (raster.h).
struct Drawing {
  std::string vertex = "default";    ///< file, or "default": the built-in one
  std::string fragment = "default";  ///< likewise
  std::optional<Mesh> geometry{};    ///< what they draw
  std::size_t vertex_count = 0;      ///< without geometry: vertices to draw, three for each triangle
};

/// What shaders draw, as a shape. Takes bounds, definitions and device of the options.
/// @throws as read_raster
Shape read_drawing(Drawing drawing, const InputOptions& options = {});

}  // namespace evenmesh
