#pragma once
/// What `repair` does with a defective triangle mesh before it is meshed.

#include <cstddef>
#include <optional>
#include <string>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh_shape.h"
#include "evenmesh/repair.h"
#include "evenmesh/shape.h"

namespace evenmesh {

/// What becomes the solid. Automatic: wrap where there is no inside to speak of, else outer.
enum class Hull {
  automatic,
  outer,     ///< all that the outside does not reach: cavities and inner shells are filled
  oriented,  ///< so, but parts that face inward bound nothing
  all,       ///< inner shells are kept
  wrap,      ///< a closed mesh one voxel around everything, by the shell
};

/// A mesh put in order, and how mesh_shape() makes a closed two-manifold of it.
struct Repaired {
  Shape shape;
  MeshOptions options;             ///< as given, with method, wrap and fill_cavities decided
  MeshDefects defects;             ///< what cleaning did, and what is left
  std::optional<double> solidity;  ///< of the cleaned mesh, [0, 1], where Hull::automatic asked for it (repair.h)
  bool wrapped_sheets = false;     ///< Hull::automatic found sheets without an inside: solidity below 0.6
  std::size_t filled_holes = 0;    ///< by triangles; wraps and gaps too wide are left to the sampling
  struct Hole {
    Vec3 middle;
    double size = 0;  ///< diagonal of its box, model units
  };
  std::optional<Hole> largest_hole{};  ///< of those that are small beside the surface
};

/// Welds, leaves out what is degenerate or repeated, turns patches one way (cleaned()), decides on the hull, and fills
/// holes unless it is a wrap.
///
/// mesh_shape(r.shape, r.options) is then closed and two-manifold. No coordinate of the input changes.
/// Runs on the context's threads; cancel() takes effect between the steps and while rays measure solidity.
/// Cost: as of cleaned(), solidity() and holes_filled(): about 2 µs per triangle.
/// @throws InvalidInput   the shape is no triangle mesh
/// @throws UnusableInput  no triangle has an area
/// @throws Cancelled      through `context`
Repaired repaired(const Shape& shape, Hull hull = Hull::automatic, const MeshOptions& options = {},
                  ExecutionContext& context = ExecutionContext::silent());

/// "3 vertices welded, 1 triangles turned": what is not zero, or "no defects of connection".
std::string summary_of(const MeshDefects& defects);

}  // namespace evenmesh
