#include "topology/ambiguous_faces.h"

#include <tbb/enumerable_thread_specific.h>

#include <array>

#include "grid/brick_cubes.h"

namespace evenmesh {
bool has_diagonal_face(unsigned corners) {
  for (int axis = 0; axis < 3; ++axis)
    for (int level = 0; level < 2; ++level) {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, at = level << axis;
      const auto in = [&](int c) { return (corners >> c & 1u) != 0; };
      if (in(at) == in(at + u + v) && in(at + u) == in(at + v) && in(at) != in(at + u)) return true;
    }
  return false;
}

std::vector<Vec3> find_ambiguous_faces(const SampleSet& samples, ExecutionContext& context) {
  std::array<bool, 256> ambiguous{};
  for (unsigned c = 0; c < 256; ++c) ambiguous[c] = has_diagonal_face(c);
  const auto bricks = cube_bricks(samples, context);
  std::vector<std::vector<Vec3>> of_brick(bricks.size());
  tbb::enumerable_thread_specific<CubeWalker> walkers([&] { return CubeWalker(samples); });
  parallel_for(context, bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      walkers.local().walk_cubes(bricks[b], [&](unsigned corners, int i, int j, int k) {
        if (!ambiguous[corners]) return;
        const auto& at = bricks[b].at;
        of_brick[b].push_back(samples.grid.point(8 * at[0] + i + 0.5, 8 * at[1] + j + 0.5, 8 * at[2] + k + 0.5));
      });
  });
  std::vector<Vec3> all;
  for (const auto& list : of_brick) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace evenmesh
