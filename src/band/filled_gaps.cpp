#include "band/filled_gaps.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "core/parallel.h"
#include "geometry/union_find.h"

namespace evenmesh {
namespace {

constexpr double facing = 0.8;     ///< |cosine| between the way across and the normals on both sides
constexpr double min_width = 1.5;  ///< voxels: nearer ones may be neighbours on one sheet
constexpr std::size_t min_faces = 4;
constexpr double nearly_narrowest = 1.25;
constexpr double detour = 1.2;  ///< steps along the surface, over the width, at most: a crease; around a tube it is 1.4

/// The face between two voxels of the shell whose nearest sites face each other.
struct Face {
  std::uint32_t sites[2]{};
  Voxel at{}, ends[2]{};
  std::uint32_t squared_distance = 0;  ///< the shell reaches both when d² is as much
  double width = 0;                    ///< model units
};

class Gaps {
 public:
  Gaps(const NarrowBand& band, const SiteVoxels& sites, ExecutionContext& context)
      : band_(band), sites_(sites), context_(context) {}

  std::vector<FilledGap> result() {
    const std::vector<Face> faces = find_faces();
    const std::vector<std::vector<std::size_t>> groups = connected(faces);
    std::vector<FilledGap> gaps(groups.size());
    parallel_tasks(context_, groups.size(), [&](std::size_t g) { gaps[g] = gap_of(faces, groups[g]); });
    std::erase_if(gaps, [](const FilledGap& gap) { return gap.sites.empty(); });
    return gaps;
  }

 private:
  std::vector<Face> find_faces() const {
    const VoxelTiles& tiles = band_.tiles();
    std::vector<std::vector<Face>> found((tiles.size() + 63) / 64);
    parallel_tasks(context_, found.size(), [&](std::size_t piece) {
      for (std::size_t t = 64 * piece; t < std::min(tiles.size(), 64 * (piece + 1)); ++t) add_faces(t, found[piece]);
    });
    std::vector<Face> faces;
    for (const auto& list : found) faces.insert(faces.end(), list.begin(), list.end());
    return faces;
  }

  void add_faces(std::size_t t, std::vector<Face>& faces) const {
    const VoxelTile& tile = band_.tiles()[t];
    const Voxel corner = tile.corner();
    const NearestSite* nearest = band_.nearest(t).data();
    const NearestSite* each = nearest;
    for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
      const NearestSite own = *each++;
      const Voxel to = own.offset();
      for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned i = x + (axis == 0), j = y + (axis == 1), k = z + (axis == 2);
        const NearestSite* other = nullptr;
        if (i < tile_size && j < tile_size && k < tile_size) {
          if (tile.contains(i, j, k)) other = axis == 0 ? each : nearest + tile.rank(i, j, k);
        } else {
          other = band_.find({corner[0] + std::int32_t(i), corner[1] + std::int32_t(j), corner[2] + std::int32_t(k)});
        }
        if (other == nullptr) continue;
        Voxel apart = other->offset();
        ++apart[axis];
        for (std::size_t a = 0; a < 3; ++a) apart[a] -= to[a];
        if (apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2] < 4) continue;  // most: neighbouring sites
        const Voxel at{corner[0] + std::int32_t(x), corner[1] + std::int32_t(y), corner[2] + std::int32_t(z)};
        Voxel next = at;
        ++next[axis];
        add_face(at, next, own, *other, faces);
      }
    });
  }

  void add_face(const Voxel& at, const Voxel& next, NearestSite own, NearestSite other,
                std::vector<Face>& faces) const {
    Face face{.at = at};
    face.sites[0] = site_index(sites_, at, own);
    face.sites[1] = site_index(sites_, next, other);
    face.ends[0] = own.site(at);
    face.ends[1] = other.site(next);
    const Vec3 way = point(face, 1) - point(face, 0);
    face.width = norm(way);
    if (face.width < min_width * band_.grid().side) return;
    for (const std::uint32_t site : face.sites)
      if (std::abs(dot(way, unpack_normal(sites_.normal[site]))) < facing * face.width) return;
    face.squared_distance = std::max(own.squared_distance(), other.squared_distance());
    faces.push_back(face);
  }

  Vec3 point(const Face& face, std::size_t end) const {
    const std::uint32_t s = face.sites[end];
    return band_.grid().center(face.ends[end]) + Vec3{sites_.x[s], sites_.y[s], sites_.z[s]};
  }

  /// Faces grouped by voxels that touch, in the order of their first.
  static std::vector<std::vector<std::size_t>> connected(const std::vector<Face>& faces) {
    UnionFind sets(faces.size());
    const auto key = [](const Voxel& v) {
      return std::uint64_t(v[0]) << 42 | std::uint64_t(v[1]) << 21 | std::uint64_t(v[2]);
    };
    std::unordered_map<std::uint64_t, std::uint32_t> first;
    for (std::uint32_t i = 0; i < faces.size(); ++i) first.emplace(key(faces[i].at), i);
    for (std::uint32_t i = 0; i < faces.size(); ++i)
      for (std::int32_t z = -1; z <= 1; ++z)
        for (std::int32_t y = -1; y <= 1; ++y)
          for (std::int32_t x = -1; x <= 1; ++x) {
            const Voxel& v = faces[i].at;
            const auto other = first.find(key({v[0] + x, v[1] + y, v[2] + z}));
            if (other != first.end()) sets.unite(i, other->second);
          }
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::size_t> group(faces.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      const std::uint32_t r = sets.find(i);
      if (r == i) {
        group[i] = groups.size();
        groups.emplace_back();
      }
      groups[group[r]].push_back(i);
    }
    std::erase_if(groups, [](const auto& g) { return g.size() < min_faces; });
    return groups;
  }

  FilledGap gap_of(const std::vector<Face>& faces, const std::vector<std::size_t>& group) const {
    const auto narrowest = std::min_element(group.begin(), group.end(), [&](std::size_t a, std::size_t b) {
      return faces[a].width != faces[b].width ? faces[a].width < faces[b].width : a < b;
    });
    if (std::all_of(group.begin(), group.end(), [&](std::size_t f) {
          return faces[f].width > nearly_narrowest * faces[*narrowest].width || joined(faces[f]);
        }))
      return {};
    FilledGap gap;
    gap.width = faces[*narrowest].width;
    gap.middle = band_.grid().center(faces[*narrowest].at);
    std::uint32_t least = 0xffffffffu;
    for (const std::size_t f : group) {
      least = std::min(least, faces[f].squared_distance);
      gap.sites.insert(gap.sites.end(), {faces[f].sites[0], faces[f].sites[1]});
    }
    while ((gap.kept_apart + 1) * (gap.kept_apart + 1) < least) ++gap.kept_apart;
    std::sort(gap.sites.begin(), gap.sites.end());
    gap.sites.erase(std::unique(gap.sites.begin(), gap.sites.end()), gap.sites.end());
    return gap;
  }

  /// Whether a short way along the sites leads from one side of the face to the other.
  bool joined(const Face& face) const {
    const int steps = std::max(3, static_cast<int>(detour * face.width / band_.grid().side));
    std::unordered_set<std::uint64_t> seen{*sites_.tiles.number(face.ends[0])};
    std::vector<Voxel> front{face.ends[0]}, next;
    for (int step = 0; step < steps && !front.empty(); ++step, front.swap(next), next.clear())
      for (const Voxel& v : front)
        for (std::int32_t z = -1; z <= 1; ++z)
          for (std::int32_t y = -1; y <= 1; ++y)
            for (std::int32_t x = -1; x <= 1; ++x) {
              const Voxel w{v[0] + x, v[1] + y, v[2] + z};
              const auto number = sites_.tiles.number(w);
              if (!number || !seen.insert(*number).second) continue;
              if (w == face.ends[1]) return true;
              next.push_back(w);
            }
    return false;
  }

  const NarrowBand& band_;
  const SiteVoxels& sites_;
  ExecutionContext& context_;
};

}  // namespace

std::vector<FilledGap> filled_gaps(const NarrowBand& band, const SiteVoxels& sites, ExecutionContext& context) {
  if (sites.normal.empty()) return {};
  return with_threads(context, [&] { return Gaps(band, sites, context).result(); });
}

}  // namespace evenmesh
