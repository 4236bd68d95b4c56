#pragma once
/// Pictures of meshes without a display, and the HTML report.

#include <cstdint>
#include <string>
#include <vector>

#include "evenmesh/execution_context.h"
#include "evenmesh/mesh.h"
#include "evenmesh/mesh_shape.h"

namespace evenmesh {

struct RenderOptions {
  int width = 1200, height = 900;  ///< pixels, [16, 8192]
  bool wireframe = true;
  bool quality_colours = false;  ///< colour triangles by Q: red (0.5 and less) over yellow to green (1); otherwise grey
                                 ///< with irregular vertices marked
  double azimuth = 30, elevation = 20;  ///< camera direction in degrees
  char up = 'y';                        ///< 'y' or 'z'
  int antialias = 3;                    ///< samples per pixel side, [1, 8]
};

/// 8-bit RGB, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Orthographic picture of the whole mesh. @throws InvalidInput no triangle, or a size out of range
Image render_mesh(const Mesh& mesh, const RenderOptions& options = {},
                  ExecutionContext& context = ExecutionContext::silent());
/// Several pictures beside each other, equal heights assumed.
Image beside(const std::vector<Image>& images);
/// Bytes of a PNG file.
std::string encode_png(const Image& image);

/// One self-contained HTML page: pictures, histograms of angles and of Q, energy per evaluation, time per stage,
/// findings; a cut through the shell where one was kept (Artifacts::shell_cut).
std::string report_html(const MeshResult& result, const std::string& title,
                        ExecutionContext& context = ExecutionContext::silent(), const Artifacts& kept = {});

}  // namespace evenmesh
