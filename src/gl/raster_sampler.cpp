#include "gl/raster_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "evenmesh/error.h"
#include "gl/raster_view.h"
#include "sample/extra_directions.h"
#include "sample/rays.h"
#include "sample/scan.h"

namespace evenmesh::gl {
namespace {

/// Cells. Vertices are rounded to 1/256 of a pixel, and depths by more where rays graze the surface: where directions
/// differ so near to it, the input is not to blame.
constexpr double rounding = 1.0 / 8;

constexpr auto view_size = static_cast<std::uint32_t>(largest_view);
static_assert(view_size % brick_size == 0);

/// A fragment on its ray.
struct Caught {
  std::uint32_t ray = 0;  ///< within its band: slab by slab as DexelSlab counts
  float along = 0;
  std::uint32_t normal = 0;
  bool enters = false;

  auto key() const { return std::tuple(ray, along, enters, normal); }
  bool operator<(const Caught& other) const { return key() < other.key(); }
};

/// The part of a grid in which a solid is wanted; in cells from its origin.
struct Range {
  std::array<std::uint32_t, 3> first{}, last{};  ///< grid points, inclusive
  std::array<double, 3> lo{}, hi{};              ///< faces of the bounds

  bool empty() const { return first[0] > last[0] || first[1] > last[1] || first[2] > last[2]; }
};

Range range_of(const Grid& grid, const Box& bounds) {
  Range range;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double end = grid.size[a] - 1.5;  // the outermost layer is outside
    range.lo[a] = std::clamp((bounds.lo[axis] - grid.origin[axis]) / grid.spacing, 0.5, end);
    range.hi[a] = std::clamp((bounds.hi[axis] - grid.origin[axis]) / grid.spacing, 0.5, end);
    range.first[a] = static_cast<std::uint32_t>(std::ceil(range.lo[a]));
    range.last[a] = static_cast<std::uint32_t>(std::floor(range.hi[a]));
  }
  return range;
}

/// Rays of one axis: a few rows of slabs, drawn window by window.
class Band {
 public:
  Band(const Grid& grid, const Range& range, int axis, std::uint32_t first_row)
      : axis_(static_cast<std::size_t>(axis)), cells_(grid.size[axis_] - 1.0), range_(range), first_row_(first_row) {
    const auto p = static_cast<std::size_t>(dexel_p_axis[axis_]), q = static_cast<std::size_t>(dexel_q_axis[axis_]);
    first_p_ = range.first[p];
    end_p_ = range.last[p] + 1;
    begin_q_ = std::max(first_row, range.first[q]);
    end_q_ = std::min(first_row + view_size, range.last[q] + 1);
  }

  /// Its windows, in the order of p.
  std::vector<RayWindow> windows() const {
    std::vector<RayWindow> all;
    for (std::uint32_t p = first_p_; p < end_p_; p += view_size)
      all.push_back({static_cast<int>(axis_), p, begin_q_, std::min(view_size, end_p_ - p), end_q_ - begin_q_});
    return all;
  }

  void add(const RayWindow& window, const std::vector<RasterFragment>& fragments) {
    for (const RasterFragment& f : fragments) {
      const std::uint32_t pixel = f.pixel & ~enters_bit;
      const std::uint32_t p = window.p + pixel % window.width, q = window.q + pixel / window.width;
      if (std::isnan(f.along)) {
        ++lost_;
        continue;
      }
      const std::uint32_t slab = (q - first_row_) / brick_size;
      const std::uint32_t ray = (slab * (end_p_ - first_p_) + (p - first_p_)) * brick_size + q % brick_size;
      caught_.push_back({ray, f.along, f.normal, (f.pixel & enters_bit) != 0});
    }
  }

  /// Sorts, and appends the normals: crossings count them.
  void sort(std::vector<PackedNormal>& normals, const ExecutionContext& execution) {
    parallel_sort(execution, caught_);
    first_source_ = static_cast<std::uint32_t>(normals.size());
    normals.reserve(normals.size() + caught_.size());
    for (const Caught& c : caught_) normals.push_back({c.normal});
  }

  /// Makes the slabs of the band, those of what was found and those of the solid.
  RayCounts resolve(DexelAxis& found, DexelAxis& solid, const ExecutionContext& execution) const {
    const std::size_t first_slab = first_row_ / brick_size;
    const std::size_t count = (end_q_ - first_row_ + brick_size - 1) / brick_size;
    std::vector<RayCounts> counts(count);
    parallel_tasks(execution, count, [&](std::size_t i) {
      counts[i] = resolve_slab(static_cast<std::uint32_t>(i), found.slabs[first_slab + i], solid.slabs[first_slab + i]);
    });
    RayCounts sum{lost_, {}, false};
    for (const RayCounts& c : counts) {
      sum.unresolved += c.unresolved;
      sum.capped = sum.capped || c.capped;
    }
    return sum;
  }

 private:
  RayCounts resolve_slab(std::uint32_t slab, DexelSlab& found, DexelSlab& solid) const {
    const std::uint32_t rays = (end_p_ - first_p_) * brick_size;
    const auto below = [](const Caught& c, std::uint32_t ray) { return c.ray < ray; };
    auto at = std::lower_bound(caught_.begin(), caught_.end(), slab * rays, below);
    const auto end = std::lower_bound(at, caught_.end(), (slab + 1) * rays, below);
    RayCounts counts;
    if (at == end) return counts;
    found.first = solid.first = first_p_;
    std::vector<RayHit> hits;
    for (std::uint32_t r = 0; r < rays; ++r) {
      found.begin.push_back(static_cast<std::uint32_t>(found.crossings.size()));
      solid.begin.push_back(static_cast<std::uint32_t>(solid.crossings.size()));
      hits.clear();
      int sum = 0;
      for (; at != end && at->ray == slab * rays + r; ++at) {
        hits.push_back(hit(*at));
        sum += hits.back().step;
      }
      if (hits.empty()) continue;
      sort_hits(hits);
      for (const RayHit& h : hits) found.crossings.push_back({h.source, h.t, h.cell, h.step > 0, h.synthetic});
      counts.unresolved += static_cast<std::size_t>(std::abs(sum));
      resolve_ray(hits, Winding::any, solid.crossings, counts);
    }
    found.begin.push_back(static_cast<std::uint32_t>(found.crossings.size()));
    solid.begin.push_back(static_cast<std::uint32_t>(solid.crossings.size()));
    return counts;
  }

  /// What lies beyond the bounds is flattened onto them, as in scan_mesh().
  RayHit hit(const Caught& c) const {
    constexpr double touches = 1e-3;  // what fills its bounds to the last bit does not leave them
    const double w = std::clamp(0.5 * (double(c.along) + 1) * cells_, -1.0, cells_ + 1);
    const std::uint32_t first = range_.first[axis_], last = range_.last[axis_];
    const double lo = range_.lo[axis_], hi = range_.hi[axis_];
    const auto source = first_source_ + static_cast<std::uint32_t>(&c - caught_.data());
    const std::int8_t step = c.enters ? 1 : -1;
    const auto in_cell = [](double t) { return std::clamp(static_cast<float>(t), 0.0f, 0x1.fffffep-1f); };
    double cell = std::floor(w);
    const bool within = w >= lo - touches && w <= hi + touches && cell >= first - 1.0 && cell <= last;
    if (within) return {source, in_cell(w - cell), static_cast<std::uint16_t>(cell), step, false};
    const bool low = w < 0.5 * (lo + hi);
    cell = low ? first - 1.0 : last;
    return {source, in_cell((low ? lo : hi) - cell), static_cast<std::uint16_t>(cell), step, true};
  }

  std::size_t axis_;
  double cells_;
  const Range& range_;
  std::uint32_t first_row_, first_p_ = 0, end_p_ = 0, begin_q_ = 0, end_q_ = 0, first_source_ = 0;
  std::size_t lost_ = 0;  ///< fragments that are nowhere
  std::vector<Caught> caught_;
};

/// Draws windows into a band; those with too many fragments in parts.
class Painter {
 public:
  Painter(RasterDevice& device, const Grid& grid, const Affine& placement, const Box& bounds, const std::string& name)
      : device_(device), grid_(grid), placement_(placement), bounds_(bounds), name_(name) {}

  void paint(const RayWindow& window, Band& band) {
    if (device_.draw(make_view(grid_, window, placement_, bounds_), fragments_)) return band.add(window, fragments_);
    if (window.width == 1)
      throw UnusableInput(fmt::format("'{}' draws too many fragments onto one row of pixels; draw less", name_));
    RayWindow left = window, right = window;
    left.width = window.width / 2;
    right.width = window.width - left.width;
    right.p += left.width;
    paint(left, band);
    paint(right, band);
  }

 private:
  RasterDevice& device_;
  const Grid& grid_;
  const Affine& placement_;
  const Box& bounds_;
  const std::string& name_;
  std::vector<RasterFragment> fragments_;
};

/// Takes out what was put onto the bounds.
void drop_made(DexelSlab& slab) {
  std::uint32_t kept = 0, begin = 0;
  for (std::size_t r = 0; r < slab.rays(); ++r) {
    const std::uint32_t end = slab.begin[r + 1];
    for (std::uint32_t c = std::exchange(begin, end); c < end; ++c)
      if (!slab.crossings[c].synthetic) slab.crossings[kept++] = slab.crossings[c];
    slab.begin[r + 1] = kept;
  }
  slab.crossings.resize(kept);
}

}  // namespace

RasterSampler::Drawing RasterSampler::draw(const Grid& grid, const Box& bounds, ExecutionContext& execution) const {
  Drawing drawing;
  TriDexel& solid = drawing.occupancy;
  solid.grid = grid;
  const Range range = range_of(grid, bounds);
  if (range.empty()) return drawing;
  Painter painter(*device_, grid, placement_, bounds_, name_);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto q = static_cast<std::size_t>(dexel_q_axis[a]);
    const std::size_t slabs = (grid.size[q] + brick_size - 1) / brick_size;
    drawing.found[a].slabs.resize(slabs);
    solid.axes[a].slabs.resize(slabs);
    for (std::uint32_t row = range.first[q] / view_size * view_size; row <= range.last[q]; row += view_size) {
      Band band(grid, range, axis, row);
      for (const RayWindow& window : band.windows()) {
        execution.throw_if_cancelled();
        painter.paint(window, band);
      }
      band.sort(drawing.normals, execution);
      const RayCounts counts = band.resolve(drawing.found[a], solid.axes[a], execution);
      solid.unresolved += counts.unresolved;
      solid.cut_by_bounds = solid.cut_by_bounds || counts.capped;
    }
  }
  return drawing;
}

TriDexel RasterSampler::scan(const Grid& grid, const Box& bounds, std::vector<PackedNormal>& normals,
                             ExecutionContext& execution) const {
  Drawing drawing = draw(grid, bounds, execution);
  vote(drawing.occupancy, drawing.found, nullptr, execution, rounding);
  normals = std::move(drawing.normals);
  return std::move(drawing.occupancy);
}

SampleSet RasterSampler::sample(const Grid& grid, const Box& bounds, ExecutionContext& execution) const {
  std::vector<PackedNormal> normals;
  const TriDexel solid = scan(grid, bounds, normals, execution);
  if (solid.size() == 0 && solid.unresolved > 0)
    throw UnusableInput(
        fmt::format("'{}' bounds no solid: its rays enter and do not leave, or the other way; draw its back faces, "
                    "too, or mesh it as an open surface (--method shell)",
                    name_));
  return sample_dexels(solid, normals, execution);
}

SampleSet RasterSampler::sample_surface(const Grid& grid, const Box& bounds, ExecutionContext& execution) const {
  Drawing drawing = draw(grid, bounds, execution);
  for (DexelAxis& axis : drawing.found)
    for (DexelSlab& slab : axis.slabs) drop_made(slab);
  TriDexel surface;
  surface.grid = grid;
  surface.axes = std::move(drawing.found);
  return sample_dexels(surface, drawing.normals, execution);
}

double RasterSampler::solidity(const Box& bounds, ExecutionContext& execution) const {
  constexpr std::size_t resolution = 64;  // as that of meshes
  return agreement(draw(make_grid(bounds, resolution), bounds, execution).occupancy);
}

std::shared_ptr<const RaySource> RasterSampler::moved(const Affine& transform) const {
  return std::make_shared<RasterSampler>(device_, name_, bounds_, transform.after(placement_));
}

}  // namespace evenmesh::gl
