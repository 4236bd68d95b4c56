#include "band/moving_least_squares.h"

#include <cmath>
#include <optional>

#include "band/site_parts.h"
#include "geometry/plane_fit.h"

namespace evenmesh {
namespace {

constexpr double reach_in_spacings = 2.5;  ///< of the weights
constexpr double lead_in_spacings = 0.75;  ///< by which the surface may go beyond the middle of its sites, sideways

/// Sites around one tile, relative to its corner, in voxels.
class NearSites {
 public:
  struct Site {
    Vec3 point, normal;
  };
  NearSites(const SiteVoxels& sites, double reach, bool oriented) : sites_(sites), reach_(reach), oriented_(oriented) {}

  void gather(const VoxelTile& around) {
    near_.clear();
    const auto tiles = static_cast<std::int32_t>(std::ceil(reach_ / tile_size));
    for (std::int32_t k = -tiles; k <= tiles; ++k)
      for (std::int32_t j = -tiles; j <= tiles; ++j)
        for (std::int32_t i = -tiles; i <= tiles; ++i)
          if (const VoxelTile* tile = sites_.tiles.find(around.at[0] + i, around.at[1] + j, around.at[2] + k))
            add(*tile, 8.0 * Vec3{double(i), double(j), double(k)});
  }

  struct Plane {
    Vec3 point, normal;  // voxels from the tile's corner
  };
  /// The weighted plane near p; `along` says which way round normals count.
  std::optional<Plane> plane_at(const Vec3& p, const Vec3& along) const {
    Vec3 point, normal;
    double sum = 0;
    for (const Site& s : near_) {
      const double q = 1 - squared_norm(s.point - p) / (reach_ * reach_);
      const bool against = dot(s.normal, along) < 0;
      if (q <= 0 || (against && oriented_)) continue;
      const double w = q * q * q * q;
      point += w * s.point;
      normal += (against ? -w : w) * s.normal;
      sum += w;
    }
    if (!(sum > 0) || !(norm(normal) > 0.2 * sum)) return std::nullopt;
    return Plane{point / sum, normalized(normal)};
  }

 private:
  void add(const VoxelTile& tile, const Vec3& shift) {
    std::uint64_t at = tile.begin;
    for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
      const Vec3 offset = Vec3{sites_.x[at], sites_.y[at], sites_.z[at]} / sites_.grid.side;
      const Vec3 p = shift + Vec3{x + 0.5, y + 0.5, z + 0.5} + offset;
      bool near = true;
      for (int a = 0; a < 3; ++a) near = near && p[a] > -reach_ && p[a] < 8 + reach_;
      if (near) near_.push_back({p, unpack_normal(sites_.normal[at])});
      ++at;
    });
  }

  const SiteVoxels& sites_;
  double reach_;
  bool oriented_;
  std::vector<Site> near_;
};

class Bridge {
 public:
  Bridge(const SiteVoxels& sparse, const NarrowBand& band, double spacing, bool oriented)
      : sparse_(sparse),
        band_(band),
        reach_(reach_in_spacings * spacing / sparse.grid.side),
        lead_(lead_in_spacings * spacing / sparse.grid.side),
        oriented_(oriented) {}

  void tile(std::size_t t, SitePart& part) const {
    const VoxelTile& tile = band_.tiles()[t];
    NearSites near(sparse_, reach_, oriented_);
    near.gather(tile);
    VoxelTile made;
    made.at = tile.at;
    const NearestSite* nearest = band_.nearest(t).data();
    for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
      const NearestSite at = *nearest++;
      const Vec3 p{x + 0.5, y + 0.5, z + 0.5};
      const Voxel v{tile.corner()[0] + std::int32_t(x), tile.corner()[1] + std::int32_t(y),
                    tile.corner()[2] + std::int32_t(z)};
      const Vec3 along = unpack_normal(sparse_.normal[site_index(sparse_, v, at)]);
      const Voxel to = at.offset();
      if (std::abs(dot(Vec3{double(to[0]), double(to[1]), double(to[2])}, along)) > 0.5 * reach_ + 2) return;
      const auto plane = near.plane_at(p, along);
      if (!plane) return;
      const Vec3 n = plane->normal, back = plane->point - p;
      const double height = dot(back, n), touch = 0.5 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
      if (std::abs(height) > touch || squared_norm(back - height * n) > lead_ * lead_) return;
      made.layers[z] |= VoxelTile::bit(x, y);
      const Vec3 foot = sparse_.grid.side * height * n;
      part.x.push_back(static_cast<float>(foot.x));
      part.y.push_back(static_cast<float>(foot.y));
      part.z.push_back(static_cast<float>(foot.z));
      part.normal.push_back(pack_normal(n));
    });
    made.count_layers();
    if (made.count() > 0) part.tiles.push_back(made);
  }

 private:
  const SiteVoxels& sparse_;
  const NarrowBand& band_;
  double reach_, lead_;  // voxels
  bool oriented_;
};

}  // namespace

void estimate_normals(SiteVoxels& sites, unsigned radius, ExecutionContext& context) {
  sites.normal.resize(sites.size());
  const auto r = static_cast<std::int32_t>(radius);
  const auto point_of = [&](const Voxel& v) -> std::optional<Vec3> {
    const auto at = sites.tiles.number(v);
    if (!at) return std::nullopt;
    return sites.grid.center(v) + Vec3{sites.x[*at], sites.y[*at], sites.z[*at]};
  };
  const auto normal_at = [&](const Voxel& v, const Vec3& p) {
    PlaneFit fit;
    for (std::int32_t z = -r; z <= r; ++z)
      for (std::int32_t y = -r; y <= r; ++y)
        for (std::int32_t x = -r; x <= r; ++x) {
          if (x * x + y * y + z * z > r * r) continue;
          const auto q = point_of({v[0] + x, v[1] + y, v[2] + z});
          if (q) fit.add((*q - p) / sites.grid.side);
        }
    return fit.count() < 3 ? Vec3{0, 0, 1} : fit.plane().normal;
  };
  with_threads(context, [&] {
    parallel_for(context, sites.tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const VoxelTile& tile = sites.tiles[t];
        std::uint64_t at = tile.begin;
        for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
          const Voxel v{tile.corner()[0] + std::int32_t(x), tile.corner()[1] + std::int32_t(y),
                        tile.corner()[2] + std::int32_t(z)};
          sites.normal[at] = pack_normal(normal_at(v, *point_of(v)));
          ++at;
        });
      }
    });
  });
}

SiteVoxels moving_least_squares(const SiteVoxels& sparse, const NarrowBand& band, double spacing, bool oriented,
                                ExecutionContext& context) {
  return with_threads(context, [&] {
    constexpr std::size_t tiles_per_part = 64;
    const Bridge bridge(sparse, band, spacing, oriented);
    std::vector<SitePart> parts((band.tiles().size() + tiles_per_part - 1) / tiles_per_part);
    parallel_tasks(context, parts.size(), [&](std::size_t p) {
      for (std::size_t t = p * tiles_per_part; t < std::min(band.tiles().size(), (p + 1) * tiles_per_part); ++t)
        bridge.tile(t, parts[p]);
    });
    return join_parts(sparse.grid, parts, context);
  });
}

}  // namespace evenmesh
