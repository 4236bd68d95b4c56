#pragma once
/// Small exact-topology meshes for tests, benchmarks and examples. All are oriented outward.

#include "evenmesh/mesh.h"

namespace evenmesh {

/// Icosahedron subdivided `levels` times, vertices on the sphere around the origin.
/// 20·4^levels triangles, 10·4^levels + 2 vertices. @throws InvalidInput unless 0 ≤ levels ≤ 10 and radius > 0
Mesh make_icosphere(int levels, double radius = 1.0);

/// Torus around the z axis; `around` quads along the ring, `across` along the tube, each cut in two triangles.
/// @throws InvalidInput unless around, across ≥ 3 and both radii > 0
Mesh make_torus(double ring_radius = 1.0, double tube_radius = 0.35, int around = 48, int across = 24);

/// Box with shared vertices, every side cut into `cuts` × `cuts` quads of two triangles.
/// @throws InvalidInput if the box is empty or flat, or cuts < 1
Mesh make_box_around(const Box& box, int cuts = 1);

/// Box of the given half sizes around the origin.
Mesh make_box(const Vec3& half_sizes = {1, 1, 1}, int cuts = 1);

/// Regular tetrahedron with corners on the sphere of `radius` around the origin.
Mesh make_tetrahedron(double radius = 1.0);

/// Open sheet z = 0, [0, nx·step] × [0, ny·step], nx × ny quads of two triangles, normals up.
/// @throws InvalidInput unless nx, ny ≥ 1 and step > 0
Mesh make_grid_plane(int nx, int ny, double step = 1.0);

/// Both meshes in one, b's indices shifted; nothing is welded.
Mesh merged(const Mesh& a, const Mesh& b);

/// A copy with every vertex moved by `offset`.
Mesh translated(Mesh mesh, const Vec3& offset);

}  // namespace evenmesh
