#pragma once
/// Drawing with a user's shaders: fragments as lists.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "evenmesh/mesh.h"
#include "gl/buffer.h"
#include "gl/raster_source.h"

namespace evenmesh::gl {

/// One fragment, as raster_fragment.glsl writes it.
struct RasterFragment {
  std::uint32_t pixel = 0;   ///< y · width + x; with `enters_bit` where the ray enters the solid
  float along = 0;           ///< place along the view, −1 to 1 from the grid's first to its last point
  std::uint32_t normal = 0;  ///< as PackedNormal, in the world; all bits: none
};
inline constexpr std::uint32_t enters_bit = 0x80000000u;

/// Rays of one axis, a pixel for each, and what shaders are told of them. Matrices: columns first.
struct RasterView {
  int axis = 0;
  int width = 0, height = 0;  ///< pixels, at most largest_view
  std::array<float, 16> view_projection{}, inverse{};
  std::array<float, 3> direction{}, low{}, high{};
  std::array<std::array<float, 3>, 3> back{};  ///< columns of the matrix from the world to the model
  float pixel_size = 0, cells = 0;             ///< between rays, model units; from the grid's first to its last point
  bool clockwise = false;                      ///< what faces the eye turns clockwise on the screen
};
inline constexpr int largest_view = 512;

/// A pair of shaders with its geometry on a device.
class RasterDevice {
 public:
  /// Compiles; cost about 0.1 s.
  /// @param geometry      triangles; none: `vertex_count` vertices without attributes, three for each triangle
  /// @throws UnusableInput  what the driver says, at its place in the user's text; no memory left
  /// @throws InvalidInput   the vertex shader reads positions, and there is no geometry
  RasterDevice(std::shared_ptr<Context> context, RasterSource source, const Mesh& geometry, std::size_t vertex_count);
  ~RasterDevice();
  RasterDevice(const RasterDevice&) = delete;
  RasterDevice& operator=(const RasterDevice&) = delete;

  /// Draws all triangles, without a depth test and whichever way they face; replaces `fragments` by what was not
  /// discarded, in no order. Draws again where the list was too short.
  /// @return false: more fragments than a buffer holds (11 million on llvmpipe); draw fewer pixels
  /// @throws UnusableInput  a loop that does not end; the driver does not come back
  bool draw(const RasterView& view, std::vector<RasterFragment>& fragments);

 private:
  struct Objects;
  void upload(const Mesh& geometry);
  std::size_t draw_once(const RasterView& view);
  void set_view(const RasterView& view) const;
  void refuse_endless_loops(std::uint32_t vertex_line, std::uint32_t fragment_line) const;

  RasterSource source_;
  std::shared_ptr<Context> context_;
  std::unique_ptr<Objects> objects_;  ///< touched in jobs only
  std::size_t vertex_count_;
};

}  // namespace evenmesh::gl
