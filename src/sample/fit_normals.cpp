#include "sample/field_parts.h"
namespace evenmesh {
void fit_normals(SampleSet&, const Run&) {}
}  // namespace evenmesh
