#include "band/narrow_band_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "band/narrow_band_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace evenmesh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<std::int32_t, 8>;
using V = hn::Vec<D>;

constexpr std::size_t lanes = hn::MaxLanes(D());
constexpr std::size_t parts = band_block / lanes;

HWY_INLINE V load(const std::uint32_t* from) {
  return hn::Load(D(), reinterpret_cast<const std::int32_t*>(from));
}

/// Least keys of a row of 16 voxels.
struct Row {
  V part[parts];

  HWY_INLINE Row() {
    for (std::size_t i = 0; i < parts; ++i) part[i] = hn::Set(D(), static_cast<std::int32_t>(BandSteps::none));
  }
  HWY_INLINE void add(const std::uint32_t* keys, std::uint32_t step) {
    const V by = hn::Set(D(), static_cast<std::int32_t>(step));
    for (std::size_t i = 0; i < parts; ++i) part[i] = hn::Min(part[i], hn::Add(load(keys + i * lanes), by));
  }
  HWY_INLINE void add(const std::uint32_t* keys) {
    for (std::size_t i = 0; i < parts; ++i) part[i] = hn::Min(part[i], load(keys + i * lanes));
  }
  HWY_INLINE void store(std::uint32_t* to) const {
    for (std::size_t i = 0; i < parts; ++i) hn::Store(part[i], D(), reinterpret_cast<std::int32_t*>(to) + i * lanes);
  }
};

HWY_INLINE unsigned lowest_bit(std::uint64_t bits) {
  return static_cast<unsigned>(__builtin_ctzll(bits));
}

/// Appends the keys of a row that are below the limits to its two tiles.
HWY_INLINE void keep(const Row& row, const std::uint32_t* limits, unsigned y, unsigned z, BandTileOut* tiles) {
  std::uint64_t bits[2] = {};
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t x = i * lanes;
    BandTileOut& tile = tiles[x / 8];
    const auto within = hn::Lt(row.part[i], load(limits + x));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), within, bytes);
    bits[x / 8] |= std::uint64_t{bytes[0]} << (x % 8);
    tile.count += static_cast<unsigned>(
        hn::CompressStore(row.part[i], within, D(), reinterpret_cast<std::int32_t*>(tile.nearest.data()) + tile.count));
  }
  for (unsigned half = 0; half < 2; ++half) tiles[half].layers[z] |= bits[half] << (8 * y);
}

void transform(const BandSteps& steps, const BandWindow& window, BandBlockOut& out) {
  constexpr unsigned side = band_block;
  const unsigned span = side + 2 * steps.reach;
  const std::uint64_t reached = (std::uint64_t{2} << 2 * steps.reach) - 1;
  HWY_ALIGN std::uint32_t line[max_band_window * side];           // one plane z, along x
  HWY_ALIGN std::uint32_t planes[side * max_band_window * side];  // by y, then z, along x and y
  HWY_ALIGN std::uint32_t limits[side];
  std::uint64_t filled[side] = {};  // by y: bits z of the rows that hold keys
  for (unsigned z = 0; z < span; ++z) {
    const std::uint64_t* rows = &window.rows[std::size_t{z} * span];
    std::uint64_t sources = 0;
    for (unsigned y = 0; y < span; ++y) {
      if (rows[y] == 0) continue;
      sources |= std::uint64_t{1} << y;
      Row row;
      for (std::uint64_t left = rows[y]; left != 0; left &= left - 1) row.add(steps.along_x[lowest_bit(left)].data());
      row.store(line + std::size_t{y} * side);
    }
    if (sources == 0) continue;
    for (unsigned y = 0; y < side; ++y) {
      std::uint64_t left = sources >> y & reached;
      if (left == 0) continue;
      Row row;
      for (; left != 0; left &= left - 1) {
        const unsigned step = lowest_bit(left);
        row.add(line + std::size_t{y + step} * side, steps.along_y[step]);
      }
      row.store(planes + (std::size_t{y} * max_band_window + z) * side);
      filled[y] |= std::uint64_t{1} << z;
    }
  }
  for (BandTileOut& tile : out) {
    tile.layers = {};
    tile.count = 0;
  }
  for (unsigned x = 0; x < side; ++x) limits[x] = x < window.size[0] ? (steps.reach * steps.reach + 1) << 18 : 0;
  for (unsigned z = 0; z < window.size[2]; ++z)
    for (unsigned y = 0; y < window.size[1]; ++y) {
      std::uint64_t left = filled[y] >> z & reached;
      if (left == 0) continue;
      Row row;
      for (; left != 0; left &= left - 1) {
        const unsigned step = lowest_bit(left);
        row.add(planes + (std::size_t{y} * max_band_window + z + step) * side, steps.along_z[step]);
      }
      keep(row, limits, y % 8, z % 8, &out[z / 8 * 4 + y / 8 * 2]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace evenmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace evenmesh {

HWY_EXPORT(transform);

void transform_block(const BandSteps& steps, const BandWindow& window, BandBlockOut& out) {
  HWY_DYNAMIC_DISPATCH(transform)(steps, window, out);
}

BandSteps::BandSteps(unsigned d) : reach(d) {
  const auto r = static_cast<std::int32_t>(d);
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  const auto key = [](std::int32_t by, unsigned shift) {
    return static_cast<std::uint32_t>((by * by << 18) + by * (1 << shift));
  };
  for (std::int32_t by = -r; by <= r; ++by) {
    along_y[at(by + r)] = key(by, 6);
    along_z[at(by + r)] = key(by, 12);
  }
  constexpr std::uint32_t zero = 32u << 12 | 32u << 6 | 32u;
  for (std::int32_t b = 0; b < std::int32_t(band_block) + 2 * r; ++b)
    for (std::int32_t x = 0; x < std::int32_t(band_block); ++x) {
      const std::int32_t by = b - r - x;
      along_x[at(b)][at(x)] = by < -r || by > r ? none : zero + key(by, 0);
    }
}

}  // namespace evenmesh
#endif
