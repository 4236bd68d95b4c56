#include "sample/sample.h"

#include "evenmesh/error.h"
#include "sample/tri_dexel.h"

namespace evenmesh {

SampleSet sample_shape(const Shape& shape, const Grid& grid, Run& run) {
  if (!shape.mesh()) throw NotAvailable("sampling of implicit shapes is not available in this version");
  SampleSet set = with_threads(run, [&] {
    const TriDexel solid = scan_mesh(*shape.mesh(), grid, run, shape.bounds);
    return sample_dexels(solid, *shape.mesh(), run);
  });
  if (set.size() == 0)
    throw UnusableInput(shape.name + " has no surface within its bounds: raise the resolution or check the bounds");
  return set;
}

}  // namespace evenmesh
