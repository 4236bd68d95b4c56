#include <algorithm>
#include <array>
#include <bitset>

#include "grid/morton.h"
#include "sample/field_parts.h"

namespace evenmesh {
namespace {

constexpr unsigned n = brick_size;
using Signs = std::bitset<n * n * n>;

std::size_t at(unsigned i, unsigned j, unsigned k) {
  return (i * n + j) * n + k;
}

/// What the samples of a brick say of its grid points.
struct BrickSigns {
  std::array<Signs, 3> crossed;  ///< by axis: the edge from a point upwards
  Signs inside;

  BrickSigns(const FieldPart& part, const SampleBlock& block) {
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const EdgeCode e = part.edge[s];
      crossed[e.axis()].set(at(e.i(), e.j(), e.k()));
    }
    for (unsigned i = 0; i < n; ++i)
      for (unsigned j = 0; j < n; ++j)
        for (unsigned k = 0; k < n; ++k) {
          if (k > 0)
            inside[at(i, j, k)] = inside[at(i, j, k - 1)] != crossed[2][at(i, j, k - 1)];
          else if (j > 0)
            inside[at(i, j, k)] = inside[at(i, j - 1, k)] != crossed[1][at(i, j - 1, k)];
          else if (i > 0)
            inside[at(i, j, k)] = inside[at(i - 1, j, k)] != crossed[0][at(i - 1, j, k)];
        }
  }

  /// Whether points on a face differ: the brick's lowest ones along an axis, or those just above it.
  bool is_mixed(unsigned axis, bool above) const {
    bool first = false;
    for (unsigned u = 0; u < n; ++u)
      for (unsigned v = 0; v < n; ++v) {
        std::array<unsigned, 3> p{};
        p[axis] = above ? n - 1 : 0;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        const std::size_t point = at(p[0], p[1], p[2]);
        const bool sign = above ? inside[point] != crossed[axis][point] : inside[point];
        if (u == 0 && v == 0) first = sign;
        if (sign != first) return true;
      }
    return false;
  }
};

std::uint64_t code_of(const SampleBlock& block) {
  return morton_code(block.brick[0], block.brick[1], block.brick[2]);
}

}  // namespace

std::vector<GridCube> surface_continuation(std::span<const FieldPart> parts, std::size_t fresh,
                                           const ExecutionContext& context) {
  std::vector<std::uint64_t> known;
  for (const FieldPart& part : parts)
    for (const SampleBlock& block : part.blocks) known.push_back(code_of(block));
  std::sort(known.begin(), known.end());
  std::vector<std::vector<std::uint64_t>> found(parts.size());
  parallel_for(context, parts.size() - fresh, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = fresh + begin; p < fresh + end; ++p)
      for (const SampleBlock& block : parts[p].blocks) {
        const BrickSigns signs(parts[p], block);
        for (unsigned axis = 0; axis < 3; ++axis)
          for (const bool above : {false, true}) {
            auto brick = block.brick;
            if (!above && brick[axis] == 0) continue;
            brick[axis] = static_cast<std::uint16_t>(brick[axis] + (above ? 1 : -1));
            const std::uint64_t code = morton_code(brick[0], brick[1], brick[2]);
            if (!std::binary_search(known.begin(), known.end(), code) && signs.is_mixed(axis, above))
              found[p].push_back(code);
          }
      }
  });
  std::vector<std::uint64_t> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<GridCube> cubes;
  for (const std::uint64_t code : all) {
    const auto brick = morton_decode(code);
    cubes.push_back({{brick[0] * n, brick[1] * n, brick[2] * n}, n});
  }
  return cubes;
}

}  // namespace evenmesh
