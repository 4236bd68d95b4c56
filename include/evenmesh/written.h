#pragma once
/// What of a result a file holds.

#include "evenmesh/execution_context.h"
#include "evenmesh/io.h"
#include "evenmesh/mesh_shape.h"

namespace evenmesh {

/// The result as a file of the format has it: where its coordinates differ by more than 1e-4 edges, the vertices are
/// the file's, quality and self-intersections are measured again, and findings say so. Otherwise the result as it is.
///
/// Cost: some nanoseconds per triangle, or that of measuring.
MeshResult as_written(MeshResult result, MeshFormat format, ExecutionContext& context = ExecutionContext::silent());

}  // namespace evenmesh
