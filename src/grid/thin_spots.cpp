#include "grid/thin_spots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/union_find.h"
#include "grid/sample_set.h"

namespace evenmesh {
namespace {

constexpr double opposite_sides = -0.5;  ///< cosine between the outward normals of both sides, at most
constexpr double grazing = 0.3;          ///< |n_axis|: rays that meet the surface flatter tell nothing
constexpr double touching = 0.005;       ///< cells: more than fields' crossings are off
constexpr double contact = 0.05;         ///< cells: gaps narrower than this are between parts that touch,
constexpr double contact_share = 0.1;    ///< where they make so much of a part's area
constexpr double wide_share = 0.25;      ///< of a brick's face

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const Vec3& p, const Vec3& origin, double side) {
  Cell cell{};
  for (int a = 0; a < 3; ++a) cell[std::size_t(a)] = std::int64_t(std::floor((p[a] - origin[a]) / side));
  return cell;
}

/// The thickness up to which a share of the area lies. @pre  sorted by thickness, not empty
double quantile(const std::vector<const ThinSpot*>& sorted, double share, double total) {
  double passed = 0;
  for (const ThinSpot* spot : sorted)
    if ((passed += spot->area) >= share * total) return spot->thickness;
  return sorted.back()->thickness;
}

/// Spots by cell, and the parts of which each is connected across cells.
class Parts {
 public:
  struct Content {
    std::uint32_t part = 0;
    double area = 0, contact = 0;  ///< contact: of that, gaps narrower than asked for
    Box box;
  };

  Parts(const std::vector<ThinSpot>& spots, const Vec3& origin, double side, double narrow)
      : origin_(origin), side_(side) {
    for (const ThinSpot& spot : spots) {
      const auto number = static_cast<std::uint32_t>(cells_.size());
      Content& content = cells_.insert({cell_of(spot.place, origin, side), Content{number, 0, 0, {}}}).first->second;
      content.area += spot.area;
      content.contact += spot.gap && spot.thickness < narrow ? spot.area : 0;
      content.box.add(spot.place);
    }
    UnionFind joined(cells_.size());
    for (const auto& [cell, content] : cells_) join_neighbours(cell, content.part, joined);
    for (auto& [cell, content] : cells_) {
      content.part = joined.find(content.part);
      Content& part = parts_[content.part];
      part.area += content.area;
      part.contact += content.contact;
      part.box.add(content.box.lo);
      part.box.add(content.box.hi);
    }
  }

  const Content& cell_at(const Vec3& p) const { return cells_.at(cell_of(p, origin_, side_)); }
  const Content& part_at(const Vec3& p) const { return parts_.at(cell_at(p).part); }
  std::size_t size() const { return parts_.size(); }
  const Content& largest() const {
    const auto smaller = [](const auto& a, const auto& b) { return a.second.area < b.second.area; };
    return std::max_element(parts_.begin(), parts_.end(), smaller)->second;
  }

 private:
  void join_neighbours(const Cell& cell, std::uint32_t number, UnionFind& joined) const {
    for (int k = 0; k < 27; ++k) {
      const auto other = cells_.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (other != cells_.end()) joined.unite(number, other->second.part);
    }
  }

  Vec3 origin_;
  double side_;
  std::map<Cell, Content> cells_;
  std::map<std::uint32_t, Content> parts_;
};

}  // namespace

std::optional<ThinSpot> thin_spot(const Vec3& from, const Vec3& to, const Vec3& from_normal, const Vec3& to_normal,
                                  int axis, double spacing, bool gap) {
  const double along = std::abs(to[axis] - from[axis]);
  const double steep = 0.5 * (std::abs(from_normal[axis]) + std::abs(to_normal[axis]));
  // The surface is crossed from outside to inside and back, so that the outward normals run against each other.
  const bool same_way = (from_normal[axis] > 0) == (to_normal[axis] > 0);
  const double facing = dot(from_normal, to_normal) * (same_way ? -1 : 1);
  if (facing > opposite_sides || steep < grazing) return std::nullopt;
  if (!gap && along < touching * spacing) return std::nullopt;
  return ThinSpot{0.5 * (from + to), static_cast<float>(along * steep), static_cast<float>(spacing * spacing * steep),
                  gap, false};
}

std::vector<ThinSpot> wide_spots(const std::vector<ThinSpot>& spots, const Vec3& origin, double spacing) {
  const double side = brick_size * spacing;
  const Parts parts(spots, origin, side, contact * spacing);
  std::vector<ThinSpot> wide;
  for (const ThinSpot& spot : spots) {
    const Parts::Content& part = parts.part_at(spot.place);
    const bool touches = spot.gap && part.contact > contact_share * part.area;
    if (!touches && parts.cell_at(spot.place).area > wide_share * side * side) wide.push_back(spot);
  }
  return wide;
}

ThinParts thin_parts(const std::vector<ThinSpot>& spots, double reach) {
  ThinParts parts;
  if (spots.empty()) return parts;
  double gaps = 0;
  std::vector<const ThinSpot*> sorted;
  for (const ThinSpot& spot : spots) {
    sorted.push_back(&spot);
    parts.area += spot.area;
    gaps += spot.gap ? spot.area : 0;
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const ThinSpot* a, const ThinSpot* b) { return a->thickness < b->thickness; });
  parts.thickness = quantile(sorted, 0.5, parts.area);
  parts.least = quantile(sorted, 0.1, parts.area);
  parts.gaps = 2 * gaps > parts.area;
  const Parts connected(spots, {}, reach, 0);
  parts.parts = connected.size();
  parts.largest = connected.largest().box;
  return parts;
}

}  // namespace evenmesh
