/// What stands for the room where evenmesh is built without OpenGL.

#include "evenmesh/glsl.h"

#include "evenmesh/error.h"

namespace evenmesh {
namespace {

[[noreturn]] void refuse() {
  throw NotAvailable("this build has no OpenGL: configure with -DEVENMESH_GL=ON");
}

}  // namespace

Shape shape_from_glsl(std::string, const GlslOptions&, std::string) {
  refuse();
}

Shape on_gl(const Shape&, const std::string&) {
  refuse();
}

bool runs_on_gl(const Shape&) {
  return false;
}

std::string gl_renderer(const std::string&) {
  refuse();
}

bool gl_stuck() {
  return false;
}

}  // namespace evenmesh
