#include "sample/rays.h"

#include <algorithm>

namespace evenmesh {
namespace {

constexpr float same_place = 0x1p-14f;  ///< cells: vertices are rounded to 2^-16

bool before(const RayHit& a, const RayHit& b) {
  if (a.cell != b.cell) return a.cell < b.cell;
  if (a.t != b.t) return a.t < b.t;
  return a.source < b.source;
}

// Hit that finds no partner of the opposite step when pairs are matched like brackets: the one that a hole in the
// surface left alone. There is one, since the steps do not sum to 0.
std::size_t unmatched(std::span<const RayHit> hits) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!open.empty() && hits[open.back()].step != hits[i].step)
      open.pop_back();
    else
      open.push_back(i);
  }
  return open.front();
}

// Makes the steps sum to 0; returns the hits that remain.
std::span<RayHit> close_ray(std::span<RayHit> hits) {
  if (hits.size() % 2 == 1) {
    const std::size_t lone = unmatched(hits);
    std::copy(hits.begin() + static_cast<std::ptrdiff_t>(lone) + 1, hits.end(),
              hits.begin() + static_cast<std::ptrdiff_t>(lone));
    hits = hits.first(hits.size() - 1);
    int sum = 0;
    for (const RayHit& hit : hits) sum += hit.step;
    if (sum == 0) return hits;
  }
  std::int8_t step = -1;
  for (RayHit& hit : hits) hit.step = step = static_cast<std::int8_t>(-step);
  return hits;
}

}  // namespace

void sort_hits(std::span<RayHit> hits) {
  if (hits.size() > 24) {
    std::stable_sort(hits.begin(), hits.end(), before);
    return;
  }
  for (std::size_t i = 1; i < hits.size(); ++i) {
    if (!before(hits[i], hits[i - 1])) continue;
    const RayHit hit = hits[i];
    std::size_t j = i;
    for (; j > 0 && before(hit, hits[j - 1]); --j) hits[j] = hits[j - 1];
    hits[j] = hit;
  }
}

void resolve_ray(std::span<RayHit> hits, Winding rule, std::vector<DexelCrossing>& out, RayCounts& counts) {
  int sum = 0;
  for (const RayHit& hit : hits) sum += hit.step;
  if (sum != 0) hits = close_ray(hits);
  int winding = 0;
  const RayHit* before = nullptr;  // the crossing appended last
  const auto is_inside = [&] { return rule == Winding::any ? winding != 0 : winding > 0; };
  for (std::size_t i = 0; i < hits.size();) {
    const bool inside = is_inside();
    const std::uint16_t cell = hits[i].cell;
    std::size_t changes = 0, last = i;
    float last_change = -1;
    for (; i < hits.size() && hits[i].cell == cell; ++i) {
      const bool was_inside = is_inside();
      winding += hits[i].step;
      if (is_inside() == was_inside) continue;
      // Two at once are faces of bodies that touch: nothing lies between.
      const bool at_once = changes > 0 && hits[i].t - last_change <= same_place;
      changes = at_once ? changes - 1 : changes + 1;
      // Of two changes nothing is left; of three the last.
      if (!at_once && changes % 2 == 0) counts.near.push_back({hits[last], hits[i], !was_inside, false, 0});
      last_change = hits[i].t;
      last = i;
    }
    // The change that counts is the last one: it is next to the upper grid point's side.
    const bool changed = is_inside() != inside;
    counts.unresolved += changes - (changed ? 1 : 0);
    if (!changed) continue;
    if (before && before->cell + 1 == cell && hits[last].t < before->t)
      counts.near.push_back({*before, hits[last], !inside, true, 0});
    before = &hits[last];
    out.push_back({hits[last].source, hits[last].t, cell, !inside, hits[last].synthetic});
    counts.capped = counts.capped || hits[last].synthetic;
  }
}

std::vector<ThinSpot> thin_spots(std::span<const NearPair> pairs, const Grid& grid, int axis, std::uint32_t slab,
                                 const std::function<Vec3(std::uint32_t)>& normal_of) {
  std::vector<ThinSpot> spots;
  const auto a = static_cast<std::size_t>(axis);
  for (const NearPair& pair : pairs) {
    const auto place = [&](const RayHit& hit) {
      std::array<double, 3> at{};
      at[a] = hit.cell + double(hit.t);
      const std::uint32_t p = pair.ray / brick_size;
      at[static_cast<std::size_t>(dexel_p_axis[a])] = p;
      at[static_cast<std::size_t>(dexel_q_axis[a])] = slab * brick_size + pair.ray % brick_size;
      return grid.point(at[0], at[1], at[2]);
    };
    if (const auto spot = thin_spot(place(pair.from), place(pair.to), normal_of(pair.from.source),
                                    normal_of(pair.to.source), axis, grid.spacing, pair.gap))
      spots.push_back({spot->place, spot->thickness, spot->area, spot->gap, pair.sampled});
  }
  return spots;
}

}  // namespace evenmesh
