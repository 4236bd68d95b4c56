#pragma once
/// Polygons of more than three corners among the triangles of a file.

#include <cstddef>
#include <vector>

#include "evenmesh/mesh.h"
#include "io/source.h"

namespace evenmesh {

/// A polygon as it was read: a fan of triangles around its first corner.
struct Fan {
  std::size_t first = 0;  ///< triangle of the mesh
  std::size_t count = 0;  ///< of triangles
};

/// Gives polygons with notches triangles that cover them and nothing else.
///
/// A fan stays where all its triangles turn the same way as the polygon; otherwise the polygon is laid into its plane
/// (without the axis that its normal is closest to) and its ears are clipped. Fans that cannot be mended become a
/// finding of the source. The number of triangles stays. Cost: O(corners) for fans, see ear_clipped for others.
void mend_fans(const Source& source, const std::vector<Fan>& fans, Mesh& mesh);

}  // namespace evenmesh
