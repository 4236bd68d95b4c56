#pragma once
/// Open, broken and scattered surfaces, and what every mesh by the shell method must be.

#include <algorithm>
#include <array>
#include <map>

#include "core/random.h"
#include "geometry/half_edges.h"
#include "geometry/single_precision.h"
#include "pipeline/pipeline_testing.h"

namespace evenmesh {

inline MeshOptions by_shell(std::size_t vertices, std::size_t resolution = 0) {
  MeshOptions options{.vertices = vertices, .method = Method::shell, .quality = Quality::fast};
  if (resolution > 0) options.resolution = resolution;
  return options;
}

/// The mesh as files hold it.
inline Mesh as_written(Mesh mesh) {
  if (fits_single_precision(mesh)) mesh.vertices = in_single_precision(mesh.vertices);
  return mesh;
}

/// Two-manifold, perhaps with boundary; every promise kept, and the report tells the same.
inline void expect_good_sheet(const MeshResult& result) {
  const MeshQuality q = measure_quality(result.mesh);
  EXPECT_GT(q.faces, 0u);
  EXPECT_TRUE(q.two_manifold()) << q.non_manifold_edges << " edges, " << q.non_manifold_vertices << " vertices";
  EXPECT_TRUE(q.oriented());
  EXPECT_EQ(q.unused_vertices, 0u);
  EXPECT_EQ(q.degenerate_faces, 0u);
  for (const Vec3& v : result.mesh.vertices) ASSERT_TRUE(is_finite(v));
  EXPECT_EQ(result.report.quality.faces, q.faces);
  EXPECT_EQ(result.report.seeds, result.mesh.vertices.size());
  EXPECT_EQ(result.report.self_intersections, self_intersections(as_written(result.mesh)).size());
  EXPECT_GT(result.report.sites, 0u);
  EXPECT_GT(result.report.shell_voxels, result.report.sites);
  EXPECT_GT(result.report.sheets, 0u);
  EXPECT_FALSE(breaks_a_promise(result.report));
}

/// Directed edges of one triangle, by where they start; of a two-manifold.
inline std::map<std::uint32_t, std::uint32_t> boundary_of(const Mesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) ++edges[{t[c], t[(c + 1) % 3]}], --edges[{t[(c + 1) % 3], t[c]}];
  std::map<std::uint32_t, std::uint32_t> boundary;
  for (const auto& [edge, count] : edges)
    if (count == 1) boundary[edge[0]] = edge[1];
  return boundary;
}

/// How many closed curves the boundary of a two-manifold consists of.
inline std::size_t boundary_loops(const Mesh& mesh) {
  auto next = boundary_of(mesh);
  std::size_t loops = 0;
  while (!next.empty()) {
    ++loops;
    for (auto at = next.begin(); at != next.end();) {
      const std::uint32_t to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  }
  return loops;
}

/// Edges at which two triangles lie on top of each other.
inline std::size_t folds(const Mesh& mesh) {
  const HalfEdges edges(mesh.triangles, mesh.vertices.size());
  const auto normal = [&](std::size_t t) {
    const Triangle& c = mesh.triangles[t];
    return normalized(cross(mesh.vertices[c[1]] - mesh.vertices[c[0]], mesh.vertices[c[2]] - mesh.vertices[c[0]]));
  };
  std::size_t count = 0;
  for (std::size_t h = 0; h < 3 * mesh.triangles.size(); ++h)
    if (const std::uint32_t o = edges.opposite(h); o != HalfEdges::none && o > h)
      count += dot(normal(h / 3), normal(o / 3)) < -0.9;
  return count;
}

inline Mesh hemisphere(int levels = 5) {
  Mesh mesh = make_icosphere(levels);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].z + mesh.vertices[t[1]].z + mesh.vertices[t[2]].z < 0;
  });
  return mesh;
}

/// A band around the z axis with `half_twists`, `width` wide; of an odd number it has one side only.
inline Mesh band(int half_twists, double width = 0.6, int around = 120, int across = 8) {
  Mesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j <= across; ++j) {
      const double turn = 2 * std::numbers::pi * i / around, twist = half_twists * turn / 2;
      const double s = width * (static_cast<double>(j) / across - 0.5), r = 1 + s * std::cos(twist);
      mesh.vertices.push_back({r * std::cos(turn), r * std::sin(turn), s * std::sin(twist)});
    }
  const auto at = [&](int i, int j) {
    if (i == around && half_twists % 2 != 0) j = across - j;
    return static_cast<std::uint32_t>(i % around * (across + 1) + j);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

/// The parallelogram at `corner` along u and v, normal u × v.
inline Mesh plate(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {{corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}}};
}

/// What happens to meshes: triangles lost, repeated, degenerate, and some that stand on end.
struct Damage {
  std::size_t lost = 0, repeated = 0, degenerate = 0, fins = 0;
};
inline Mesh damaged(Mesh mesh, const Damage& damage, std::uint64_t seed) {
  Random random(seed);
  const auto any = [&] { return mesh.triangles[random.below(mesh.triangles.size())]; };
  for (std::size_t i = 0; i < damage.lost; ++i) {
    std::swap(mesh.triangles[random.below(mesh.triangles.size())], mesh.triangles.back());
    mesh.triangles.pop_back();
  }
  std::vector<Triangle> more;
  for (std::size_t i = 0; i < damage.repeated; ++i) more.push_back(any());
  for (std::size_t i = 0; i < damage.degenerate; ++i) {
    const Triangle t = any();
    more.push_back(i % 2 == 0 ? Triangle{t[0], t[0], t[1]} : Triangle{t[2], t[2], t[2]});
  }
  for (std::size_t i = 0; i < damage.fins; ++i) {
    const Triangle t = any();
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]];
    more.push_back({t[0], t[1], static_cast<std::uint32_t>(mesh.vertices.size())});
    mesh.vertices.push_back(0.5 * (a + b) + 0.3 * normalized(a + b));
  }
  mesh.triangles.insert(mesh.triangles.end(), more.begin(), more.end());
  return mesh;
}

/// Random points of the unit sphere, with their normals if asked for.
inline PointCloud ball_of_points(std::size_t count, bool normals, std::uint64_t seed = 1) {
  Random random(seed);
  PointCloud cloud;
  while (cloud.points.size() < count) {
    const double x = random.gaussian(), y = random.gaussian(), z = random.gaussian();
    cloud.points.push_back(normalized({x, y, z}));
  }
  if (normals) cloud.normals = cloud.points;
  return cloud;
}

}  // namespace evenmesh
