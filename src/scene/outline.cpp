#include "scene/outline.h"

#include <algorithm>
#include <cstdint>

#include "evenmesh/error.h"
#include "scene/crossings.h"

namespace evenmesh {
namespace {

Contour without_repeats(const Contour& path) {
  Contour kept;
  for (const Point2& p : path)
    if (kept.empty() || !same_place(kept.back(), p)) kept.push_back(p);
  while (kept.size() > 1 && same_place(kept.front(), kept.back())) kept.pop_back();
  return kept;
}

}  // namespace

Outline outline_of_paths(std::vector<Contour> paths) {
  Outline outline;
  std::vector<Contour>& contours = outline.contours;
  for (const Contour& path : paths) {
    Contour contour = without_repeats(path);
    if (contour.size() >= 3) contours.push_back(std::move(contour));
  }
  if (contours.size() > 1 && static_cast<double>(contours.size()) * static_cast<double>(outline.points()) > 1e9) {
    throw UnusableInput("has too many paths; split the polygon");
  }
  if (paths_meet(contours)) return untangled(contours);
  for (std::size_t i = 0; i < contours.size(); ++i) {
    bool hole = false;
    for (std::size_t j = 0; j < contours.size(); ++j)
      if (i != j && encloses(contours[j], contours[i].front())) hole = !hole;
    if ((twice_area(contours[i]) < 0) != hole) std::reverse(contours[i].begin(), contours[i].end());
  }
  return outline;
}

namespace {

/// Signed triangles around the first point of each contour.
std::vector<Triangle> fans(const Outline& outline) {
  std::vector<Triangle> triangles;
  std::uint32_t first = 0;
  for (const Contour& contour : outline.contours) {
    const auto n = static_cast<std::uint32_t>(contour.size());
    for (std::uint32_t i = 1; i + 1 < n; ++i) triangles.push_back({first, first + i, first + i + 1});
    first += n;
  }
  return triangles;
}

}  // namespace

std::vector<Triangle> fill(const Outline& outline) {
  constexpr std::size_t max_contours = 2000;  // each is compared with each
  if (outline.contours.size() > max_contours) return fans(outline);
  std::size_t steps = 400'000'000;
  return ear_clipped(outline, steps).value_or(fans(outline));
}

}  // namespace evenmesh
