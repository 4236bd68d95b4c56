#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/plane_fit.h"
#include "grid/morton.h"
#include "grid/tri_dexel.h"
#include "sample/field_parts.h"

namespace evenmesh {
namespace {

constexpr int reach = 2;                      // cells around a sample that are searched
constexpr int side = brick_size + 2 * reach;  // cells per side of a neighbourhood
constexpr double radius = 2.0;                // cells
constexpr std::size_t fewest = 4;             // samples that make a plane

double sign_of(EdgeCode code) {
  return code.lower_end_inside() ? 1.0 : -1.0;
}

// The samples of a block and of its neighbours' nearest cells, by cell; positions in cells from the block's center.
class Neighbourhood {
 public:
  struct Point {
    Vec3 at;
    EdgeCode code;
  };

  /// @param codes  Morton codes of the set's blocks
  Neighbourhood(const SampleSet& set, const std::vector<std::uint64_t>& codes) : set_(set), codes_(codes) {}

  void gather(const SampleBlock& center) {
    points_.clear();
    for (auto& plane : rows_) std::fill(std::begin(plane), std::end(plane), std::uint16_t{0});
    for (int c = 0; c < 27; ++c) {
      const int step[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
      if (const SampleBlock* block = find(center, step)) add(*block, step);
    }
  }

  // Calls use(point) for the samples on edges that start in the cells around (i, j, k) of the block.
  template <typename Use>
  void around(const EdgeCode& code, const Use& use) const {
    const int k = static_cast<int>(code.k());
    for (int i = static_cast<int>(code.i()); i <= static_cast<int>(code.i()) + 2 * reach; ++i)
      for (int j = static_cast<int>(code.j()); j <= static_cast<int>(code.j()) + 2 * reach; ++j)
        for (unsigned bits = rows_[i][j] >> k & ((2u << 2 * reach) - 1); bits != 0; bits &= bits - 1) {
          const Cell& cell = cells_[i][j][k + std::countr_zero(bits)];
          for (unsigned p = 0; p < cell.count; ++p) use(points_[cell.point[p]]);
        }
  }

 private:
  struct Cell {
    unsigned count;
    std::uint32_t point[3];
  };

  const SampleBlock* find(const SampleBlock& center, const int (&step)[3]) const {
    int brick[3];
    for (std::size_t a = 0; a < 3; ++a) {
      brick[a] = center.brick[a] + step[a];
      if (brick[a] < 0) return nullptr;
    }
    const std::uint64_t code =
        morton_code(static_cast<unsigned>(brick[0]), static_cast<unsigned>(brick[1]), static_cast<unsigned>(brick[2]));
    const auto at = std::lower_bound(codes_.begin(), codes_.end(), code);
    return at != codes_.end() && *at == code ? &set_.blocks[static_cast<std::size_t>(at - codes_.begin())] : nullptr;
  }

  void add(const SampleBlock& block, const int (&step)[3]) {
    const double per_cell = 1.0 / set_.grid.spacing;
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const EdgeCode code = set_.edge[s];
      const int at[3] = {static_cast<int>(code.i()), static_cast<int>(code.j()), static_cast<int>(code.k())};
      int cell[3];
      bool near = true;
      for (int a = 0; a < 3; ++a) {
        cell[a] = at[a] + step[a] * static_cast<int>(brick_size) + reach;
        near = near && cell[a] >= 0 && cell[a] < side;
      }
      if (!near) continue;
      std::uint16_t& row = rows_[cell[0]][cell[1]];
      Cell& c = cells_[cell[0]][cell[1]][cell[2]];
      if ((row >> cell[2] & 1) == 0) c.count = 0;
      row = static_cast<std::uint16_t>(row | 1u << cell[2]);
      c.point[c.count++] = static_cast<std::uint32_t>(points_.size());
      const double brick = brick_size;
      points_.push_back({Vec3{set_.x[s] * per_cell + step[0] * brick, set_.y[s] * per_cell + step[1] * brick,
                              set_.z[s] * per_cell + step[2] * brick},
                         code});
    }
  }

  const SampleSet& set_;
  const std::vector<std::uint64_t>& codes_;
  std::vector<Point> points_;
  std::uint16_t rows_[side][side];
  Cell cells_[side][side][side];
};

// Plane through the samples within kRadius, each counted the less the farther it is. Samples that cross the same axis
// the other way belong to another sheet.
Vec3 fitted_normal(const Neighbourhood& near, const Vec3& at, EdgeCode code) {
  Vec3 outward;
  PlaneFit fit;
  near.around(code, [&](const Neighbourhood::Point& p) {
    const Vec3 d = p.at - at;
    const double w = 1.0 - squared_norm(d) / (radius * radius);
    if (w <= 0 || (p.code.axis() == code.axis() && p.code.lower_end_inside() != code.lower_end_inside())) return;
    outward[static_cast<int>(p.code.axis())] += w * sign_of(p.code);
    fit.add(d, w);
  });
  Vec3 normal = normalized(outward);
  if (fit.count() >= fewest) {
    const PlaneFit::Plane plane = fit.plane();
    // Samples along one line say nothing of a plane.
    if (plane.variance[1] > 1e-3) normal = dot(plane.normal, outward) < 0 ? -plane.normal : plane.normal;
  }
  // The normal never points against the sample's own change of sign.
  const int axis = static_cast<int>(code.axis());
  if (normal[axis] * sign_of(code) < 1e-3) normal[axis] = 1e-3 * sign_of(code);
  return normalized(normal);
}

}  // namespace

namespace {

/// @param wanted  of the samples whose normals are replaced, by their normals
template <typename Wanted>
void fit(SampleSet& set, const ExecutionContext& context, const Wanted& wanted) {
  const double h = set.grid.spacing;
  std::vector<std::uint64_t> codes;
  for (const SampleBlock& b : set.blocks) codes.push_back(morton_code(b.brick[0], b.brick[1], b.brick[2]));
  parallel_for(context, set.blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    Neighbourhood near(set, codes);
    for (std::size_t b = begin; b < end; ++b) {
      const SampleBlock& block = set.blocks[b];
      const auto first = set.normal.begin() + block.begin, last = set.normal.begin() + block.end;
      if (std::none_of(first, last, wanted)) continue;
      near.gather(block);
      for (std::uint32_t s = block.begin; s < block.end; ++s) {
        if (!wanted(set.normal[s])) continue;
        const Vec3 n = fitted_normal(near, Vec3{set.x[s], set.y[s], set.z[s]} / h, set.edge[s]);
        set.normal[s] = pack_normal(n);
        set.area[s] = static_cast<float>(sample_area(n, static_cast<int>(set.edge[s].axis()), h));
      }
    }
  });
}

}  // namespace

void fit_normals(SampleSet& set, const ExecutionContext& context) {
  fit(set, context, [](PackedNormal) { return true; });
}

void fit_missing_normals(SampleSet& set, const ExecutionContext& context) {
  fit(set, context, [](PackedNormal n) { return n.bits == no_normal.bits; });
}

}  // namespace evenmesh
