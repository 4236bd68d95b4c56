#pragma once
/// Mesh files, in and out: PLY, OBJ, STL, OFF, GLB, 3MF. Point clouds, in: XYZ, PTS, PWN, PCD, and PLY, OBJ, OFF
/// without faces. Volumes, out: VDB.

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "evenmesh/dexels.h"
#include "evenmesh/execution_context.h"
#include "evenmesh/findings.h"
#include "evenmesh/mesh.h"
#include "evenmesh/points.h"
#include "evenmesh/volume.h"

namespace evenmesh {

enum class MeshFormat { ply, obj, stl, off, glb, threemf };

/// Format that a file name's extension stands for (".ply", ".obj", ".stl", ".off", ".glb", ".3mf", any case).
std::optional<MeshFormat> format_of_name(std::string_view name);
/// Format recognized from the first bytes (and, for STL, the size) of a file.
std::optional<MeshFormat> format_of_content(std::string_view bytes);

/// Reads a triangle mesh. The format is recognized by content first, extension second; polygons become triangles in
/// their plane; STL vertices with equal coordinates are welded; nodes' transforms of GLB and 3MF are applied. Vertices
/// that are not finite are left out, with their triangles; read_mesh_or_points() tells how many.
///
/// @param path  a file, or "-" for standard input
/// @throws UnusableInput  one sentence that names the file and what is wrong with it: missing, a directory, empty,
///         truncated, an index out of range, no triangle in it, not a mesh at all
/// Guarantee: any sequence of bytes either gives a mesh with valid indices and finite coordinates or throws.
/// Cost: O(bytes) time and memory; never allocates more than a small multiple of the file's size.
Mesh read_mesh(const std::filesystem::path& path, ExecutionContext& context = ExecutionContext::silent());

/// The same from memory; `name` is used for its extension and in messages.
Mesh parse_mesh(std::string_view bytes, std::string_view name);

/// Reads a point cloud: PLY, OBJ or OFF without faces (normals of PLY: nx, ny, nz; of OBJ: as many vn as v), PCD, or
/// text with a point a line, its numbers apart by blanks, commas or semicolons, '#' and '//' before comments.
/// Recognized by content first, extension second. Points that are not finite are left out.
///
/// Text may begin with a line of titles (skipped) or with the number of points (PTS, PWN); as many lines with normals
/// may follow the points (PWN). Three further columns, behind the coordinates or behind three colours, are normals
/// where they have unit length (within 10 %, 99 of 100 that are not zero), and always in six columns of a ".pwn" file.
/// All else is left out. A normal with an infinite component or NaN becomes zero: unknown. Where all are zero, there
/// are none.
///
/// @param path  a file, or "-" for standard input
/// @throws UnusableInput  one sentence that names the file and what is wrong with it: missing, a directory, empty, a
///         mesh, truncated, a wrong number of columns or points, no text at all
/// Guarantee: any sequence of bytes either gives finite coordinates, and no or as many normals, or throws.
/// Cost: O(bytes) time and memory, in parallel; never allocates more than a small multiple of the file's size.
PointCloud read_points(const std::filesystem::path& path, ExecutionContext& context = ExecutionContext::silent());

/// The same from memory; `name` is used for its extension and in messages.
PointCloud parse_points(std::string_view bytes, std::string_view name);

/// What a file holds, and what of it was left out or read otherwise than it stands there.
struct FileContents {
  std::variant<Mesh, PointCloud> what;
  std::vector<Finding> findings{};  ///< notes and warnings
};

/// Reads whichever of the two a file holds: a mesh, or points. Otherwise like read_mesh and read_points.
FileContents read_mesh_or_points(const std::filesystem::path& path,
                                 ExecutionContext& context = ExecutionContext::silent());

/// The same from memory; `name` is used for its extension and in messages.
FileContents parse_mesh_or_points(std::string_view bytes, std::string_view name,
                                  ExecutionContext& context = ExecutionContext::silent());

/// Writes a mesh; format by extension. Coordinates are float32 where that moves no vertex by more than 1e-4 edges of
/// its triangles; otherwise float64 (PLY), decimals that give the double back (OBJ, OFF, 3MF, and STL, which then is
/// text), or float32 about a node's translation (GLB). PLY, STL, GLB are binary little-endian. The file appears under
/// its name only when it is complete (temporary name, then rename).
///
/// @param path  a file, or "-" for standard output, then `format` is needed
/// @throws InvalidInput   unknown extension, or "-" without a format
/// @throws UnusableInput  the file cannot be written
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, std::optional<MeshFormat> format = {});

/// Where a file of the format has the mesh's vertices.
std::vector<Vec3> stored_vertices(const Mesh& mesh, MeshFormat format);

/// The bytes of a mesh file. 3MF says the mesh's unit (where it is not known: millimeter); GLB, which is in meters by
/// definition, scales by it.
std::string serialize_mesh(const Mesh& mesh, MeshFormat format);

/// What a reader of the file should know of the mesh's unit: that GLB converts it, or that the format has no place for
/// it. None where it is not known, or what readers take it for anyway: millimeters, in OBJ, PLY and OFF also meters.
std::optional<Finding> unit_remark(const Mesh& mesh, MeshFormat format);

/// Reads a dexel file (.tdx), as serialize_dexels() writes it (docs/formats.md).
/// @throws UnusableInput  one sentence that names the file and what is wrong with it
Dexels read_dexels(const std::filesystem::path& path, ExecutionContext& context = ExecutionContext::silent());
/// The same from memory; `name` is used in messages.
Dexels parse_dexels(std::string_view bytes, std::string_view name);
/// The bytes of a dexel file: 96 and 16 for each crossing.
std::string serialize_dexels(const Dexels& dexels);
/// Whether a file begins as a dexel file of any version does.
bool is_dexel_file(std::string_view bytes);

/// The bytes of an OpenVDB file with one grid of floats; its active voxels are those of the volume. They differ from
/// call to call, since OpenVDB gives every file an identifier of its own; what they say does not.
/// @throws InvalidInput  the side is not above 0, or there is not one value for each voxel
/// @throws NotAvailable  as require_vdb does
std::string serialize_vdb(const SparseVolume& volume);

/// To know it before the work is done.
/// @throws NotAvailable  there is no OpenVDB here, or evenmesh was built without it: what to install
void require_vdb();

/// All bytes of a file, pipe or device; "-" is standard input.
/// @throws UnusableInput  one sentence with the file's name: it does not exist, is a directory, may not be read, …
std::string read_bytes(const std::filesystem::path& path);

/// Whether this process may write to a file or device, or into a folder. What is not there, it may not.
bool is_writable(const std::filesystem::path& path) noexcept;

/// Writes any text or binary file atomically: temporary name beside it, then rename.
/// @throws UnusableInput  the file cannot be written
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace evenmesh
