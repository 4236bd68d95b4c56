// Scan conversion of triangles into rays, exact in every decision.
//
// Grid points are shifted by (εx, εy, εz), εx ≫ εy ≫ εz > 0, in mind [Edelsbrunner, Mücke, Simulation of simplicity,
// ToG 1990]. A shifted ray never meets an edge or a vertex, a shifted grid point never lies on a triangle, and since
// the shift is the same for the three directions, so is the winding number that they find.

#include "sample/scan.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"
#include "geometry/triangle.h"
#include "sample/extra_directions.h"
#include "sample/lattice.h"
#include "sample/rays.h"

namespace evenmesh {
namespace {

using Wide = __int128;

// A hit and its ray, p * 8 + (q & 7).
struct SlabHit {
  std::uint32_t ray;
  RayHit hit;
};

struct Scratch {
  std::vector<SlabHit> hits;
  std::vector<RayHit> sorted;
  std::vector<std::uint32_t> count;  // per ray, all zero between slabs
  std::vector<DexelCrossing> out;
};

std::int64_t ceil_div(std::int64_t a, std::int64_t b) {
  const std::int64_t q = a / b;
  return q + ((a % b != 0 && (a < 0) == (b < 0)) ? 1 : 0);
}

int floor_int(double v) {
  const int k = static_cast<int>(v);
  return k - (k > v ? 1 : 0);
}

// An edge of the projected triangle, upward in q.
class RowEdge {
 public:
  RowEdge() = default;
  RowEdge(std::int32_t ap, std::int32_t aq, std::int32_t bp, std::int32_t bq, int bits)
      : p_(ap), q_(aq), dp_(std::int64_t{bp} - ap), dq_(std::int64_t{bq} - aq), bits_(bits) {
    const double unit = 1.0 / (1 << bits);
    start_ = ap * unit;
    row_ = aq * unit;
    slope_ = static_cast<double>(dp_) / static_cast<double>(dq_);
  }

  // First p whose shifted grid point lies beyond the edge on row q: those with p ≥ edge, because εp ≫ εq. Valid for
  // rows that the edge spans, aq ≤ q < bq.
  int first_beyond(int q) const {
    const double x = start_ + (q - row_) * slope_;
    const int k = floor_int(x);
    const double fraction = x - k;
    constexpr double near = 1e-9;  // far above the rounding error of x, some 2^-38
    if (fraction > near && fraction < 1 - near) return k + 1;
    const std::int64_t rise = (std::int64_t{q} << bits_) - q_;
    return static_cast<int>(ceil_div(p_ * dq_ + rise * dp_, dq_ << bits_));
  }

 private:
  std::int64_t p_ = 0, q_ = 0, dp_ = 0, dq_ = 1;
  int bits_ = 0;
  double start_ = 0, row_ = 0, slope_ = 0;
};

// The plane of a triangle, as depth along an axis over the two others.
class DepthPlane {
 public:
  // False when the triangle is seen edge-on: then no ray of this direction meets it.
  bool set(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, int axis, int bits) {
    const auto d = [](std::int32_t v, std::int32_t u) { return std::int64_t{v} - u; };
    const std::int64_t ux = d(b[0], a[0]), uy = d(b[1], a[1]), uz = d(b[2], a[2]);
    const std::int64_t vx = d(c[0], a[0]), vy = d(c[1], a[1]), vz = d(c[2], a[2]);
    normal_[0] = uy * vz - uz * vy;
    normal_[1] = uz * vx - ux * vz;
    normal_[2] = ux * vy - uy * vx;
    w_ = static_cast<std::size_t>(axis);
    if (normal_[w_] == 0) return false;
    p_ = static_cast<std::size_t>(dexel_p_axis[w_]);
    q_ = static_cast<std::size_t>(dexel_q_axis[w_]);
    anchor_ = a;
    bits_ = bits;
    const double unit = 1.0 / (1 << bits), nw = static_cast<double>(normal_[w_]);
    slope_p_ = -static_cast<double>(normal_[p_]) / nw;
    slope_q_ = -static_cast<double>(normal_[q_]) / nw;
    ap_ = a[p_] * unit;
    aq_ = a[q_] * unit;
    aw_ = a[w_] * unit;
    const auto extent = [&](std::size_t i) {
      return unit * static_cast<double>(std::max({a[i], b[i], c[i]}) - std::int64_t{std::min({a[i], b[i], c[i]})});
    };
    // Bound of the rounding error of depth() at points within the triangle, in cells.
    error_ = 0x1p-49 * (std::abs(slope_p_) * extent(p_) + std::abs(slope_q_) * extent(q_) + std::abs(aw_) + 1.0);
    return true;
  }

  int step() const { return normal_[w_] > 0 ? -1 : 1; }
  double row_start(int q) const { return aw_ + (q - aq_) * slope_q_; }

  // Cell that the shifted ray's hit falls into and the place in it; base = row_start(q).
  int cell(int p, int q, double base, double& t) const {
    const double w = base + (p - ap_) * slope_p_;
    if (!(error_ < 1e-3) || !(std::abs(w) < 1e8)) return exact_cell(p, q, t);
    int k = floor_int(w);
    t = w - k;
    if (t <= error_ || t >= 1 - error_) {
      const int near = t < 0.5 ? k : k + 1;
      k = above(p, q, near) ? near : near - 1;
      t = k == near ? 0.0 : 1.0;
    }
    return k;
  }

 private:
  Wide offset(int p, int q) const {
    return Wide{normal_[p_]} * ((std::int64_t{p} << bits_) - anchor_[p_]) +
           Wide{normal_[q_]} * ((std::int64_t{q} << bits_) - anchor_[q_]);
  }

  // Whether the hit lies above the shifted grid point (p, q, k).
  bool above(int p, int q, int k) const {
    const Wide s = offset(p, q) + Wide{normal_[w_]} * ((std::int64_t{k} << bits_) - anchor_[w_]);
    // On the plane the largest shift that leaves it decides.
    const std::int64_t tie = normal_[0] != 0 ? normal_[0] : normal_[1] != 0 ? normal_[1] : normal_[2];
    const bool positive = s != 0 ? s > 0 : tie > 0;
    return positive != (normal_[w_] > 0);
  }

  int exact_cell(int p, int q, double& t) const {
    const Wide numerator = -offset(p, q) + Wide{normal_[w_]} * anchor_[w_];
    const Wide denominator = Wide{normal_[w_]} << bits_;
    Wide k = numerator / denominator, rest = numerator % denominator;
    if (rest != 0 && (rest < 0) != (denominator < 0)) {
      k -= 1;
      rest += denominator;
    }
    t = static_cast<double>(rest) / static_cast<double>(denominator);
    if (rest == 0 && !above(p, q, static_cast<int>(k))) {
      k -= 1;
      t = 1.0;
    }
    return static_cast<int>(k);
  }

  std::int64_t normal_[3] = {};
  LatticePoint anchor_{};
  std::size_t p_ = 0, q_ = 0, w_ = 0;
  int bits_ = 0;
  double slope_p_ = 0, slope_q_ = 0, ap_ = 0, aq_ = 0, aw_ = 0, error_ = 0;
};

float in_cell(double t) {
  return std::min(static_cast<float>(t), 0x1.fffffep-1f);
}

class SlabScanner {
 public:
  SlabScanner(const Lattice& lattice, const Mesh& mesh, int axis, std::size_t slab, Scratch& scratch)
      : lattice_(lattice),
        mesh_(mesh),
        axis_(axis),
        w_(static_cast<std::size_t>(axis)),
        p_(static_cast<std::size_t>(dexel_p_axis[w_])),
        q_(static_cast<std::size_t>(dexel_q_axis[w_])),
        row_begin_(std::max(static_cast<int>(slab * brick_size), lattice.first[q_])),
        row_end_(std::min(static_cast<int>((slab + 1) * brick_size), lattice.last[q_] + 1)),
        scratch_(scratch) {}

  void scan(std::uint32_t source) {
    const Triangle& t = mesh_.triangles[source];
    const LatticePoint* v[3] = {&lattice_.points[t[0]], &lattice_.points[t[1]], &lattice_.points[t[2]]};
    if (!plane_.set(*v[0], *v[1], *v[2], axis_, lattice_.bits)) return;
    const std::size_t q = q_;
    const auto lower = [q](const LatticePoint* a, const LatticePoint* b) { return (*a)[q] < (*b)[q]; };
    if (lower(v[1], v[0])) std::swap(v[0], v[1]);
    if (lower(v[2], v[1])) std::swap(v[1], v[2]);
    if (lower(v[1], v[0])) std::swap(v[0], v[1]);
    const int middle = lattice_.cells_up((*v[1])[q]);
    const int begin = std::max(lattice_.cells_up((*v[0])[q]), row_begin_);
    const int end = std::min(lattice_.cells_up((*v[2])[q]), row_end_);
    if (begin >= end) return;
    const RowEdge whole = edge(v[0], v[2]);
    if (begin < middle) scan_rows(source, begin, std::min(middle, end), whole, edge(v[0], v[1]));
    if (middle < end) scan_rows(source, std::max(begin, middle), end, whole, edge(v[1], v[2]));
  }

  int p_begin() const { return p_begin_; }
  int p_end() const { return p_end_; }

 private:
  RowEdge edge(const LatticePoint* a, const LatticePoint* b) const {
    return {(*a)[p_], (*a)[q_], (*b)[p_], (*b)[q_], lattice_.bits};
  }

  void scan_rows(std::uint32_t source, int begin, int end, const RowEdge& one, const RowEdge& other) {
    for (int q = begin; q < end; ++q) {
      int from = one.first_beyond(q), to = other.first_beyond(q);
      if (from > to) std::swap(from, to);
      from = std::max(from, lattice_.first[p_]);
      to = std::min(to, lattice_.last[p_] + 1);
      if (from < to) scan_run(source, q, from, to);
    }
  }

  void scan_run(std::uint32_t source, int q, int from, int to) {
    p_begin_ = std::min(p_begin_, from);
    p_end_ = std::max(p_end_, to);
    const double base = plane_.row_start(q);
    const auto step = static_cast<std::int8_t>(plane_.step());
    for (int p = from; p < to; ++p) {
      double t = 0;
      int cell = plane_.cell(p, q, base, t);
      bool synthetic = false;
      if (lattice_.clipped) synthetic = move_onto_bounds(cell, t);
      const std::uint32_t ray = static_cast<std::uint32_t>(p) * brick_size + static_cast<std::uint32_t>(q) % brick_size;
      ++scratch_.count[ray];
      scratch_.hits.push_back({ray, {source, in_cell(t), static_cast<std::uint16_t>(cell), step, synthetic}});
    }
  }

  // What lies beyond the bounds is flattened onto them: this keeps winding numbers within and makes them 0 outside.
  bool move_onto_bounds(int& cell, double& t) const {
    const double lo = lattice_.face_lo[w_], hi = lattice_.face_hi[w_];
    if (cell + t >= lo && cell + t <= hi && cell >= lattice_.first[w_] - 1 && cell <= lattice_.last[w_]) return false;
    const bool low = cell < lattice_.first[w_];
    cell = low ? lattice_.first[w_] - 1 : lattice_.last[w_];
    t = std::clamp((low ? lo : hi) - cell, 0.0, 1.0);
    return true;
  }

  const Lattice& lattice_;
  const Mesh& mesh_;
  int axis_;
  std::size_t w_, p_, q_;
  int row_begin_, row_end_;
  int p_begin_ = 1 << 30, p_end_ = 0;
  Scratch& scratch_;
  DepthPlane plane_;
};

// Groups the hits by ray, keeping their order, and turns count into the CSR of the rays [first, first + rays).
void sort_by_ray(Scratch& scratch, std::uint32_t first, std::size_t rays, std::vector<std::uint32_t>& begin) {
  begin.resize(rays + 1);
  std::uint32_t sum = 0;
  for (std::size_t r = 0; r < rays; ++r) {
    begin[r] = sum;
    sum += std::exchange(scratch.count[first + r], sum);
  }
  begin[rays] = sum;
  scratch.sorted.resize(std::max<std::size_t>(scratch.sorted.size(), sum));
  for (const SlabHit& h : scratch.hits) scratch.sorted[scratch.count[h.ray]++] = h.hit;
  std::fill_n(scratch.count.begin() + first, rays, 0u);
}

std::vector<DexelCrossing> as_crossings(std::span<const RayHit> hits) {
  std::vector<DexelCrossing> raw;
  raw.reserve(hits.size());
  for (const RayHit& h : hits) raw.push_back({h.source, h.t, h.cell, h.step > 0, h.synthetic});
  return raw;
}

// Scans one slab; `raw` (may be null) receives all hits.
RayCounts scan_slab(const Lattice& lattice, const Mesh& mesh, Winding winding, int axis, std::size_t index,
                    Scratch& scratch, DexelSlab& slab, DexelSlab* raw) {
  const SlabBins& bins = lattice.bins[static_cast<std::size_t>(axis)];
  RayCounts counts;
  scratch.hits.clear();
  SlabScanner scanner(lattice, mesh, axis, index, scratch);
  const std::span<const std::uint32_t> list =
      std::span(bins.triangles).subspan(bins.begin[index], bins.begin[index + 1] - bins.begin[index]);
  for (std::size_t i = 0; i < list.size(); ++i) {
    // Triangles and vertices lie anywhere in memory: have them fetched while others are scanned.
    if (i + 16 < list.size()) __builtin_prefetch(&mesh.triangles[list[i + 16]]);
    if (i + 8 < list.size())
      for (const std::uint32_t v : mesh.triangles[list[i + 8]]) __builtin_prefetch(&lattice.points[v]);
    scanner.scan(list[i]);
  }
  if (scratch.hits.empty()) return counts;
  slab.first = static_cast<std::uint32_t>(scanner.p_begin());
  const std::size_t rays = static_cast<std::size_t>(scanner.p_end() - scanner.p_begin()) * brick_size;
  sort_by_ray(scratch, slab.first * brick_size, rays, slab.begin);
  for (std::size_t r = 0; r < rays; ++r)
    sort_hits(std::span(scratch.sorted).subspan(slab.begin[r], slab.begin[r + 1] - slab.begin[r]));
  if (raw) *raw = {slab.first, slab.begin, as_crossings(std::span(scratch.sorted).first(slab.begin[rays]))};
  scratch.out.clear();
  for (std::size_t r = 0; r < rays; ++r) {
    const std::span<RayHit> hits = std::span(scratch.sorted).subspan(slab.begin[r], slab.begin[r + 1] - slab.begin[r]);
    slab.begin[r] = static_cast<std::uint32_t>(scratch.out.size());
    if (hits.empty()) continue;
    const std::size_t known = counts.near.size();
    resolve_ray(hits, winding, scratch.out, counts);
    for (std::size_t n = known; n < counts.near.size(); ++n)
      counts.near[n].ray = static_cast<std::uint32_t>(slab.first * brick_size + r);
  }
  slab.begin[rays] = static_cast<std::uint32_t>(scratch.out.size());
  slab.crossings.assign(scratch.out.begin(), scratch.out.end());
  return counts;
}

}  // namespace

std::span<const DexelCrossing> DexelAxis::ray(std::uint32_t p, std::uint32_t q) const {
  const std::size_t index = q / brick_size;
  if (index >= slabs.size() || p < slabs[index].first) return {};
  const DexelSlab& slab = slabs[index];
  const std::size_t r = std::size_t{p - slab.first} * brick_size + q % brick_size;
  if (r >= slab.rays()) return {};
  return {slab.crossings.data() + slab.begin[r], slab.begin[r + 1] - slab.begin[r]};
}

std::size_t TriDexel::size() const {
  std::size_t sum = 0;
  for (const DexelAxis& axis : axes)
    for (const DexelSlab& slab : axis.slabs) sum += slab.crossings.size();
  return sum;
}

namespace {

/// @param raw  receives all hits of a mesh that is not closed
TriDexel scan(const Mesh& mesh, const Grid& grid, ExecutionContext& context, const Box& bounds, Winding winding,
              std::array<DexelAxis, 3>& raw) {
  TriDexel solid;
  solid.grid = grid;
  std::vector<std::pair<int, std::size_t>> tasks;
  const Lattice lattice = make_lattice(mesh, grid, bounds, context);
  solid.closed = lattice.closed;
  for (int a = 0; a < 3; ++a) {
    const std::size_t slabs = lattice.bins[static_cast<std::size_t>(a)].begin.size() - 1;
    solid.axes[static_cast<std::size_t>(a)].slabs.resize(slabs);
    if (!solid.closed) raw[static_cast<std::size_t>(a)].slabs.resize(slabs);
    for (std::size_t s = 0; s < slabs; ++s) tasks.emplace_back(a, s);
  }
  std::vector<RayCounts> counts(tasks.size());
  std::vector<std::vector<ThinSpot>> thin(tasks.size());
  const auto normal_of = [&](std::uint32_t t) {
    const auto [a, b, c] = corners_of(mesh, t);
    return normalized(area_normal(a / grid.spacing, b / grid.spacing, c / grid.spacing));
  };
  const std::size_t rays = std::size_t{*std::max_element(grid.size.begin(), grid.size.end())} * brick_size;
  parallel_for(context, tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
    Scratch scratch;
    scratch.count.resize(rays);
    for (std::size_t i = begin; i < end; ++i) {
      const auto axis = static_cast<std::size_t>(tasks[i].first);
      DexelSlab* all = solid.closed ? nullptr : &raw[axis].slabs[tasks[i].second];
      counts[i] = scan_slab(lattice, mesh, winding, tasks[i].first, tasks[i].second, scratch,
                            solid.axes[axis].slabs[tasks[i].second], all);
      thin[i] =
          thin_spots(counts[i].near, grid, tasks[i].first, static_cast<std::uint32_t>(tasks[i].second), normal_of);
      counts[i].near = {};
    }
  });
  for (const auto& spots : thin) solid.thin.insert(solid.thin.end(), spots.begin(), spots.end());
  for (const RayCounts& c : counts) {
    solid.unresolved += c.unresolved;
    solid.cut_by_bounds = solid.cut_by_bounds || c.capped;
  }
  return solid;
}

}  // namespace

TriDexel scan_rays(const Mesh& mesh, const Grid& grid, ExecutionContext& context, Winding winding) {
  std::array<DexelAxis, 3> raw;
  return scan(mesh, grid, context, {}, winding, raw);
}

TriDexel scan_mesh(const Mesh& mesh, const Grid& grid, ExecutionContext& context, const Box& bounds, Winding winding) {
  std::array<DexelAxis, 3> raw;
  TriDexel solid = scan(mesh, grid, context, bounds, winding, raw);
  if (!solid.closed) {
    const ExtraDirections extra_directions(mesh, grid.spacing, winding, context);
    vote(solid, raw, &extra_directions, context);
  }
  return solid;
}

}  // namespace evenmesh
