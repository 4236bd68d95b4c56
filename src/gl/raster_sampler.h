#pragma once
/// What shaders draw, as samples of a solid or a surface.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "gl/raster_device.h"
#include "grid/tri_dexel.h"
#include "shape/ray_source.h"

namespace evenmesh::gl {

class RasterSampler final : public RaySource {
 public:
  /// @param bounds  of the model, what shaders are told
  RasterSampler(std::shared_ptr<RasterDevice> device, std::string name, const Box& bounds, const Affine& placement = {})
      : device_(std::move(device)), name_(std::move(name)), bounds_(bounds), placement_(placement) {}

  SampleSet sample(const Grid& grid, const Box& bounds, ExecutionContext& execution) const override;
  SampleSet sample_surface(const Grid& grid, const Box& bounds, ExecutionContext& execution) const override;
  double solidity(const Box& bounds, ExecutionContext& execution) const override;
  std::shared_ptr<const RaySource> moved(const Affine& transform) const override;

  /// The crossings, and the normals that they count. Cost: two passes of drawing per 512² rays at most, then sorting.
  TriDexel scan(const Grid& grid, const Box& bounds, std::vector<PackedNormal>& normals,
                ExecutionContext& execution) const;

 private:
  struct Drawing {
    std::array<DexelAxis, 3> found;     ///< all that rays meet
    TriDexel occupancy;                 ///< the solid that each direction sees by itself
    std::vector<PackedNormal> normals;  ///< counted by crossings
  };
  Drawing draw(const Grid& grid, const Box& bounds, ExecutionContext& execution) const;

  std::shared_ptr<RasterDevice> device_;
  std::string name_;
  Box bounds_;
  Affine placement_;  ///< of the model in the world
};

}  // namespace evenmesh::gl
