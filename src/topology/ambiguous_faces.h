#pragma once
/// Places that a grid cannot resolve.

#include <vector>

#include "core/parallel.h"
#include "grid/sample_set.h"

namespace evenmesh {

/// Whether a cube with these inside corners (bit c: corner c, at c & 1, c >> 1 & 1, c >> 2) has a face that is crossed
/// four times.
bool has_diagonal_face(unsigned corners);

/// Centres of the grid cubes with a face whose inside corners lie diagonally: two sheets pass there within one cell, so
/// that it is chance whether the sampled solid is joined or separated. None on a surface whose features are wider than
/// two cells. Cost: about 10 ns per sample and core. Same list for any number of threads.
std::vector<Vec3> find_ambiguous_faces(const SampleSet& samples, ExecutionContext& context);

}  // namespace evenmesh
