#pragma once
/// Scene files: solids made of others, written down as JSON or as OpenSCAD's .csg.

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "evenmesh/execution_context.h"
#include "evenmesh/glsl.h"
#include "evenmesh/raster.h"
#include "evenmesh/shape.h"

namespace evenmesh {

/// Limits of what a scene file may hold; beyond them it is refused.
struct SceneLimits {
  std::size_t bytes = std::size_t{64} << 20;  ///< of the scene file itself
  std::size_t depth = 500;                    ///< nodes within each other
  std::size_t triangles = 100'000'000;        ///< made by the scene's own bodies, and of moved copies of meshes
};

/// Whether a file is a scene: its name ends with ".csg" or ".json", or it begins like a JSON object or with a statement
/// of OpenSCAD; neither counts where the content is that of a mesh (glTF is JSON, too). ".scad" counts, to be refused
/// with a word on what to do.
/// @param first_bytes  4096 or more of the file, or all of it
bool is_scene(std::string_view name, std::string_view first_bytes);

/// Reads a scene: JSON (docs/scenes.md, docs/scene.schema.json), or OpenSCAD's ".csg"; by the extension or, where it is
/// another one, by content.
///
/// Paths in it are relative to its folder. Files that are used several times are read once. Units are not converted.
///
/// @param path  a file, or "-" for standard input; paths in it are then relative to the working folder
/// @throws UnusableInput  one sentence that names the file and where in it: the path of the JSON member
///         ("union[1].transform.scale"), or line and column. Missing files, unknown, missing or contradicting keys,
///         wrong types, too deep, too large, nothing solid in it
/// @throws NotAvailable   a documented node that this version does not contain
/// Guarantee: any sequence of bytes either gives a shape or throws; only regular files are opened.
/// Cost: O(bytes) time and memory, and that of the files it names; nothing is combined before the shape is sampled.
Shape read_scene(const std::filesystem::path& path, ExecutionContext& context = ExecutionContext::silent());

/// The same from memory.
/// @param name    for its extension and in messages
/// @param folder  that relative paths start from
Shape parse_scene(std::string_view bytes, std::string_view name, const std::filesystem::path& folder,
                  ExecutionContext& context = ExecutionContext::silent(), const SceneLimits& limits = {});

/// A shader file, as shape_from_glsl() takes its text.
/// @param path  a file, or "-" for standard input
/// @throws UnusableInput  the file cannot be read; and as shape_from_glsl
Shape read_glsl(const std::filesystem::path& path, const GlslOptions& options = {});

/// What two shader files draw, as shape_from_raster() takes their texts.
/// @param vertex, fragment  files; empty paths: the built-in shaders
/// @param options           all but the texts and their names
/// @throws UnusableInput  a file cannot be read; and as shape_from_raster
Shape read_raster(const std::filesystem::path& vertex, const std::filesystem::path& fragment, RasterOptions options,
                  std::string name = "raster");

}  // namespace evenmesh
