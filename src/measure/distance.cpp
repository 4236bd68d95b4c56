#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "evenmesh/measure.h"
#include "geometry/closest_point.h"
#include "geometry/triangle.h"
#include "measure/crease_distance.h"

namespace evenmesh {
namespace {

/// Points spread evenly by area over a mesh. Sample i is a function of the mesh, the count and i alone.
class AreaSampler {
 public:
  AreaSampler(const Mesh& mesh, std::size_t samples) : mesh_(mesh), samples_(samples) {
    up_to_.reserve(mesh.triangles.size());
    double total = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [a, b, c] = corners_of(mesh, t);
      up_to_.push_back(total += triangle_area(a, b, c));
    }
  }

  struct Sample {
    std::size_t triangle;
    Vec3 point;
  };

  /// One sample in each of `samples` equal parts of the area, in the order of the triangles.
  Sample operator()(std::size_t i) const {
    Random random(0x5851f42d4c957f2d * (i + 1));
    const double share = (static_cast<double>(i) + random.uniform()) / static_cast<double>(samples_) * up_to_.back();
    const auto at = std::upper_bound(up_to_.begin(), up_to_.end(), share);
    const auto t = std::min(static_cast<std::size_t>(at - up_to_.begin()), up_to_.size() - 1);
    const auto [a, b, c] = corners_of(mesh_, t);
    // Uniform in the triangle (Osada et al., Shape Distributions, ToG 2002, §4.2).
    const double r = std::sqrt(random.uniform()), s = random.uniform();
    return {t, (1 - r) * a + (r * (1 - s)) * b + (r * s) * c};
  }

 private:
  const Mesh& mesh_;
  std::size_t samples_;
  std::vector<double> up_to_;  ///< area of the triangles up to and including this one
};

/// Distances seen by a piece of the queries.
struct Tally {
  double largest_squared = 0, squares = 0, sum = 0, angles = 0;

  void add(const Tally& t) {
    largest_squared = std::max(largest_squared, t.largest_squared);
    squares += t.squares;
    sum += t.sum;
    angles += t.angles;
  }
};

/// Closest points of queries that come in spatial order: the previous answer bounds the next.
class Follower {
 public:
  explicit Follower(const SurfaceQuery& query) : query_(query) {}
  ClosestPoint closest(const Vec3& p) {
    // Both distances are rounded, hence the margin; should it not suffice, the search starts anew without a limit.
    ClosestPoint found = query_.closest(p, (distance_ + norm(p - previous_)) * (1 + 1e-9));
    if (!found.found()) found = query_.closest(p);
    previous_ = p;
    distance_ = std::sqrt(found.squared_distance);
    return found;
  }

 private:
  const SurfaceQuery& query_;
  Vec3 previous_;
  double distance_ = std::numeric_limits<double>::infinity();
};

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

constexpr std::size_t piece = 4096;  // fixed, so that sums are the same for any number of threads

template <typename Body>
Tally sum_pieces(const ExecutionContext& context, std::size_t count, const Body& body) {
  std::vector<Tally> tallies((count + piece - 1) / piece);
  parallel_tasks(context, tallies.size(),
                 [&](std::size_t i) { tallies[i] = body(i * piece, std::min((i + 1) * piece, count)); });
  Tally total;
  for (const Tally& t : tallies) total.add(t);
  return total;
}

/// Vertices that triangles use, in the order in which these name them: neighbours in a row.
std::vector<Vec3> used_vertices(const Mesh& mesh) {
  std::vector<bool> seen(mesh.vertices.size(), false);
  std::vector<Vec3> used;
  used.reserve(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      if (!seen[v]) {
        seen[v] = true;
        used.push_back(mesh.vertices[v]);
      }
  return used;
}

/// From the vertices and area samples of `from` to the surface of `to`.
Tally one_sided(const Mesh& from, const Mesh& to, const SurfaceQuery& query, std::size_t samples,
                const ExecutionContext& context) {
  const std::vector<Vec3> vertices = used_vertices(from);
  const Tally at_vertices = sum_pieces(context, vertices.size(), [&](std::size_t begin, std::size_t end) {
    Tally tally;
    Follower follower(query);
    for (std::size_t i = begin; i < end; ++i)
      tally.largest_squared = std::max(tally.largest_squared, follower.closest(vertices[i]).squared_distance);
    return tally;
  });
  const AreaSampler sampler(from, samples);
  Tally tally = sum_pieces(context, samples, [&](std::size_t begin, std::size_t end) {
    Tally t;
    Follower follower(query);
    for (std::size_t i = begin; i < end; ++i) {
      const auto [triangle, point] = sampler(i);
      const ClosestPoint found = follower.closest(point);
      t.largest_squared = std::max(t.largest_squared, found.squared_distance);
      t.squares += found.squared_distance;
      t.sum += std::sqrt(found.squared_distance);
      const auto [a, b, c] = corners_of(from, triangle);
      const auto [d, e, f] = corners_of(to, found.triangle);
      t.angles += angle_between(area_normal(a, b, c), area_normal(d, e, f));
    }
    return t;
  });
  tally.largest_squared = std::max(tally.largest_squared, at_vertices.largest_squared);
  return tally;
}

}  // namespace

MeshDistance compare_meshes(const Mesh& a, const Mesh& b, const CompareOptions& options, ExecutionContext& context) {
  if (a.triangles.empty() || b.triangles.empty())
    throw InvalidInput("a mesh without triangles has no distance; give two meshes with at least one triangle each");
  if (options.samples < 1 || options.samples > 1'000'000'000)
    throw InvalidInput("the number of samples must lie between 1 and 1,000,000,000");
  const SurfaceQuery query_a(a, context), query_b(b, context);
  return with_threads(context, [&] {
    const Tally from_a = one_sided(a, b, query_b, options.samples, context);
    const Tally from_b = one_sided(b, a, query_a, options.samples, context);
    const auto samples = static_cast<double>(options.samples);
    MeshDistance result;
    result.a_to_b_max = std::sqrt(from_a.largest_squared);
    result.b_to_a_max = std::sqrt(from_b.largest_squared);
    result.a_to_b_rms = std::sqrt(from_a.squares / samples);
    result.b_to_a_rms = std::sqrt(from_b.squares / samples);
    result.a_to_b_mean = from_a.sum / samples;
    result.b_to_a_mean = from_b.sum / samples;
    result.normal_deviation_avg = from_a.angles / samples;
    result.reference_diagonal = b.bounds().diagonal();
    result.edge_length_avg = mean_edge_length(a);
    const CreaseDistance features = crease_distance(b, a, 0.1 * result.edge_length_avg, context);
    result.crease_max = features.largest;
    result.crease_avg = features.mean;
    result.crease_length = features.length;
    return result;
  });
}

}  // namespace evenmesh
