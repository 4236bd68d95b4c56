#pragma once
/// Orthographic view of a whole mesh.

#include "evenmesh/mesh.h"
#include "evenmesh/render.h"

namespace evenmesh {

/// Where points of the model appear in the picture. Pixel (0, 0) is the upper left corner of the picture, y goes down.
struct Camera {
  Vec3 right, up, towards;  ///< unit vectors: to the right, up, and from the model to the viewer
  Vec3 center;              ///< model point in the middle of the picture
  double scale = 1;         ///< pixels per model unit
  double width = 0, height = 0;

  /// x, y in pixels; z grows towards the viewer, in model units.
  Vec3 project(const Vec3& p) const {
    const Vec3 d = p - center;
    return {0.5 * width + scale * dot(d, right), 0.5 * height - scale * dot(d, up), dot(d, towards)};
  }
  /// The model point that appears at (x, y), at the depth of `center`.
  Vec3 unproject(double x, double y) const {
    return center + ((x - 0.5 * width) / scale) * right + ((0.5 * height - y) / scale) * up;
  }
};

/// A camera that shows all used vertices with a small margin.
Camera fit_camera(const Mesh& mesh, const RenderOptions& options);

}  // namespace evenmesh
