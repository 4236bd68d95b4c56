#include "sample/sample.h"

#include "evenmesh/error.h"
#include "sample/field_parts.h"
#include "sample/tri_dexel.h"

namespace evenmesh {

SampleSet sample_shape(const Shape& shape, const Grid& grid, Run& run) {
  SampleSet set = with_threads(run, [&] {
    if (const Field* field = shape.field()) return sample_field(*field, grid, shape.bounds, run);
    if (!shape.mesh()) throw InvalidInput(shape.name + " has no inside: give the shape a mesh or a field");
    return sample_dexels(scan_mesh(*shape.mesh(), grid, run, shape.bounds), *shape.mesh(), run);
  });
  if (set.size() == 0)
    throw UnusableInput(shape.name + " has no surface within its bounds: raise the resolution or check the bounds");
  return set;
}

}  // namespace evenmesh
