#pragma once
/// Where triangles of a mesh are not what they should be.

#include <optional>
#include <string>

#include "evenmesh/execution_context.h"
#include "evenmesh/findings.h"
#include "evenmesh/mesh.h"

namespace evenmesh {

/// The first triangle that intersects another one or has no area, as the code says; none for other codes, and where the
/// mesh has none.
std::optional<Vec3> place_of_fault(const Mesh& mesh, FindingCode code, ExecutionContext& context);

/// ", first at (x, y, z)"
std::string where(const Vec3& place);

}  // namespace evenmesh
