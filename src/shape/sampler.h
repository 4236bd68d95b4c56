#pragma once
/// Solids that sample themselves.

#include <memory>

#include "evenmesh/mesh.h"
#include "evenmesh/run.h"
#include "evenmesh/solid.h"

namespace evenmesh {

struct Grid;
struct SampleSet;

/// A solid known by where rays enter and leave it. Callable from one thread at a time.
class Sampler {
 public:
  virtual ~Sampler() = default;

  /// The crossings with the edges of a grid, as those of any other solid: entering and leaving in turn on every ray,
  /// the three directions with one and the same inside, nothing inside in the grid's outermost layer.
  /// @param bounds  within the grid; what is beyond is cut off, and closed there
  /// @throws UnusableInput  the solid cannot be asked
  virtual SampleSet sample(const Grid& grid, const Box& bounds, Run& run) const = 0;

  /// The same solid moved. @param transform  not singular
  virtual std::shared_ptr<const Sampler> moved(const Affine& transform) const = 0;
};

}  // namespace evenmesh
