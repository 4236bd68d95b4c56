#pragma once
/// Mesh files: PLY, OBJ, STL, OFF, GLB, 3MF, in and out.

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "evenmesh/mesh.h"
#include "evenmesh/run.h"

namespace evenmesh {

enum class MeshFormat { ply, obj, stl, off, glb, threemf };

/// Format that a file name's extension stands for (".ply", ".obj", ".stl", ".off", ".glb", ".3mf", any case).
std::optional<MeshFormat> format_of_name(std::string_view name);
/// Format recognized from the first bytes (and, for STL, the size) of a file.
std::optional<MeshFormat> format_of_content(std::string_view bytes);

/// Reads a triangle mesh. The format is recognized by content first, extension second; polygons become triangle fans;
/// STL vertices with equal coordinates are welded; nodes' transforms of GLB and 3MF are applied.
///
/// @param path  a file, or "-" for standard input
/// @throws UnusableInput  one sentence that names the file and what is wrong with it: missing, a directory, empty,
///         truncated, an index out of range, a coordinate that is not finite, no triangle in it, not a mesh at all
/// Guarantee: any sequence of bytes either gives a mesh with valid indices and finite coordinates or throws.
/// Cost: O(bytes) time and memory; never allocates more than a small multiple of the file's size.
Mesh read_mesh(const std::filesystem::path& path, Run& run = Run::silent());

/// The same from memory; `name` is used for its extension and in messages.
Mesh parse_mesh(std::string_view bytes, std::string_view name);

/// Writes a mesh; format by extension. PLY, STL, GLB are binary little-endian, float32 coordinates.
/// The file appears under its name only when it is complete (temporary name, then rename).
///
/// @param path  a file, or "-" for standard output, then `format` is needed
/// @throws InvalidInput   unknown extension, or "-" without a format
/// @throws UnusableInput  the file cannot be written
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, std::optional<MeshFormat> format = {});

/// The bytes of a mesh file.
std::string serialize_mesh(const Mesh& mesh, MeshFormat format);

/// Writes any text or binary file atomically: temporary name beside it, then rename.
/// @throws UnusableInput  the file cannot be written
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace evenmesh
