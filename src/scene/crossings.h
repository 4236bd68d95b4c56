#pragma once
/// Polygons that cross, touch or repeat themselves, as outlines that do not.

#include <cstdint>
#include <vector>

#include "scene/outline.h"

namespace evenmesh {

/// Whether closed paths meet anywhere but where an edge follows another: they cross, touch, or go over an edge twice.
/// @throws UnusableInput  more than 10⁹ pairs of edges lie side by side
bool paths_meet(const std::vector<Contour>& paths);

/// The region inside of an odd number of paths, whatever they cross; nothing where they cancel.
///
/// Edges are cut where they meet, what is there twice cancels, and the rest is walked with the region to the left.
/// Crossings are rounded to 2⁻⁴⁰ of the size, everything else is exact. Walks may touch themselves and each other in
/// points. Cost: O(edges · log edges) and the pairs of edges side by side; O(edges) for each separate piece of border.
/// @throws UnusableInput  too many pairs as above, too many crossings, or they cannot be resolved
Outline untangled(const std::vector<Contour>& paths);

}  // namespace evenmesh
