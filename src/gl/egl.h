#pragma once
/// Contexts of OpenGL without a window, through EGL.

#include <string>

namespace evenmesh::gl {

/// What EGL has opened; the handles are EGLDisplay and EGLContext, kept untyped so that EGL's headers stay inside.
struct EglContext {
  void* display = nullptr;
  void* context = nullptr;
  std::string renderer;  ///< GL_RENDERER
  std::string version;   ///< GL_VERSION
};

/// Opens a context of OpenGL 4.5 core or later and makes it current on the calling thread.
///
/// Tried in this order: the devices that EGL lists (cards before llvmpipe), Mesa without a platform, the default
/// display.
/// @param device  "" for the first that works, its number in that order, "software", or a part of GL_RENDERER
/// @throws UnusableInput  no library or driver; says what to install
/// @throws InvalidInput   no device of that name or number; lists those there are
EglContext open_egl(const std::string& device);

/// Destroys a context that is current on the calling thread.
void close_egl(const EglContext& context);

}  // namespace evenmesh::gl
