#include "shape/bounds_checks.h"

namespace evenmesh::testing {

INSTANTIATE_TEST_SUITE_P(Remote, ProbedBounds, ::testing::Values(on_cpu), name_of_form);

}  // namespace evenmesh::testing
