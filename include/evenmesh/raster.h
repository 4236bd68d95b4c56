#pragma once
/// Shapes from whatever OpenGL draws: a vertex and a fragment shader, with triangles or without.

#include <cstddef>
#include <map>
#include <string>

#include "evenmesh/mesh.h"
#include "evenmesh/shape.h"

namespace evenmesh {

struct RasterOptions {
  std::string vertex{};    ///< text of the vertex shader; empty: draws the geometry as it is
  std::string fragment{};  ///< text of the fragment shader; empty: keeps every fragment
  std::string vertex_name = "vertex shader", fragment_name = "fragment shader";  ///< for messages
  Mesh geometry{};               ///< triangles, drawn with the attributes position and normal (means at vertices)
  std::size_t vertex_count = 0;  ///< without geometry: vertices to draw, three for each triangle, at most 2^31 - 1
  Box bounds{};                  ///< where the surface is sought, model units; empty: the geometry's
  /// Values of uniforms and macros of both shaders, as in GlslOptions.
  std::map<std::string, std::string> definitions{};
  std::string device{};  ///< as in GlslOptions
};

/// The solid or the surface that a pair of shaders draws, whatever it is to them: fragments are where rays meet it.
///
/// All triangles are drawn orthographically along x, y and z, with a pixel for each ray of the sampling grid, whichever
/// way they face, without a depth test. The fragments that are not discarded are sorted along their ray, and a ray is
/// inside between where it enters and leaves. docs/shaders.md ("Any rasterizer") tells what shaders get and give.
///
/// Guarantee: as a solid it is closed. Fragments without a partner on their ray are left out; where the three
/// directions differ, two of them decide. By the shell method, and by default where they differ mostly, all fragments
/// count and the surface stays open where it is. Vertices are rounded by OpenGL to 1/256 of a pixel, and coordinates to
/// 32-bit floats: keep models near the origin. Cost: each sampling draws all triangles once per 512² rays.
///
/// @throws UnusableInput  "NAME:LINE:COLUMN: what", the line, and a caret: text that does not compile, a texture read,
///                        an attribute that vertices do not have; a loop of more than 65,000 rounds (when sampled)
/// @throws InvalidInput   no bounds, nothing to draw, indices out of range, coordinates that are not finite; no main(),
///                        such device, uniform or macro; a uniform without a value
/// @throws NotAvailable   this build has no OpenGL
Shape shape_from_raster(const RasterOptions& options, std::string name = "raster");

}  // namespace evenmesh
