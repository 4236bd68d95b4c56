#pragma once
/// Onto the surface of a shape and the balls united with it.

#include <memory>

#include "sample/projector.h"
#include "topology/balls.h"

namespace evenmesh {

/// @param inner  onto the shape; null: its surface is not known
/// @param balls  must outlive the projector
std::unique_ptr<Projector> make_ball_projector(std::unique_ptr<Projector> inner, const BallIndex& balls);

/// Onto the shape, but not where gaps of it were filled: within three grid spacings of the points of the grid that
/// were, points that are farther than one from the shape stay where they are.
/// @param filled   must outlive the projector
/// @param spacing     of the grid
/// @param everywhere  gaps were filled elsewhere, too
std::unique_ptr<Projector> make_filling_projector(std::unique_ptr<Projector> inner, const PointHash& filled,
                                                  double spacing, bool everywhere);

}  // namespace evenmesh
