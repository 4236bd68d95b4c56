#pragma once
/// Where vertices are wanted more densely than elsewhere.

#include <functional>

#include "evenmesh/mesh.h"

namespace evenmesh {

/// How many vertices are wanted per area around a point, compared with elsewhere: above 0 and finite. Callable from
/// several threads at once.
using Density = std::function<double(const Vec3&)>;

}  // namespace evenmesh
