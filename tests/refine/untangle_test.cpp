#include "refine/untangle.h"

#include "refine/refine_testing.h"
#include "refine/vertex_rings.h"

namespace evenmesh {
namespace {

bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto volume = [](const Vec3& u, const Vec3& v, const Vec3& w, const Vec3& x) {
    return dot(cross(v - u, w - u), x - u);
  };
  if ((volume(a, b, c, p) > 0) == (volume(a, b, c, q) > 0)) return false;
  const bool s = volume(p, q, a, b) > 0, t = volume(p, q, b, c) > 0, u = volume(p, q, c, a) > 0;
  return s == t && t == u;
}

/// Pairs without a common corner that cross, by trying all.
std::vector<std::pair<std::uint32_t, std::uint32_t>> crossing_pairs(const Mesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  const auto cut = [&](const Triangle& s, const Triangle& t) {
    for (int c = 0; c < 3; ++c)
      if (crosses(mesh.vertices[s[c]], mesh.vertices[s[(c + 1) % 3]], mesh.vertices[t[0]], mesh.vertices[t[1]],
                  mesh.vertices[t[2]]))
        return true;
    return false;
  };
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::uint32_t j = 0; j < i; ++j) {
      const Triangle &s = mesh.triangles[i], &t = mesh.triangles[j];
      const bool adjacent = std::find_first_of(s.begin(), s.end(), t.begin(), t.end()) != s.end();
      if (!adjacent && (cut(s, t) || cut(t, s))) pairs.push_back({j, i});
    }
  return pairs;
}

TEST(Untangle, RepairsATangledSphere) {
  evenmesh::ExecutionContext context(1);
  const Shape shape = gallery_shape("sphere");
  const auto projector = make_projector(shape, shape.bounds, context);
  for (const Projector* onto :
       {static_cast<const Projector*>(projector.get()), static_cast<const Projector*>(nullptr)}) {
    Mesh mesh = make_icosphere(2);
    std::swap(mesh.vertices[20],
              mesh.vertices[60]);  // two vertices change places: their triangles cross everything between
    mesh.vertices[100] += 0.4 * Vec3{0.3, -0.5, 0.7};
    ASSERT_FALSE(crossing_pairs(mesh).empty());
    EXPECT_EQ(untangle(mesh, onto, crossing_pairs, context), 0u);
    EXPECT_TRUE(crossing_pairs(mesh).empty());
    expect_closed_manifold(mesh);
    EXPECT_GT(volume_of(mesh), 3);
    EXPECT_TRUE(triangles_below(mesh, 0.55).empty()) << "polished once it is apart";
  }
}

TEST(Untangle, LeavesGoodMeshesAlone) {
  evenmesh::ExecutionContext context(1);
  Mesh mesh = make_icosphere(2);
  const Mesh before = mesh;
  std::size_t searches = 0;
  const auto find = [&](const Mesh& m) { return ++searches, crossing_pairs(m); };
  EXPECT_EQ(untangle(mesh, nullptr, find, context), 0u);
  EXPECT_EQ(searches, 1u);
  EXPECT_EQ(mesh.vertices, before.vertices);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(Untangle, TellsHowManyAreLeftAndKeepsTheBest) {
  evenmesh::ExecutionContext context(1);
  // Two balls that overlap: no smoothing of a few rings pulls them apart.
  Mesh mesh = merged(make_icosphere(2), translated(make_icosphere(2), {0.31, 0.17, 0.05}));
  const std::size_t before = crossing_pairs(mesh).size();
  const std::size_t left = untangle(mesh, nullptr, crossing_pairs, context);
  EXPECT_LE(left, before);
  EXPECT_EQ(crossing_pairs(mesh).size(), left);
  expect_closed_manifold(mesh);
}

}  // namespace
}  // namespace evenmesh
