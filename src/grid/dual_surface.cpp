#include "grid/dual_surface.h"

#include "geometry/quadric.h"
#include "grid/brick_cubes.h"

namespace evenmesh {
namespace {

constexpr double towards_mean = 0.01;  ///< weight of the samples' mean, so that flat loops have a vertex

Vec3 vertex_of(const std::vector<Vec3>& position, const std::vector<PackedNormal>& normal, const std::uint32_t* loop,
               int length, double spacing) {
  Vec3 mean;
  for (int i = 0; i < length; ++i) mean += position[loop[i]];
  mean = mean / length;
  Quadric planes;  // about the mean
  planes.add_point({}, towards_mean * length);
  for (int i = 0; i < length; ++i) planes.add_plane(position[loop[i]] - mean, unpack_normal(normal[loop[i]]));
  const Vec3 step = planes.minimum();
  const double by = norm(step);
  return mean + (by > spacing ? step * (spacing / by) : step);
}

/// Corners of the quad around a crossing, counter-clockwise seen from where the solid is not.
std::array<std::uint32_t, 4> outward(const std::array<std::uint32_t, 4>& slots, EdgeCode edge) {
  // Slots 0, 1, 3, 2 turn from one axis to the next; for y that is the other way round.
  const bool straight = edge.lower_end_inside() == (edge.axis() != 1);
  return straight ? std::array{slots[0], slots[1], slots[3], slots[2]}
                  : std::array{slots[0], slots[2], slots[3], slots[1]};
}

}  // namespace

Mesh dual_surface(const SampleSet& samples, const ExecutionContext& context) {
  std::vector<Vec3> position(samples.size());
  parallel_for(context, samples.blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::uint32_t s = samples.blocks[b].begin; s < samples.blocks[b].end; ++s)
        position[s] = samples.block_center(samples.blocks[b]) + Vec3{samples.x[s], samples.y[s], samples.z[s]};
  });
  const std::vector<CubeBrick> bricks = cube_bricks(samples, context);
  std::vector<std::uint32_t> first(bricks.size() + 1, 0);
  const auto each = [&](const auto& visit) {
    parallel_for(context, bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
      CubeWalker walker(samples);
      for (std::size_t b = begin; b < end; ++b)
        walker.walk_edges(bricks[b], [&](const std::uint32_t* loop, const std::uint8_t* edges, int length) {
          visit(b, loop, edges, length);
        });
    });
  };
  each([&](std::size_t b, const std::uint32_t*, const std::uint8_t*, int) { ++first[b + 1]; });
  for (std::size_t b = 0; b < bricks.size(); ++b) first[b + 1] += first[b];
  Mesh mesh;
  mesh.vertices.resize(first.back());
  std::vector<std::array<std::uint32_t, 4>> slots(samples.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  each([&](std::size_t b, const std::uint32_t* loop, const std::uint8_t* edges, int length) {
    const std::uint32_t v = next[b]++;
    mesh.vertices[v] = vertex_of(position, samples.normal, loop, length, samples.grid.spacing);
    for (int i = 0; i < length; ++i) slots[loop[i]][edges[i] & 3u] = v;
  });
  mesh.triangles.resize(2 * samples.size());
  parallel_for(context, samples.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const auto q = outward(slots[s], samples.edge[s]);
      const auto diagonal = [&](std::size_t a, std::size_t b) {
        return squared_norm(mesh.vertices[q[a]] - mesh.vertices[q[b]]);
      };
      const bool even = diagonal(0, 2) <= diagonal(1, 3);
      mesh.triangles[2 * s] = even ? Triangle{q[0], q[1], q[2]} : Triangle{q[1], q[2], q[3]};
      mesh.triangles[2 * s + 1] = even ? Triangle{q[0], q[2], q[3]} : Triangle{q[1], q[3], q[0]};
    }
  });
  return mesh;
}

}  // namespace evenmesh
