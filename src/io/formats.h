#pragma once
/// One reader and one writer per format; read_mesh() and write_mesh() choose among them.
///
/// Readers throw UnusableInput with the name of the source and, in text files, the line. They give valid indices and
/// finite coordinates; a file without triangles is left to parse_mesh(). Writers expect what serialize_mesh() has
/// checked.

#include <string>

#include "evenmesh/mesh.h"
#include "io/source.h"

namespace evenmesh {

Mesh read_ply(const Source& source);
Mesh read_obj(const Source& source);
Mesh read_stl(const Source& source);
Mesh read_off(const Source& source);
Mesh read_gltf(const Source& source);
Mesh read_threemf(const Source& source);

std::string write_ply(const Mesh& mesh);
std::string write_obj(const Mesh& mesh);
std::string write_stl(const Mesh& mesh);
std::string write_off(const Mesh& mesh);
std::string write_gltf(const Mesh& mesh);
std::string write_threemf(const Mesh& mesh);

/// True if an STL file is text: it begins with "solid" and speaks of facets soon after.
bool is_ascii_stl(std::string_view bytes);
/// True if the size of `bytes` is exactly that of a binary STL file with the number of triangles it states.
bool is_exact_binary_stl(std::string_view bytes);

}  // namespace evenmesh
