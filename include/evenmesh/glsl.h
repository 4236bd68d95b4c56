#pragma once
/// Shapes from functions written in GLSL, and expressions, evaluated by OpenGL: on a graphics card, or on Mesa's
/// llvmpipe, which needs none.

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"

namespace evenmesh {

struct GlslOptions {
  /// The function that is negative inside: of one vec3, with a float, or a vector whose first component counts.
  std::string entry = "map";
  /// Values of uniforms ("1.5", "true", "1,0,0.5"; matrices column by column) and of macros (any text), by name.
  std::map<std::string, std::string> definitions{};
  /// No two values differ by more than this times the distance of their points (1 for an exact distance, > 0); lets
  /// boxes without surface be skipped. A value too small loses pieces of the surface. Unset: nothing is known.
  std::optional<double> lipschitz{};
  double level = 0;  ///< the surface is where the function has this value, and inside is what is below
  Box bounds{};      ///< where the surface is sought, model units; empty: ±1 sets the scale of numerical derivatives
  /// "" for the best, "0", "1", … by number, "software" for llvmpipe, or a part of the renderer's name.
  std::string device{};
};

/// The solid f < 0 of a function in GLSL 4.50 (or older, or of WebGL).
///
/// Files made for Shadertoy may be used as they are: what draws the picture (mainImage, and all that the entry does not
/// call) is left out; iTime, iMouse, iFrame and iDate are 0, iResolution is (1024, 1024, 1), or as `definitions` says.
/// Other uniforms take their values from `definitions` or from the file. Textures cannot be read, and nothing can be
/// included. Where the function is not a finite number, it is outside.
///
/// @param source  the text of a file, at most 1 MB
/// @param name    of the file, for messages
/// @throws UnusableInput  "NAME:LINE:COLUMN: what", the line, and a caret: text that does not compile, a texture read,
/// a
///                        loop of more than 65,000 rounds per point (also later, when the shape is sampled); no driver
/// @throws InvalidInput   no such entry, device, uniform or macro, or a uniform without a value
/// @throws NotAvailable   this build has no OpenGL
/// Guarantee: any text either gives a shape or throws. Drivers are trusted, except that one which does not come back
/// within 20 s is given up: an error, and gl_stuck() from then on.
/// Cost: compiles the shader, about 0.1 s; each later evaluation runs on the device.
Shape shape_from_glsl(std::string source, const GlslOptions& options = {}, std::string name = "shader");

/// The shape with its expressions evaluated by OpenGL, those within transforms and compounds too: values and gradients
/// come from the device, in the same order of operations as on the CPU; single points and what is known of boxes stay
/// on the CPU. The surface is the same up to rounding.
///
/// Built-in shapes are expressions, except the fractals julia, mandelbulb-7 and mandelbulb-8. These stay on the CPU, as
/// do meshes, points, indicator functions, and expressions of more than 2,000 operations; shaders stay where they are.
/// If there is nothing to move, the shape is returned as it is, and no device is started.
/// @param device  as GlslOptions::device
/// @throws UnusableInput  no driver, or it does not compile this (also later, when the shape is sampled: it stops
///                        working)
/// @throws InvalidInput   no such device
/// @throws NotAvailable   this build has no OpenGL
/// Cost: compiles two shaders for each expression, some 0.1 s.
Shape on_gl(const Shape& shape, const std::string& device = "");

/// Whether any part of the shape is evaluated by OpenGL.
bool runs_on_gl(const Shape& shape);

/// Whether a file is GLSL: its name ends with .glsl, .frag, .fs or .fsh, or it begins like a shader.
/// @param first_bytes  4096 or more of the file, or all of it
bool is_glsl(std::string_view name, std::string_view first_bytes);

/// Name of the renderer and its version of OpenGL. Cost: starts the device, some 50 ms.
/// @throws as shape_from_glsl
std::string gl_renderer(const std::string& device = "");

/// Whether a driver still works on something that was given up. Then leave the process with std::_Exit, after flushing
/// what is to be kept: the driver's threads do not end, and some drivers wait for them at exit.
bool gl_stuck();

}  // namespace evenmesh
