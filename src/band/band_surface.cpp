#include "band/band_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "evenmesh/error.h"
#include "grid/blocks.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

using Layers = std::array<std::uint64_t, 8>;  // as in VoxelTile

/// One brick's crossed edges, by axis and z: bit 8y + x.
struct Brick {
  std::array<std::uint16_t, 3> at{};
  Layers inside{};
  std::array<Layers, 3> crossed{};

  std::uint32_t count() const {
    int n = 0;
    for (const Layers& axis : crossed)
      for (const std::uint64_t layer : axis) n += std::popcount(layer);
    return static_cast<std::uint32_t>(n);
  }
};

Layers layers_at(const VoxelTiles& tiles, int i, int j, int k) {
  const VoxelTile* tile = tiles.find(i, j, k);
  return tile != nullptr ? tile->layers : Layers{};
}

Brick brick_at(const VoxelTiles& tiles, std::uint64_t code) {
  Brick brick;
  brick.at = morton_decode(code);
  const int i = brick.at[0], j = brick.at[1], k = brick.at[2];
  brick.inside = layers_at(tiles, i, j, k);
  const Layers x = layers_at(tiles, i + 1, j, k), y = layers_at(tiles, i, j + 1, k), z = layers_at(tiles, i, j, k + 1);
  constexpr std::uint64_t first_column = 0x0101010101010101ull, first_row = 0xffull;
  for (std::size_t l = 0; l < 8; ++l) {
    const std::uint64_t own = brick.inside[l];
    brick.crossed[0][l] = own ^ ((own >> 1 & ~(first_column << 7)) | (x[l] & first_column) << 7);
    brick.crossed[1][l] = own ^ (own >> 8 | (y[l] & first_row) << 56);
    brick.crossed[2][l] = own ^ (l < 7 ? brick.inside[l + 1] : z[0]);
  }
  return brick;
}

/// Morton codes of the bricks in which an edge to or from a voxel of the shell may start.
std::vector<std::uint64_t> brick_codes(const VoxelTiles& tiles) {
  std::vector<std::uint64_t> codes;
  codes.reserve(2 * tiles.size());
  for (const VoxelTile& tile : tiles) {
    const unsigned at[3] = {tile.at[0], tile.at[1], tile.at[2]};
    codes.push_back(morton_code(at[0], at[1], at[2]));
    for (unsigned a = 0; a < 3; ++a)
      if (at[a] > 0) codes.push_back(morton_code(at[0] - (a == 0), at[1] - (a == 1), at[2] - (a == 2)));
  }
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  return codes;
}

class Writer {
 public:
  Writer(const NarrowBand& band, const SiteVoxels& sites, BandSurface& out) : band_(band), sites_(sites), out_(out) {}

  void write(const Brick& brick, SampleBlock& block) const {
    std::uint32_t at = block.begin;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (axis > 0) block.axis_begin[axis - 1] = at;
      for (unsigned i = 0; i < 8; ++i)
        for (unsigned j = 0; j < 8; ++j)
          for (unsigned k = 0; k < 8; ++k)
            if ((brick.crossed[axis][k] & VoxelTile::bit(i, j)) != 0)
              write({axis, i, j, k, (brick.inside[k] & VoxelTile::bit(i, j)) != 0}, block, at++);
    }
  }

 private:
  void write(EdgeCode code, const SampleBlock& block, std::uint32_t at) const {
    const double h = band_.grid().side;
    Voxel lower{static_cast<std::int32_t>(8 * block.brick[0] + code.i()),
                static_cast<std::int32_t>(8 * block.brick[1] + code.j()),
                static_cast<std::int32_t>(8 * block.brick[2] + code.k())};
    Voxel upper = lower;
    ++upper[code.axis()];
    const bool up = code.lower_end_inside();
    const Voxel &in = up ? lower : upper, &beyond = up ? upper : lower;
    const NearestSite nearest = *band_.find(in);
    const std::uint32_t site = site_index(sites_, in, nearest);
    const Vec3 p = band_.grid().center(nearest.site(in)) + Vec3{sites_.x[site], sites_.y[site], sites_.z[site]};
    const Vec3 out = band_.grid().center(beyond) - p;
    Vec3 n = unpack_normal(sites_.normal[site]);
    const double facing = dot(normalized(out), n);
    if (facing < 0) n = -n;
    // Where the edge leaves the slab of the shell's thickness around the tangent plane.
    const Vec3 from = band_.grid().center(in) - p;
    double t = 0.5;
    if (std::abs(facing) >= clearly_facing) {
      const double slope = h * (up ? n[int(code.axis())] : -n[int(code.axis())]);
      if (slope > 0.2 * h) t = std::clamp(((band_.reach() + 0.5) * h - dot(from, n)) / slope, 0.0, 1.0);
    } else {
      n = normalized(out);
    }
    SampleSet& set = out_.samples;
    const Vec3 local = p + from + t * (out - from) - set.block_center(block);
    set.x[at] = static_cast<float>(local.x);
    set.y[at] = static_cast<float>(local.y);
    set.z[at] = static_cast<float>(local.z);
    set.area[at] = static_cast<float>(sample_area(n, static_cast<int>(code.axis()), h));
    set.normal[at] = pack_normal(n);
    set.edge[at] = code;
    if (!set.source.empty()) set.source[at] = sites_.source[site];
    out_.site[at] = site;
    out_.facing[at] = static_cast<float>(facing);
  }

  const NarrowBand& band_;
  const SiteVoxels& sites_;
  BandSurface& out_;
};

}  // namespace

BandSurface band_surface(const NarrowBand& band, const SiteVoxels& sites, ExecutionContext& context) {
  return with_threads(context, [&] {
    BandSurface surface;
    SampleSet& set = surface.samples;
    set.grid = {band.grid().center({0, 0, 0}), band.grid().side, band.grid().size};
    const std::vector<std::uint64_t> codes = brick_codes(band.tiles());
    std::vector<std::uint32_t> count(codes.size());
    parallel_for(context, codes.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) count[b] = brick_at(band.tiles(), codes[b]).count();
    });
    std::size_t total = 0;
    for (std::size_t b = 0; b < codes.size(); ++b) {
      if (count[b] == 0) continue;
      const auto begin = static_cast<std::uint32_t>(total);
      set.blocks.push_back({begin, begin + count[b], morton_decode(codes[b]), {}});
      total += count[b];
    }
    if (total == 0) throw UnusableInput("the shell is empty: the input has no surface within the bounds");
    resize_samples(set, total, !sites.source.empty(), context);
    surface.site.resize(total);
    surface.facing.resize(total);
    const Writer writer(band, sites, surface);
    parallel_for(context, set.blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const auto& at = set.blocks[b].brick;
        writer.write(brick_at(band.tiles(), morton_code(at[0], at[1], at[2])), set.blocks[b]);
      }
    });
    sum_area(set, context);
    return surface;
  });
}

SampleSet drawn_onto_surface(SampleSet set, std::span<const std::uint32_t> index, const BandSurface& surface,
                             const SiteVoxels& sites, ExecutionContext& context) {
  const double h = sites.grid.side;
  std::vector<Vec3> center(sites.size());
  for (const VoxelTile& tile : sites.tiles) {
    std::uint64_t at = tile.begin;
    const Voxel c = tile.corner();
    for_each_voxel(tile, [&](unsigned x, unsigned y, unsigned z) {
      center[at++] = sites.grid.center({c[0] + std::int32_t(x), c[1] + std::int32_t(y), c[2] + std::int32_t(z)});
    });
  }
  parallel_for(context, set.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Vec3 origin = set.block_center(set.blocks[b]);
      for (std::uint32_t i = set.blocks[b].begin; i < set.blocks[b].end; ++i) {
        const std::uint32_t s = surface.site[index[i]];
        const Vec3 p = center[s] + Vec3{sites.x[s], sites.y[s], sites.z[s]}, n = unpack_normal(set.normal[i]);
        Vec3 beside;
        if (std::abs(surface.facing[index[i]]) >= clearly_facing) {
          beside = origin + Vec3{set.x[i], set.y[i], set.z[i]} - p;
          beside -= dot(beside, n) * n;
          const double length = norm(beside);
          if (length > h) beside *= h / length;
        }
        const Vec3 local = p + beside - origin;
        set.x[i] = static_cast<float>(local.x);
        set.y[i] = static_cast<float>(local.y);
        set.z[i] = static_cast<float>(local.z);
      }
    }
  });
  return set;
}

}  // namespace evenmesh
