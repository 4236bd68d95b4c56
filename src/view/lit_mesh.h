#pragma once
/// What the renderer needs to know of a mesh besides its triangles: shading normals and how open each vertex is.

#include <array>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "evenmesh/render.h"
#include "geometry/embree_scene.h"

namespace evenmesh {

struct LitMesh {
  EmbreeScene scene;
  std::vector<Vec3> normals;    ///< by vertex, unit, weighted by angle
  std::vector<float> openness;  ///< by vertex: share of the sky that it sees, [0, 1]

  /// Normals to shade the corners of a triangle with: the vertex normal where the surface is smooth there, the
  /// triangle's own across a crease.
  std::array<Vec3, 3> corner_normals(const Mesh& mesh, std::size_t triangle) const;
};

/// Cost: three million rays at most for meshes below 100,000 vertices, some tenths of a second on two cores.
LitMesh light_mesh(const Mesh& mesh, const ExecutionContext& context);

/// What render_mesh() does once the mesh is lit. @throws InvalidInput  no triangle, or a size out of range
Image render_lit(const Mesh& mesh, const LitMesh& lit, const RenderOptions& options, const ExecutionContext& context);

}  // namespace evenmesh
