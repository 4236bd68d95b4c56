#include "refine/placement.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace evenmesh {
namespace {

constexpr double tikhonov = 0.5;  ///< weight of the centroid against the planes

/// Σ w, Σ w d, Σ w n nᵀ (upper triangle), Σ w n (n·d), with d = x − seed.
struct Quadric {
  double w = 0, d[3] = {}, a[6] = {}, b[3] = {};
  void add(const Quadric& q) {
    w += q.w;
    for (int i = 0; i < 3; ++i) d[i] += q.d[i];
    for (int i = 0; i < 3; ++i) b[i] += q.b[i];
    for (int i = 0; i < 6; ++i) a[i] += q.a[i];
  }
};

struct Entry {
  std::uint32_t label;
  Quadric quadric;
};

/// One entry per label of the block, in order of first appearance.
void collect_block(const SampleSet& samples, const SampleBlock& block, std::span<const std::uint32_t> labels,
                   std::span<const Vec3> seeds, std::vector<Entry>& entries) {
  const Vec3 center = samples.block_center(block);
  const std::size_t first = entries.size();
  std::size_t at = first;
  for (std::uint32_t i = block.begin; i < block.end; ++i) {
    if (at >= entries.size() || entries[at].label != labels[i]) {
      at = first;
      while (at < entries.size() && entries[at].label != labels[i]) ++at;
      if (at == entries.size()) entries.push_back({labels[i], {}});
    }
    Quadric& q = entries[at].quadric;
    const Vec3 d = center + Vec3{samples.x[i], samples.y[i], samples.z[i]} - seeds[labels[i]];
    const Vec3 n = unpack_normal(samples.normal[i]);
    const double w = samples.area[i], nd = w * dot(n, d);
    q.w += w;
    for (int a = 0; a < 3; ++a) {
      q.d[a] += w * d[a];
      q.b[a] += nd * n[a];
    }
    q.a[0] += w * n.x * n.x;
    q.a[1] += w * n.x * n.y;
    q.a[2] += w * n.x * n.z;
    q.a[3] += w * n.y * n.y;
    q.a[4] += w * n.y * n.z;
    q.a[5] += w * n.z * n.z;
  }
}

CellShape solve(const Quadric& q, const Vec3& seed) {
  if (!(q.w > 0)) return {0, seed, seed};
  const Vec3 to_centroid = Vec3{q.d[0], q.d[1], q.d[2]} / q.w;
  const double hold = tikhonov * q.w;
  Eigen::Matrix3d a;
  a << q.a[0] + hold, q.a[1], q.a[2], q.a[1], q.a[3] + hold, q.a[4], q.a[2], q.a[4], q.a[5] + hold;
  const Eigen::Vector3d b(q.b[0] + hold * to_centroid.x, q.b[1] + hold * to_centroid.y, q.b[2] + hold * to_centroid.z);
  const Eigen::Vector3d v = a.ldlt().solve(b);
  Vec3 move = Vec3{v.x(), v.y(), v.z()} - to_centroid;
  const double limit = 0.5 * std::sqrt(q.w / std::numbers::pi), length = norm(move);
  if (!std::isfinite(length)) move = {};
  if (length > limit) move *= limit / length;
  const Vec3 centroid = seed + to_centroid;
  return {q.w, centroid, centroid + move};
}

/// What all blocks say of each label, in their order. Every thread reads all entries, and adds up those of its labels.
std::vector<Quadric> sums_by_label(const std::vector<std::vector<Entry>>& lists, std::size_t labels,
                                   const ExecutionContext& context) {
  constexpr std::size_t max_ranges = 8;
  const std::size_t ranges = std::min(threads_here(), max_ranges);
  std::vector<Quadric> quadrics(labels);
  parallel_tasks(context, ranges, [&](std::size_t range) {
    const std::size_t first = labels * range / ranges, last = labels * (range + 1) / ranges;
    for (const auto& list : lists)
      for (const Entry& e : list)
        if (e.label >= first && e.label < last) quadrics[e.label].add(e.quadric);
  });
  return quadrics;
}

}  // namespace

std::vector<CellShape> cell_shapes(const SampleSet& samples, std::span<const std::uint32_t> labels,
                                   std::span<const Vec3> seeds, ExecutionContext& context) {
  constexpr std::size_t chunk = 256;
  std::vector<std::vector<Entry>> entries((samples.blocks.size() + chunk - 1) / chunk);
  parallel_tasks(context, entries.size(), [&](std::size_t c) {
    for (std::size_t b = c * chunk; b < std::min(samples.blocks.size(), (c + 1) * chunk); ++b)
      collect_block(samples, samples.blocks[b], labels, seeds, entries[c]);
  });
  const std::vector<Quadric> quadrics = sums_by_label(entries, seeds.size(), context);
  std::vector<CellShape> shapes(seeds.size());
  parallel_for(context, seeds.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) shapes[i] = solve(quadrics[i], seeds[i]);
  });
  return shapes;
}

}  // namespace evenmesh
