#pragma once
/// Flat shapes cut where they cross: polygons that cross themselves, unions, intersections, differences.

#include <cstdint>
#include <vector>

#include "scene/outline.h"

namespace evenmesh {

/// Whether closed paths meet anywhere but where an edge follows another: they cross, touch, or go over an edge twice.
/// @throws UnusableInput  more than 3·10⁸ pairs of edges lie side by side
bool paths_meet(const std::vector<Contour>& paths);

/// The region inside of an odd number of paths, whatever they cross; nothing where they cancel.
///
/// Edges are cut where they meet; those with the region on one side only are walked, the region to the left.
/// Crossings are rounded to 2⁻⁴⁰ of the size, everything else is exact. Walks may touch themselves and each other in
/// points. Cost: O(edges · log edges) and the pairs of edges side by side; O(edges) for each separate piece of border.
/// @throws UnusableInput  too many pairs as above, too many crossings, or they cannot be resolved
Outline untangled(const std::vector<Contour>& paths);

enum class FlatSet { unite, intersect, subtract };

/// Outlines combined in the same way: the first without all others where they are subtracted. Throws likewise.
Outline combined(FlatSet set, const std::vector<Outline>& outlines);

}  // namespace evenmesh
