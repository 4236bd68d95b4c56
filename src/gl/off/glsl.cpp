/// What stands for the module where evenmesh is built without OpenGL.

#include "evenmesh/glsl.h"

#include "gl/off/refuse.h"

namespace evenmesh {

Shape shape_from_glsl(std::string, const GlslOptions&, std::string) {
  gl::refuse();
}

Shape on_gl(const Shape&, const std::string&) {
  gl::refuse();
}

bool runs_on_gl(const Shape&) {
  return false;
}

std::string gl_renderer(const std::string&) {
  gl::refuse();
}

bool gl_stuck() {
  return false;
}

}  // namespace evenmesh
