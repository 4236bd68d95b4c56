#pragma once
/// One reader and one writer per format; read_mesh(), read_points() and write_mesh() choose among them.
///
/// Readers throw UnusableInput with the name of the source and, in text files, the line. They give valid indices;
/// coordinates that are not finite, and a file without triangles, are left to parse_mesh(). Writers expect what
/// serialize_mesh() has checked.

#include <string>
#include <vector>

#include "evenmesh/mesh.h"
#include "evenmesh/points.h"
#include "io/source.h"

namespace evenmesh {

/// A mesh, or points: vertices without triangles.
struct PlyContents {
  Mesh mesh;
  std::vector<Vec3> normals;  ///< of the vertices, as they are; read only where the file announces no faces
};
PlyContents read_ply(const Source& source);
Mesh read_obj(const Source& source);
/// The vertices of a file without triangles as points, with normals where there are as many. @throws UnusableInput  it
/// has faces, lines or curves, so that they are no points
PointCloud obj_points(const Source& source, std::vector<Vec3> vertices);
Mesh read_stl(const Source& source);
Mesh read_off(const Source& source);
Mesh read_gltf(const Source& source);
Mesh read_threemf(const Source& source);
/// Point Cloud Data, of the Point Cloud Library.
PointCloud read_pcd(const Source& source);
bool is_pcd(std::string_view bytes);
/// Points as text: XYZ, PTS, PWN; normals as they are. The name's extension matters for six columns of PWN only.
PointCloud read_point_text(const Source& source);

std::string write_ply(const Mesh& mesh);
std::string write_obj(const Mesh& mesh);
std::string write_stl(const Mesh& mesh);
std::string write_off(const Mesh& mesh);
std::string write_gltf(const Mesh& mesh);
std::string write_threemf(const Mesh& mesh);

/// By what a GLB file moves the mesh, so that what is left fits into single precision; zero where it does anyway.
Vec3 gltf_translation(const Mesh& mesh);

/// True if a name ends in ".xyz", ".pts", ".pwn" or ".csv", any case.
bool is_point_name(std::string_view name);
/// True if text begins like a point file: three numbers or more on a line, maybe behind lines with their titles and
/// their count.
/// OFF files whose first word was left out do so, too.
bool is_point_text(std::string_view bytes);

/// True if an STL file is text: it begins with "solid" and speaks of facets soon after.
bool is_ascii_stl(std::string_view bytes);
/// True if the size of `bytes` is exactly that of a binary STL file with the number of triangles it states.
bool is_exact_binary_stl(std::string_view bytes);

}  // namespace evenmesh
