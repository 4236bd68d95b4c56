#pragma once
/// Solids and surfaces that sample themselves.

#include <memory>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "evenmesh/solid.h"

namespace evenmesh {

struct Grid;
struct SampleSet;

/// A solid known by where rays enter and leave it, or a surface that they meet. Callable from one thread at a time.
class RaySource {
 public:
  virtual ~RaySource() = default;

  /// The crossings with the edges of a grid, as those of any other solid: entering and leaving in turn on every ray,
  /// the three directions with one and the same inside, nothing inside in the grid's outermost layer.
  /// @param bounds  within the grid; what is beyond is cut off, and closed there
  /// @throws UnusableInput  the solid cannot be asked
  virtual SampleSet sample(const Grid& grid, const Box& bounds, ExecutionContext& context) const = 0;

  /// All that rays meet on the edges of a grid, whether there is an inside between or not; open ends stay open. What
  /// lies beyond the bounds is left out.
  virtual SampleSet sample_surface(const Grid& grid, const Box& bounds, ExecutionContext& context) const = 0;

  /// How far the rays of the three directions agree on what is inside; 1 for a solid, as solidity() of meshes.
  virtual double solidity(const Box& bounds, ExecutionContext& context) const = 0;

  /// The same moved. @param transform  not singular
  virtual std::shared_ptr<const RaySource> moved(const Affine& transform) const = 0;
};

}  // namespace evenmesh
