#include "gl/egl.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "core/platform.h"
#include "evenmesh/error.h"

namespace evenmesh::gl {
namespace {

constexpr const char* advice = "install a driver (Debian: apt install libgl1-mesa-dri libegl1 libgl1)";

/// A way to a display.
struct Candidate {
  EGLDeviceEXT device = nullptr;  ///< or null
  EGLenum platform = 0;           ///< where there is no device; 0 stands for the default display
  bool software = false;
};

bool has_word(const char* words, std::string_view word) {
  std::string_view rest = words == nullptr ? "" : words;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == word) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

/// epoxy ends the program where a library is missing; so it is looked for first.
void require_libraries() {
  std::string ignored;
  const auto there = [&](const char* name) { return load_library(name, ignored) != nullptr; };
  if (!there("libEGL.so.1")) throw UnusableInput(fmt::format("there is no OpenGL here (no libEGL.so.1); {}", advice));
  if (!there("libOpenGL.so.0") && !there("libGL.so.1"))
    throw UnusableInput(fmt::format("there is no OpenGL here (no libGL.so.1); {}", advice));
}

std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool lists = has_word(extensions, "EGL_EXT_device_enumeration") || has_word(extensions, "EGL_EXT_device_base");
  if (lists && has_word(extensions, "EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 32> devices{};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(devices.size(), devices.data(), &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      const char* words = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
      found.push_back({devices[i], EGL_PLATFORM_DEVICE_EXT, has_word(words, "EGL_MESA_device_software")});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.software < b.software; });
  if (has_word(extensions, "EGL_MESA_platform_surfaceless")) found.push_back({nullptr, EGL_PLATFORM_SURFACELESS_MESA});
  found.push_back({});
  return found;
}

std::string text_of(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

EGLContext create_context(EGLDisplay display) {
  std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                   4,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                   EGL_LOSE_CONTEXT_ON_RESET,
                                   EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context != EGL_NO_CONTEXT) return context;
  attributes[6] = EGL_NONE;  // not every driver tells of resets
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

std::optional<EglContext> open_candidate(const Candidate& candidate) {
  EGLDisplay display =
      candidate.device != nullptr ? eglGetPlatformDisplayEXT(candidate.platform, candidate.device, nullptr)
      : candidate.platform != 0   ? eglGetPlatformDisplayEXT(candidate.platform, EGL_DEFAULT_DISPLAY, nullptr)
                                  : eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return {};
  if (!has_word(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) return {};
  if (!has_word(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context") || !eglBindAPI(EGL_OPENGL_API))
    return {};
  EGLContext context = create_context(display);
  if (context == EGL_NO_CONTEXT) return {};
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return {};
  }
  return EglContext{display, context, text_of(GL_RENDERER), text_of(GL_VERSION)};
}

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

bool is_wanted(const EglContext& context, const std::string& device, std::size_t number) {
  std::size_t wanted = 0;
  const auto [end, error] = std::from_chars(device.data(), device.data() + device.size(), wanted);
  if (error == std::errc() && end == device.data() + device.size()) return wanted == number;
  const std::string renderer = lower_case(context.renderer), part = lower_case(device);
  const bool software =
      renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos;
  return part == "software" ? software : renderer.find(part) != std::string::npos;
}

}  // namespace

EglContext open_egl(const std::string& device) {
  require_libraries();
  std::string there;
  std::size_t number = 0;
  bool any_device = false;
  for (const Candidate& candidate : candidates()) {
    if (candidate.device == nullptr && any_device) continue;  // would be one of the devices once more
    const std::optional<EglContext> context = open_candidate(candidate);
    if (!context) continue;
    if (device.empty() || is_wanted(*context, device, number)) return *context;
    there += fmt::format("{}{} {}", there.empty() ? "" : ", ", number, context->renderer);
    any_device = any_device || candidate.device != nullptr;
    ++number;
    close_egl(*context);
  }
  if (there.empty()) throw UnusableInput(fmt::format("there is no driver here for OpenGL 4.5 or later; {}", advice));
  throw InvalidInput(fmt::format("there is no device '{}' for OpenGL; there are: {}", device, there));
}

void close_egl(const EglContext& context) {
  eglMakeCurrent(context.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(context.display, context.context);
  eglReleaseThread();
}

}  // namespace evenmesh::gl
