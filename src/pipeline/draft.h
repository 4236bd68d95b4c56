#pragma once
/// Triangles as they come from the cells, and what refinement must keep of them.

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/tessellate.h"
#include "refine/shape_smoothing.h"
#include "refine/vertex_constraints.h"

namespace evenmesh {

struct Draft {
  /// Of a vertex whose cell has gone with a small component, or was never there.
  static constexpr std::uint32_t none = 0xffffffffu;

  Mesh mesh;
  VertexConstraints constraints;               ///< corners, feature curves, apexes
  std::vector<std::uint32_t> vertex_of_label;  ///< none: no triangle has it
  /// Of sheets: vertices at the rim, and their place on it.
  std::vector<std::pair<std::uint32_t, Vec3>> boundary;
  std::vector<CellPlanes> planes;        ///< by vertex: of its cell
  SizingField sizing;                    ///< for as many vertices as there are
  std::size_t two_triangle_spheres = 0;  ///< components of two triangles, left out
  std::size_t cuts = 0;                  ///< vertices that were split where umbrellas meet
};

/// DislocationOptions::work for a tenth of the time of a mesh with so many vertices, about.
std::size_t annealing_work(Quality quality, std::size_t vertices);

/// A vertex for every cell with triangles, in the centroid of its samples or in the minimum of their quadric.
/// @throws UnusableInput  no triangle is left
Draft extract(const Tessellation& cells, const MeshOptions& options, ExecutionContext& context);

}  // namespace evenmesh
