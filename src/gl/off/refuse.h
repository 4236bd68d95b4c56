#pragma once
/// What is said where evenmesh is built without OpenGL.

#include "evenmesh/error.h"

namespace evenmesh::gl {

[[noreturn]] inline void refuse() {
  throw NotAvailable(
      "evenmesh was built without OpenGL, which shaders need; install epoxy and EGL (Debian: apt install libepoxy-dev "
      "libegl-dev) and build it with -DEVENMESH_GL=ON");
}

}  // namespace evenmesh::gl
