/// The tests of fields, bounds and samples, on OpenGL.

#include "gl/forms.h"

#include "sample/field_checks.h"
#include "sample/remote_checks.h"
#include "shape/bounds_checks.h"
#include "shape/field_checks.h"
#include "shape/gallery_checks.h"

namespace evenmesh::testing {

INSTANTIATE_TEST_SUITE_P(OnGl, FieldForms, ::testing::Values(on_device, as_shader), name_of_form);
INSTANTIATE_TEST_SUITE_P(OnGl, TapeForms, ::testing::Values(on_device), name_of_form);
INSTANTIATE_TEST_SUITE_P(OnGl, GalleryForms, ::testing::Values(on_device, as_shader), name_of_form);
INSTANTIATE_TEST_SUITE_P(OnGl, GalleryTapes, ::testing::Values(on_device), name_of_form);
INSTANTIATE_TEST_SUITE_P(OnGl, ProbedBounds, ::testing::Values(as_shader), name_of_form);
INSTANTIATE_TEST_SUITE_P(OnGl, SampleForms, ::testing::Values(on_device, as_shader), name_of_form);
INSTANTIATE_TEST_SUITE_P(OnGl, RemoteForms, ::testing::Values(as_shader), name_of_form);
INSTANTIATE_TEST_SUITE_P(TapeOnGl, GallerySamples, gallery_in(on_device), name_of_gallery_form);
INSTANTIATE_TEST_SUITE_P(Glsl, GallerySamples, gallery_in(as_shader), name_of_gallery_form);

}  // namespace evenmesh::testing
