#pragma once
/// Onto the surface of a shape and the balls united with it.

#include <memory>

#include "sample/projector.h"
#include "topology/balls.h"

namespace evenmesh {

/// @param inner  onto the shape; null: its surface is not known
/// @param balls  must outlive the projector
std::unique_ptr<Projector> make_ball_projector(std::unique_ptr<Projector> inner, const BallIndex& balls);

/// Onto the shape, but not where gaps of it were filled: within these places, points that are farther than
/// `near` (model units) from the shape stay where they are.
std::unique_ptr<Projector> make_filling_projector(std::unique_ptr<Projector> inner, const BallIndex& places,
                                                  double near);

}  // namespace evenmesh
