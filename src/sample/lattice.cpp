#include "sample/lattice.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "evenmesh/error.h"
#include "grid/tri_dexel.h"

namespace evenmesh {
namespace {

constexpr double largest = largest_lattice_coordinate;

std::size_t at(int axis) {
  return static_cast<std::size_t>(axis);
}

// Grid points strictly within the bounds; the grid's outermost layer never counts as inside.
void set_range(Lattice& lattice, const Grid& grid, const Box& bounds) {
  for (int a = 0; a < 3; ++a) {
    const double top = grid.size[at(a)] - 1.5;
    double lo = 0.5, hi = top;
    if (!bounds.empty()) {
      lo = std::clamp((bounds.lo[a] - grid.origin[a]) / grid.spacing, lo, top);
      hi = std::clamp((bounds.hi[a] - grid.origin[a]) / grid.spacing, 0.5, top);
    }
    lattice.face_lo[at(a)] = lo;
    lattice.face_hi[at(a)] = hi;
    lattice.first[at(a)] = static_cast<std::int32_t>(std::ceil(lo));
    lattice.last[at(a)] = static_cast<std::int32_t>(std::floor(hi));
  }
}

// Largest number of bits for which the mesh fits, and whether it leaves the range.
void choose_scale(Lattice& lattice, const Mesh& mesh, const Grid& grid, bool bounded) {
  const Box box = mesh.bounds();
  if (box.empty()) return;
  double reach = 0;
  bool outside = false;
  for (int a = 0; a < 3; ++a) {
    const double lo = (box.lo[a] - grid.origin[a]) / grid.spacing, hi = (box.hi[a] - grid.origin[a]) / grid.spacing;
    reach = std::max({reach, std::abs(lo), std::abs(hi), double(grid.size[at(a)])});
    // A mesh that fills its bounds to the last bit does not leave them.
    outside = outside || lo < lattice.face_lo[at(a)] - 1e-3 || hi > lattice.face_hi[at(a)] + 1e-3;
  }
  if (outside && !bounded)
    throw InvalidInput("the mesh does not fit into the grid: make the grid from the mesh's bounds");
  while (lattice.bits > 0 && std::ldexp(reach, lattice.bits) > largest) --lattice.bits;
  if (std::ldexp(reach, lattice.bits) > largest)
    throw InvalidInput("the mesh is too large for the bounds: enlarge them or lower the resolution");
  lattice.clipped = outside;
}

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

// Value of a directed edge under a random antisymmetric function of its end points.
std::uint64_t edge_value(std::uint64_t a, std::uint64_t b) {
  if (a == b) return 0;
  const std::uint64_t h = mix(std::min(a, b) + 0x9e3779b97f4a7c15ull * mix(std::max(a, b)));
  return a < b ? h : 0 - h;
}

// The boundary of the sum of all triangles is zero exactly when every edge, by the places of its ends, is used as often
// one way as the other. Summing a random antisymmetric function of the edges finds that out with an error of
// probability 2^-64, without welding vertices or pairing edges.
bool has_no_boundary(const Lattice& lattice, const Mesh& mesh, const ExecutionContext& context) {
  std::vector<std::uint64_t> name(lattice.points.size());
  parallel_for(context, name.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const LatticePoint& p = lattice.points[v];
      const std::uint64_t xy = std::uint64_t(std::uint32_t(p[0])) << 32 | std::uint32_t(p[1]);
      name[v] = mix(mix(xy + 0x9e3779b97f4a7c15ull) + std::uint32_t(p[2]));
    }
  });
  std::atomic<std::uint64_t> total{0};
  parallel_for(context, mesh.triangles.size(), 16384, [&](std::size_t begin, std::size_t end) {
    std::uint64_t sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint64_t a = name[mesh.triangles[t][0]], b = name[mesh.triangles[t][1]],
                          c = name[mesh.triangles[t][2]];
      sum += edge_value(a, b) + edge_value(b, c) + edge_value(c, a);
    }
    total.fetch_add(sum, std::memory_order_relaxed);
  });
  return total.load() == 0;
}

// Calls use(axis, first slab, last slab) for each direction in which the triangle's box holds a ray.
template <typename Use>
void for_slabs(const Lattice& lattice, const Triangle& t, const Use& use) {
  std::int32_t lo[3], hi[3];
  const LatticePoint &a = lattice.points[t[0]], &b = lattice.points[t[1]], &c = lattice.points[t[2]];
  for (std::size_t d = 0; d < 3; ++d) {
    lo[d] = std::max(lattice.cells_up(std::min({a[d], b[d], c[d]})), lattice.first[d]);
    hi[d] = std::min(lattice.cells_up(std::max({a[d], b[d], c[d]})), lattice.last[d] + 1);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const int p = dexel_p_axis[at(axis)], q = dexel_q_axis[at(axis)];
    if (lo[p] < hi[p] && lo[q] < hi[q])
      use(axis, static_cast<std::uint32_t>(lo[q]) / brick_size, static_cast<std::uint32_t>(hi[q] - 1) / brick_size);
  }
}

// Counting sort in two passes over fixed pieces of the mesh, so that the order does not depend on threads.
void bin_triangles(Lattice& lattice, const Mesh& mesh, const Grid& grid, const ExecutionContext& context) {
  const std::size_t count = mesh.triangles.size(), pieces = std::clamp<std::size_t>(count / 8192, 1, 32);
  std::array<std::size_t, 3> slabs{}, offset{};
  std::size_t width = 0;
  for (int a = 0; a < 3; ++a) {
    slabs[at(a)] = (grid.size[at(dexel_q_axis[at(a)])] + brick_size - 1) / brick_size;
    offset[at(a)] = width;
    width += slabs[at(a)];
  }
  std::vector<std::uint32_t> place(pieces * width);
  const auto for_piece = [&](std::size_t piece, const auto& use) {
    const std::size_t end = (piece + 1) * count / pieces;
    for (std::size_t t = piece * count / pieces; t < end; ++t)
      for_slabs(lattice, mesh.triangles[t], [&](int axis, std::uint32_t from, std::uint32_t to) {
        for (std::uint32_t s = from; s <= to; ++s)
          use(static_cast<std::uint32_t>(t), axis, place[piece * width + offset[at(axis)] + s]);
      });
  };
  parallel_tasks(context, pieces,
                 [&](std::size_t piece) { for_piece(piece, [](std::uint32_t, int, std::uint32_t& n) { ++n; }); });
  for (int a = 0; a < 3; ++a) {
    SlabBins& bins = lattice.bins[at(a)];
    std::uint32_t sum = 0;
    for (std::size_t s = 0; s < slabs[at(a)]; ++s) {
      bins.begin.push_back(sum);
      for (std::size_t piece = 0; piece < pieces; ++piece) {
        const std::uint32_t n = std::exchange(place[piece * width + offset[at(a)] + s], sum);
        sum += n;
      }
    }
    bins.begin.push_back(sum);
    bins.triangles.resize(sum);
  }
  parallel_tasks(context, pieces, [&](std::size_t piece) {
    for_piece(piece, [&](std::uint32_t t, int axis, std::uint32_t& n) { lattice.bins[at(axis)].triangles[n++] = t; });
  });
}

}  // namespace

void check_mesh(const Mesh& mesh, const ExecutionContext& context) {
  const std::size_t count = mesh.vertices.size();
  parallel_for(context, mesh.triangles.size(), 32768, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (const std::uint32_t v : mesh.triangles[t]) {
        if (v >= count) throw InvalidInput("triangle " + std::to_string(t) + " refers to a vertex that does not exist");
        if (!is_finite(mesh.vertices[v])) throw InvalidInput("vertex " + std::to_string(v) + " is not finite");
      }
  });
}

std::vector<LatticePoint> snap_vertices(const Mesh& mesh, const Vec3& origin, double spacing, int bits,
                                        const ExecutionContext& context) {
  const double scale = std::ldexp(1.0 / spacing, bits);
  std::vector<LatticePoint> points(mesh.vertices.size());
  parallel_for(context, mesh.vertices.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      for (int a = 0; a < 3; ++a) {
        const double c = (mesh.vertices[v][a] - origin[a]) * scale;
        // Only vertices without triangles can be out of range here; written so that NaN gives 0.
        points[v][at(a)] = std::abs(c) <= largest ? static_cast<std::int32_t>(std::floor(c + 0.5)) : 0;
      }
  });
  return points;
}

Lattice make_lattice(const Mesh& mesh, const Grid& grid, const Box& bounds, const ExecutionContext& context) {
  Lattice lattice;
  check_mesh(mesh, context);
  set_range(lattice, grid, bounds);
  choose_scale(lattice, mesh, grid, !bounds.empty());
  lattice.points = snap_vertices(mesh, grid.origin, grid.spacing, lattice.bits, context);
  lattice.closed = has_no_boundary(lattice, mesh, context);
  bin_triangles(lattice, mesh, grid, context);
  return lattice;
}

}  // namespace evenmesh
