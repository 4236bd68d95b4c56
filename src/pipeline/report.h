#pragma once
/// What a run did, put together from the values that its stages returned.

#include "pipeline/lost_parts.h"
#include "pipeline/refine.h"

namespace evenmesh {

/// Measures the mesh, and says of it what is not as promised or asked for.
MeshResult measure(Refined refined, const Draft& draft, const Tessellation& cells, LostParts lost,
                   const MeshOptions& options, StageTimer& timer, ExecutionContext& context);

}  // namespace evenmesh
