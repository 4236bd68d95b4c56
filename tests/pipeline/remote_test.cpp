// Fields that want large batches, from end to end.

#include "pipeline/remote_checks.h"

namespace evenmesh::testing {

INSTANTIATE_TEST_SUITE_P(Mesh, RemoteMeshes, ::testing::Values(on_cpu), name_of_form);

}  // namespace evenmesh::testing
