#include "features/edge_graph.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/brick_union.h"

namespace evenmesh {
namespace {

constexpr double weak_angle = 0.65;   ///< of the angle asked for: down to this feature curves go on that fade
constexpr double clear_angle = 1.75;  ///< of it: no noise

/// A sharp link as a cube sees it; the cube on the other side of the face has the same key.
struct HalfLink {
  std::uint64_t key;  ///< lower sample << 32 | higher sample
  std::uint32_t node;
  Sharpness sharpness;
  friend bool operator<(const HalfLink& a, const HalfLink& b) {
    return a.key != b.key ? a.key < b.key : a.node < b.node;
  }
};

struct BrickNodes {
  std::vector<FeatureNode> nodes;
  std::vector<HalfLink> links;  ///< nodes numbered within the brick
  std::uint32_t loops = 0;      ///< creased or not

  /// Even where several feature curves meet most of the surface around is smooth; on fractals most of it is not.
  bool rough() const { return nodes.size() > 32 && 2 * nodes.size() > loops; }
};

/// Bounds of packed normals in the square of their octahedral map.
struct NormalRange {
  std::array<int, 2> lo{0xffff, 0xffff}, hi{0, 0};
  void add(PackedNormal normal) {
    const int at[2] = {static_cast<int>(normal.bits & 0xffff), static_cast<int>(normal.bits >> 16)};
    for (std::size_t a = 0; a < 2; ++a) {
      lo[a] = std::min(lo[a], at[a]);
      hi[a] = std::max(hi[a], at[a]);
    }
  }
  void add(const NormalRange& other) {
    for (std::size_t a = 0; a < 2; ++a) {
      lo[a] = std::min(lo[a], other.lo[a]);
      hi[a] = std::max(hi[a], other.hi[a]);
    }
  }
  int width() const { return std::max(hi[0] - lo[0], hi[1] - lo[1]); }
};

/// By block.
std::vector<NormalRange> normal_ranges(const SampleSet& samples, const ExecutionContext& context) {
  std::vector<NormalRange> ranges(samples.blocks.size());
  parallel_for(context, ranges.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for (std::uint32_t s = samples.blocks[b].begin; s < samples.blocks[b].end; ++s) ranges[b].add(samples.normal[s]);
  });
  return ranges;
}

class Finder {
 public:
  Finder(const SampleSet& samples, double angle, const ExecutionContext& context)
      : samples_(samples),
        ranges_(normal_ranges(samples, context)),
        clear_(cosine(std::min(clear_angle * angle, 170.0))),
        sharp_(cosine(angle)),
        weak_(cosine(weak_angle * angle)),
        safe_step_(static_cast<int>(32767 * std::acos(weak_) / (3 * std::numbers::sqrt2)) - 2) {}

  /// Whether nothing in the brick can be creased.
  bool is_smooth(const CubeBrick& brick) const {
    NormalRange all;
    for (const std::int64_t b : brick.block)
      if (b >= 0) all.add(ranges_[static_cast<std::size_t>(b)]);
    return all.width() < safe_step_;
  }

  void visit(const CubeBrick& brick, const std::uint32_t* loop, int n, BrickNodes& found) const {
    ++found.loops;
    if (is_smooth(loop, n)) return;
    const auto after = [n](int i) { return i + 1 == n ? 0 : i + 1; };
    std::array<Vec3, 12> normal;
    for (int i = 0; i < n; ++i) normal[i] = unpack_normal(samples_.normal[loop[i]]);
    bool creased = false;
    for (int i = 0; i < n; ++i) creased |= dot(normal[i], normal[after(i)]) < weak_;
    if (!creased) return;
    const auto node = static_cast<std::uint32_t>(found.nodes.size());
    for (int i = 0; i < n; ++i)
      if (const double cosine = dot(normal[i], normal[after(i)]); cosine < weak_) {
        const auto [s, t] = std::minmax(loop[i], loop[after(i)]);
        found.links.push_back({std::uint64_t{s} << 32 | t, node, sharpness(cosine)});
      }
    found.nodes.push_back(make_node(brick, loop, normal.data(), n));
  }

 private:
  static double cosine(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }
  Sharpness sharpness(double cosine) const {
    return cosine < clear_ ? Sharpness::clear : cosine < sharp_ ? Sharpness::sharp : Sharpness::weak;
  }

  bool is_smooth(const std::uint32_t* loop, int n) const {
    PackedNormal before = samples_.normal[loop[n - 1]];
    for (int i = 0; i < n; ++i) {
      const PackedNormal normal = samples_.normal[loop[i]];
      if (!are_nearly_same(before, normal)) return false;
      before = normal;
    }
    return true;
  }
  /// Whether the angle is surely below the limit: in the octahedral map a step of length d is an angle of 3·d at most.
  bool are_nearly_same(PackedNormal a, PackedNormal b) const {
    const int u = int(a.bits & 0xffff) - int(b.bits & 0xffff), v = int(a.bits >> 16) - int(b.bits >> 16);
    return std::abs(u) < safe_step_ && std::abs(v) < safe_step_;
  }

  FeatureNode make_node(const CubeBrick& brick, const std::uint32_t* loop, const Vec3* normal, int n) const {
    FeatureNode node;
    double weight = 0, area = 0, least = 2;
    Box box;
    for (int i = 0; i < n; ++i) {
      if (const Vec3& a = normal[i], &b = normal[i + 1 == n ? 0 : i + 1]; dot(a, b) < least) {
        least = dot(a, b);
        node.sides = {a, b};
      }
      const Vec3 p = position(brick, loop[i]) - samples_.grid.origin;
      node.planes.add_plane(p, normal[i]);
      box.add(p);
      weight += samples_.weights()[loop[i]];
      area += samples_.area[loop[i]];
    }
    // Weights are (mean edge / edge)⁴ · area (weigh_by_density).
    if (!samples_.even() && area > 0) node.relative_sizing = std::sqrt(std::sqrt(weight / area));
    node.place = node.planes.minimum(2, 2);
    const double margin = 0.75 * samples_.grid.spacing;
    for (int a = 0; a < 3; ++a) node.place[a] = std::clamp(node.place[a], box.lo[a] - margin, box.hi[a] + margin);
    node.place += samples_.grid.origin;
    return node;
  }

  Vec3 position(const CubeBrick& brick, std::uint32_t s) const {
    for (const std::int64_t b : brick.block) {
      if (b < 0) continue;
      const SampleBlock& block = samples_.blocks[static_cast<std::size_t>(b)];
      if (s >= block.begin && s < block.end)
        return samples_.block_center(block) + Vec3{samples_.x[s], samples_.y[s], samples_.z[s]};
    }
    return {};
  }

  const SampleSet& samples_;
  std::vector<NormalRange> ranges_;
  double clear_, sharp_, weak_;  ///< cosines
  int safe_step_;                ///< of either coordinate of packed normals
};

}  // namespace

bool face_apart(const FeatureNode& a, const FeatureNode& b, const Vec3& across) {
  constexpr double facing = 0.8;
  const auto least = [&](const FeatureNode& node) {
    return std::min(dot(node.sides[0], across), dot(node.sides[1], across));
  };
  const auto most = [&](const FeatureNode& node) {
    return std::max(dot(node.sides[0], across), dot(node.sides[1], across));
  };
  return (least(a) < -facing && most(b) > facing) || (most(a) > facing && least(b) < -facing);
}

FeatureGraph find_feature_graph(const SampleSet& samples, double angle, ExecutionContext& context) {
  const auto bricks = cube_bricks(samples, context);
  std::vector<BrickNodes> of_brick(bricks.size());
  const Finder finder(samples, angle, context);
  parallel_for(context, bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    CubeWalker walker(samples);
    for (std::size_t b = begin; b < end; ++b)
      if (!finder.is_smooth(bricks[b]))
        walker.walk(bricks[b],
                    [&](const std::uint32_t* loop, int n) { finder.visit(bricks[b], loop, n, of_brick[b]); });
  });
  FeatureGraph graph;
  std::vector<HalfLink> halves;
  for (BrickNodes& found : of_brick) {
    if (found.rough()) {
      graph.nodes.push_back(found.nodes.front());
      continue;
    }
    const auto first = static_cast<std::uint32_t>(graph.nodes.size());
    graph.nodes.insert(graph.nodes.end(), found.nodes.begin(), found.nodes.end());
    for (const HalfLink& link : found.links) halves.push_back({link.key, first + link.node, link.sharpness});
  }
  parallel_sort(context, halves);
  for (std::size_t i = 0; i + 1 < halves.size(); ++i)
    if (halves[i].key == halves[i + 1].key) {
      graph.links.push_back({halves[i].node, halves[i + 1].node});
      graph.sharpness.push_back(halves[i].sharpness);
    }
  return graph;
}

}  // namespace evenmesh
