/// A library built without OpenGL refuses shaders by name.

#include <gtest/gtest.h>

#include "evenmesh/error.h"
#include "evenmesh/glsl.h"
#include "evenmesh/raster.h"

namespace evenmesh {
namespace {

TEST(WithoutGl, TheLibraryRefusesShaders) {
  EXPECT_THROW(shape_from_glsl("float map(vec3 p) { return p.x; }"), NotAvailable);
  EXPECT_THROW(shape_from_raster({}), NotAvailable);
  EXPECT_THROW(gl_renderer(), NotAvailable);
  EXPECT_THROW(on_gl(gallery_shape("sphere")), NotAvailable);
  EXPECT_FALSE(runs_on_gl(gallery_shape("sphere")));
  EXPECT_FALSE(gl_stuck());
  EXPECT_TRUE(is_glsl("a.glsl", ""));
}

}  // namespace
}  // namespace evenmesh
