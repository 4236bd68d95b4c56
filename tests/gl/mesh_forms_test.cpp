/// The tests of whole meshes, on OpenGL.

#include "gl/forms.h"
#include "pipeline/gallery_checks.h"
#include "pipeline/remote_checks.h"

namespace evenmesh::testing {

INSTANTIATE_TEST_SUITE_P(OnGl, EasyShape,
                         ::testing::Values(Easy{on_device, "torus", 1000}, Easy{as_shader, "torus", 1000},
                                           Easy{on_device, "octic", 1500}, Easy{as_shader, "octic", 1500}),
                         name_of_easy);
INSTANTIATE_TEST_SUITE_P(OnGl, RemoteMeshes, ::testing::Values(as_shader), name_of_form);

}  // namespace evenmesh::testing
