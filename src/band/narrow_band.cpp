#include "band/narrow_band.h"

#include <algorithm>
#include <array>
#include <string>

#include "band/narrow_band_kernels.h"
#include "core/parallel.h"
#include "evenmesh/error.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr std::size_t blocks_per_piece = 32;
constexpr std::int32_t block = band_block;

/// Site voxels of a tile: the box around them, in voxels of the tile.
struct TileBox {
  std::array<std::int32_t, 3> first, last;
};

TileBox box_of(const VoxelTile& tile) {
  std::uint64_t all = 0;
  unsigned layers = 0;
  for (unsigned z = 0; z < 8; ++z) {
    all |= tile.layers[z];
    if (tile.layers[z] != 0) layers |= 1u << z;
  }
  unsigned columns = 0, rows = 0;
  for (unsigned y = 0; y < 8; ++y) {
    const auto row = static_cast<unsigned>(all >> (8 * y) & 255);
    columns |= row;
    if (row != 0) rows |= 1u << y;
  }
  TileBox box{};
  const std::array<unsigned, 3> used{columns, rows, layers};
  for (std::size_t a = 0; a < 3; ++a) {
    box.first[a] = std::countr_zero(used[a]);
    box.last[a] = 31 - std::countl_zero(used[a]);
  }
  return box;
}

/// Morton codes of the blocks that the shell may reach, sorted.
std::vector<std::uint32_t> blocks_in_reach(const SiteVoxels& sites, unsigned reach, const ExecutionContext& context) {
  constexpr std::size_t tiles_per_piece = 4096;
  const std::size_t pieces = (sites.tiles.size() + tiles_per_piece - 1) / tiles_per_piece;
  std::vector<std::vector<std::uint32_t>> found(pieces);
  const auto r = static_cast<std::int32_t>(reach);
  parallel_tasks(context, pieces, [&](std::size_t piece) {
    std::vector<std::uint32_t>& codes = found[piece];
    for (std::size_t t = piece * tiles_per_piece; t < std::min(sites.tiles.size(), (piece + 1) * tiles_per_piece);
         ++t) {
      const TileBox box = box_of(sites.tiles[t]);
      const Voxel corner = sites.tiles[t].corner();
      std::array<std::int32_t, 3> first{}, last{};
      for (std::size_t a = 0; a < 3; ++a) {
        first[a] = std::max(corner[a] + box.first[a] - r, 0) / block;
        last[a] = std::min(corner[a] + box.last[a] + r, std::int32_t(sites.grid.size[a]) - 1) / block;
      }
      for (std::int32_t k = first[2]; k <= last[2]; ++k)
        for (std::int32_t j = first[1]; j <= last[1]; ++j)
          for (std::int32_t i = first[0]; i <= last[0]; ++i)
            codes.push_back(
                static_cast<std::uint32_t>(morton_code(std::uint64_t(i), std::uint64_t(j), std::uint64_t(k))));
    }
    std::sort(codes.begin(), codes.end());
    codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  });
  std::vector<std::uint32_t> codes;
  for (const auto& list : found) codes.insert(codes.end(), list.begin(), list.end());
  parallel_sort(context, codes);
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  return codes;
}

/// Copies the sites of a tile into the window around the block at `corner`.
void add_tile(const VoxelTile& tile, const Voxel& corner, std::int32_t reach, BandWindow& window) {
  const std::int32_t span = block + 2 * reach;
  const Voxel from = tile.corner();
  const std::int32_t dx = from[0] - corner[0] + reach, dy = from[1] - corner[1] + reach,
                     dz = from[2] - corner[2] + reach;
  const std::uint64_t inside = (std::uint64_t{1} << span) - 1;
  for (std::int32_t z = std::max(0, -dz); z < std::min(8, span - dz); ++z)
    for (std::int32_t y = std::max(0, -dy); y < std::min(8, span - dy); ++y) {
      const std::uint64_t row = tile.layers[std::size_t(z)] >> (8 * y) & 255;
      if (row != 0)
        window.rows[static_cast<std::uint32_t>((dz + z) * span + dy + y)] |= (dx < 0 ? row >> -dx : row << dx) & inside;
    }
}

/// Gathers the sites around a block.
void fill_window(const SiteVoxels& sites, const Voxel& corner, std::int32_t reach, BandWindow& window) {
  const std::int32_t span = block + 2 * reach;
  std::fill_n(window.rows.begin(), span * span, 0);
  std::array<std::int32_t, 3> first{}, last{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = (corner[a] - reach) >> 3;
    last[a] = (corner[a] + block - 1 + reach) >> 3;
    window.size[a] = std::min(band_block, sites.grid.size[a] - static_cast<unsigned>(corner[a]));
  }
  for (std::int32_t k = first[2]; k <= last[2]; ++k)
    for (std::int32_t j = first[1]; j <= last[1]; ++j)
      for (std::int32_t i = first[0]; i <= last[0]; ++i)
        if (const VoxelTile* tile = sites.tiles.find(i, j, k)) add_tile(*tile, corner, reach, window);
}

/// The shell's part of some neighbouring blocks.
struct Piece {
  std::vector<VoxelTile> tiles;
  std::vector<std::size_t> start;  // by tile, into nearest
  std::unique_ptr<NearestSite[]> nearest;
};

class PieceBuilder {
 public:
  PieceBuilder(const SiteVoxels& sites, const BandSteps& steps) : sites_(sites), steps_(steps) {}

  Piece build(const std::uint32_t* codes, std::size_t count) {
    Piece piece;
    collected_.clear();
    for (std::size_t i = 0; i < count; ++i) add_block(codes[i], piece);
    piece.nearest = std::make_unique_for_overwrite<NearestSite[]>(collected_.size());
    std::copy(collected_.begin(), collected_.end(), piece.nearest.get());
    return piece;
  }

 private:
  void add_block(std::uint32_t code, Piece& piece) {
    const auto at = morton_decode(code);
    const Voxel corner{at[0] * block, at[1] * block, at[2] * block};
    fill_window(sites_, corner, std::int32_t(steps_.reach), window_);
    transform_block(steps_, window_, out_);
    for (unsigned t = 0; t < 8; ++t) {
      const BandTileOut& out = out_[t];
      if (out.count == 0) continue;
      VoxelTile tile;
      tile.at = {static_cast<std::uint16_t>(at[0] * 2u + (t & 1)),
                 static_cast<std::uint16_t>(at[1] * 2u + (t >> 1 & 1)),
                 static_cast<std::uint16_t>(at[2] * 2u + (t >> 2))};
      tile.layers = out.layers;
      piece.tiles.push_back(tile);
      piece.start.push_back(collected_.size());
      collected_.insert(collected_.end(), out.nearest.begin(), out.nearest.begin() + out.count);
    }
  }

  const SiteVoxels& sites_;
  const BandSteps& steps_;
  BandWindow window_;
  BandBlockOut out_;
  std::vector<NearestSite> collected_;
};

}  // namespace

NarrowBand build_narrow_band(const SiteVoxels& sites, unsigned reach, ExecutionContext& context) {
  if (reach < 1 || reach > max_band_reach)
    throw InvalidInput("a shell of " + std::to_string(reach) + " voxels is out of range: choose 1 to 20");
  return with_threads(context, [&] {
    const BandSteps steps(reach);
    const std::vector<std::uint32_t> blocks = blocks_in_reach(sites, reach, context);
    std::vector<Piece> pieces((blocks.size() + blocks_per_piece - 1) / blocks_per_piece);
    parallel_for(context, pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
      const auto builder = std::make_unique<PieceBuilder>(sites, steps);
      for (std::size_t p = begin; p < end; ++p)
        pieces[p] = builder->build(&blocks[p * blocks_per_piece],
                                   std::min(blocks_per_piece, blocks.size() - p * blocks_per_piece));
    });
    NarrowBand band;
    band.grid_ = sites.grid;
    band.reach_ = reach;
    std::size_t count = 0;
    for (const Piece& piece : pieces) count += piece.tiles.size();
    std::vector<VoxelTile> tiles;
    tiles.reserve(count);
    band.nearest_.reserve(count);
    band.pieces_.reserve(pieces.size());
    for (Piece& piece : pieces) {
      tiles.insert(tiles.end(), piece.tiles.begin(), piece.tiles.end());
      for (const std::size_t start : piece.start) band.nearest_.push_back(piece.nearest.get() + start);
      band.pieces_.push_back(std::move(piece.nearest));
      piece = {};
    }
    band.tiles_ = VoxelTiles(std::move(tiles));
    return band;
  });
}

std::uint32_t site_index(const SiteVoxels& sites, const Voxel& voxel, NearestSite nearest) {
  const std::optional<std::uint64_t> number = sites.tiles.number(nearest.site(voxel));
  if (!number) throw InvalidInput("the shell was built from other sites: pass those that build_shell() got");
  return static_cast<std::uint32_t>(*number);
}

}  // namespace evenmesh
