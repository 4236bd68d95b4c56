// Crossings, kept by rays, into blocks, kept by bricks.

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "evenmesh/error.h"
#include "grid/blocks.h"
#include "grid/morton.h"
#include "sample/field_parts.h"
#include "sample/scan.h"

namespace evenmesh {
namespace {

// A crossing in its brick.
struct Placed {
  std::uint32_t source;
  float t;
  EdgeCode code;
  bool synthetic;
};

// The crossings of one axis within one brick: a range of its slab's placed crossings. Sorting by key sorts by the
// Morton code of the brick, then by axis.
struct Piece {
  std::uint64_t key;
  std::uint32_t slab, begin, end;

  int axis() const { return static_cast<int>(key & 3); }
  std::uint64_t brick() const { return key >> 2; }
};

struct PlacedSlab {
  std::unique_ptr<Placed[]> crossings;  // as many as the slab's; not initialized twice, unlike a vector
  std::vector<Piece> pieces;
};

// What a triangle gives to its samples: its normal, and their area by axis, all zero when it is degenerate.
struct SourceNormal {
  PackedNormal normal;
  float area[3] = {};

  bool missing() const { return normal.bits == no_normal.bits; }
  bool degenerate() const { return area[0] + area[1] + area[2] == 0; }
};

std::vector<SourceNormal> source_normals(const Mesh& mesh, double spacing, const ExecutionContext& context) {
  std::vector<SourceNormal> normals(mesh.triangles.size());
  parallel_for(context, normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = mesh.triangles[i];
      // In units of the spacing, so that small models do not underflow.
      const double scale = 1.0 / spacing;
      const Vec3 a = mesh.vertices[t[0]];
      const Vec3 n = normalized(cross((mesh.vertices[t[1]] - a) * scale, (mesh.vertices[t[2]] - a) * scale));
      normals[i].normal = pack_normal(n);
      for (int axis = 0; axis < 3; ++axis) normals[i].area[axis] = static_cast<float>(sample_area(n, axis, spacing));
    }
  });
  return normals;
}

std::vector<SourceNormal> source_normals(std::span<const PackedNormal> given, double spacing,
                                         const ExecutionContext& context) {
  std::vector<SourceNormal> normals(given.size());
  parallel_for(context, normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      normals[i].normal = given[i];
      if (normals[i].missing()) continue;
      const Vec3 n = unpack_normal(given[i]);
      for (int axis = 0; axis < 3; ++axis) normals[i].area[axis] = static_cast<float>(sample_area(n, axis, spacing));
    }
  });
  return normals;
}

// Whether a component is positive, without unpacking, on the octahedron's 65534 steps.
bool is_upward(PackedNormal n, unsigned axis) {
  const int u = static_cast<int>(n.bits & 0xffff) - 32767, v = static_cast<int>(n.bits >> 16) - 32767;
  return axis == 0 ? u >= 0 : axis == 1 ? v >= 0 : std::abs(u) + std::abs(v) <= 32767;
}

// Groups one slab's crossings by brick: eight p at a time, a counting sort by brick along the ray.
void place_slab(const DexelSlab& slab, int axis, std::size_t index, std::vector<std::uint32_t>& count,
                PlacedSlab& placed) {
  const std::size_t rays = slab.rays();
  placed.crossings = std::make_unique_for_overwrite<Placed[]>(slab.crossings.size());
  const auto shift = static_cast<unsigned>(axis);
  for (std::size_t r = 0; r < rays;) {
    const std::size_t p_brick = (slab.first + r / brick_size) / brick_size;
    const std::size_t end = std::min(((p_brick + 1) * brick_size - slab.first) * brick_size, rays);
    const std::uint32_t first = slab.begin[r], last = slab.begin[end];
    std::size_t lowest = count.size(), highest = 0;
    for (std::uint32_t c = first; c < last; ++c) {
      const std::size_t w_brick = slab.crossings[c].cell / brick_size;
      ++count[w_brick];
      lowest = std::min(lowest, w_brick);
      highest = std::max(highest, w_brick);
    }
    std::uint32_t sum = first;
    for (std::size_t w = lowest; first < last && w <= highest; ++w) {
      if (count[w] == 0) continue;
      std::array<std::size_t, 3> brick{};
      brick[static_cast<std::size_t>(dexel_p_axis[shift])] = p_brick;
      brick[static_cast<std::size_t>(dexel_q_axis[shift])] = index;
      brick[shift] = w;
      placed.pieces.push_back({morton_code(brick[0], brick[1], brick[2]) << 2 | shift,
                               static_cast<std::uint32_t>(index), sum, sum + count[w]});
      sum += std::exchange(count[w], sum);
    }
    for (; r < end; ++r) {
      std::array<unsigned, 3> at{};
      at[static_cast<std::size_t>(dexel_p_axis[shift])] =
          (slab.first + static_cast<unsigned>(r / brick_size)) % brick_size;
      at[static_cast<std::size_t>(dexel_q_axis[shift])] = r % brick_size;
      for (std::uint32_t c = slab.begin[r]; c < slab.begin[r + 1]; ++c) {
        const DexelCrossing& crossing = slab.crossings[c];
        at[shift] = crossing.cell % brick_size;
        placed.crossings[count[crossing.cell / brick_size]++] = {
            crossing.source, crossing.t, EdgeCode(shift, at[0], at[1], at[2], !crossing.enters), crossing.synthetic};
      }
    }
    for (std::size_t w = lowest; first < last && w <= highest; ++w) count[w] = 0;
  }
}

using PlacedAxes = std::array<std::vector<PlacedSlab>, 3>;

PlacedAxes place_all(const TriDexel& solid, const ExecutionContext& context) {
  PlacedAxes placed;
  std::vector<std::pair<int, std::size_t>> tasks;
  for (int a = 0; a < 3; ++a) {
    const std::size_t slabs = solid.axes[static_cast<std::size_t>(a)].slabs.size();
    placed[static_cast<std::size_t>(a)].resize(slabs);
    for (std::size_t s = 0; s < slabs; ++s) tasks.emplace_back(a, s);
  }
  const std::size_t bricks = *std::max_element(solid.grid.size.begin(), solid.grid.size.end()) / brick_size + 1;
  parallel_for(context, tasks.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> count(bricks);
    for (std::size_t i = begin; i < end; ++i) {
      const auto a = static_cast<std::size_t>(tasks[i].first);
      place_slab(solid.axes[a].slabs[tasks[i].second], tasks[i].first, tasks[i].second, count,
                 placed[a][tasks[i].second]);
    }
  });
  return placed;
}

// All pieces by brick and axis. Least significant digit first; keys are all different.
std::vector<Piece> sorted_pieces(const PlacedAxes& placed) {
  std::vector<Piece> pieces, other;
  std::uint64_t all = 0;
  for (const auto& axis : placed)
    for (const PlacedSlab& slab : axis) pieces.insert(pieces.end(), slab.pieces.begin(), slab.pieces.end());
  for (const Piece& p : pieces) all |= p.key;
  other.resize(pieces.size());
  constexpr unsigned digit = 11;
  for (unsigned shift = 0; shift < 64 && all >> shift != 0; shift += digit) {
    std::array<std::uint32_t, 1u << digit> place{};
    for (const Piece& p : pieces) ++place[p.key >> shift & (place.size() - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& n : place) sum += std::exchange(n, sum);
    for (const Piece& p : pieces) other[place[p.key >> shift & (place.size() - 1)]++] = p;
    pieces.swap(other);
  }
  return pieces;
}

// Makes the blocks; returns for each its first piece, and the number of pieces at the end.
std::vector<std::uint32_t> make_blocks(const std::vector<Piece>& pieces, SampleSet& set) {
  std::vector<std::uint32_t> first;
  std::uint32_t sum = 0;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    if (i == 0 || pieces[i].brick() != pieces[i - 1].brick()) {
      first.push_back(i);
      set.blocks.push_back({sum, sum, morton_decode(pieces[i].brick()), {}});
    }
    sum += pieces[i].end - pieces[i].begin;
    set.blocks.back().end = sum;
  }
  first.push_back(static_cast<std::uint32_t>(pieces.size()));
  return first;
}

class BlockWriter {
 public:
  BlockWriter(const std::vector<SourceNormal>& normals, SampleSet& set)
      : normals_(normals.data()),
        x_(set.x.data()),
        y_(set.y.data()),
        z_(set.z.data()),
        area_(set.area.data()),
        normal_(set.normal.data()),
        edge_(set.edge.data()),
        source_(set.source.empty() ? nullptr : set.source.data()),
        h_(static_cast<float>(set.grid.spacing)) {
    for (unsigned a = 0; a < 3; ++a)
      for (unsigned up = 0; up < 2; ++up) {
        Vec3 n;
        n[static_cast<int>(a)] = up ? 1.0 : -1.0;
        axis_normal_[a][up] = pack_normal(n);
      }
  }

  // Writes one piece from index `out` on, by edge code. Codes are unique within a piece, so a table of its 512 edges
  // sorts.
  void write(std::span<const Placed> crossings, std::uint32_t out) {
    std::uint64_t used[8] = {};
    for (std::uint16_t c = 0; c < crossings.size(); ++c) {
      const unsigned edge = crossings[c].code.bits >> 1 & 511;
      used[edge / 64] |= std::uint64_t{1} << edge % 64;
      table_[edge] = c;
      __builtin_prefetch(&normals_[crossings[c].source]);
    }
    for (unsigned word = 0; word < 8; ++word)
      for (std::uint64_t rest = used[word]; rest != 0; rest &= rest - 1)
        write(crossings[table_[word * 64 + static_cast<unsigned>(std::countr_zero(rest))]], out++);
  }

 private:
  void write(const Placed& c, std::uint32_t out) {
    constexpr float half = brick_size / 2.0f;
    const unsigned axis = c.code.axis();
    const auto along = [&](unsigned a, unsigned cell) { return (cell - half + (axis == a ? c.t : 0.0f)) * h_; };
    x_[out] = along(0, c.code.i());
    y_[out] = along(1, c.code.j());
    z_[out] = along(2, c.code.k());
    edge_[out] = c.code;
    if (source_ != nullptr) source_[out] = c.source;
    const SourceNormal& source = normals_[c.source];
    const bool upward = c.code.lower_end_inside();
    if (c.synthetic || source.degenerate()) {
      normal_[out] = axis_normal_[axis][upward];
      area_[out] = h_ * h_;
      if (!c.synthetic && source.missing()) normal_[out] = no_normal;
      return;
    }
    normal_[out] = is_upward(source.normal, axis) == upward ? source.normal : opposite(source.normal);
    area_[out] = source.area[axis];
  }

  const SourceNormal* normals_;
  float *x_, *y_, *z_, *area_;
  PackedNormal* normal_;
  EdgeCode* edge_;
  std::uint32_t* source_;
  float h_;
  PackedNormal axis_normal_[3][2];
  std::uint16_t table_[512];
};

SampleSet sample_with(const TriDexel& solid, const std::vector<SourceNormal>& normals, bool with_sources,
                      const ExecutionContext& context) {
  SampleSet set;
  set.grid = solid.grid;
  set.unresolved = solid.unresolved;
  set.thin = solid.thin;
  set.disagreements = solid.disagreements;
  set.cut_by_bounds = solid.cut_by_bounds;
  const PlacedAxes placed = place_all(solid, context);
  const std::vector<Piece> pieces = sorted_pieces(placed);
  const std::vector<std::uint32_t> first = make_blocks(pieces, set);
  resize_samples(set, set.blocks.empty() ? 0 : set.blocks.back().end, with_sources, context);
  parallel_for(context, set.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    BlockWriter writer(normals, set);
    for (std::size_t b = begin; b < end; ++b) {
      std::uint32_t out = set.blocks[b].begin;
      for (std::uint32_t i = first[b]; i < first[b + 1]; ++i) {
        const Piece &piece = pieces[i], &ahead = pieces[std::min<std::size_t>(i + 3, pieces.size() - 1)];
        __builtin_prefetch(&placed[static_cast<std::size_t>(ahead.axis())][ahead.slab].crossings[ahead.begin]);
        const PlacedSlab& slab = placed[static_cast<std::size_t>(piece.axis())][piece.slab];
        writer.write({slab.crossings.get() + piece.begin, piece.end - piece.begin}, out);
        out += piece.end - piece.begin;
      }
    }
  });
  mark_axes(set, context);
  sum_area(set, context);
  return set;
}

}  // namespace

SampleSet sample_dexels(const TriDexel& solid, const Mesh& mesh, const ExecutionContext& context) {
  return sample_with(solid, source_normals(mesh, solid.grid.spacing, context), true, context);
}

SampleSet sample_dexels(const TriDexel& solid, std::span<const PackedNormal> normals, const ExecutionContext& context) {
  SampleSet set = sample_with(solid, source_normals(normals, solid.grid.spacing, context), false, context);
  const auto missing = [](PackedNormal n) { return n.bits == no_normal.bits; };
  if (std::any_of(set.normal.begin(), set.normal.end(), missing)) {
    fit_missing_normals(set, context);
    sum_area(set, context);
  }
  return set;
}

}  // namespace evenmesh
