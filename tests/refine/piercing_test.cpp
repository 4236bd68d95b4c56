#include "refine/piercing.h"

#include <gtest/gtest.h>

#include <array>

#include "geometry/primitives.h"

namespace evenmesh {
namespace {

constexpr std::array first{0u};

Mesh two_triangles(const Vec3& shift) {
  return {{{0, 0, 0},
           {1, 0, 0},
           {0, 1, 0},
           shift + Vec3{0.2, 0.2, -0.5},
           shift + Vec3{0.3, 0.2, 0.5},
           shift + Vec3{2, 2, 0.5}},
          {{0, 1, 2}, {3, 4, 5}}};
}

TEST(Piercing, IsFoundEitherWayRound) {
  for (const std::uint32_t t : {0u, 1u}) EXPECT_TRUE(any_pierces(two_triangles({}), std::array{t}));
}

TEST(Piercing, IsNotFoundApartOrBeside) {
  EXPECT_FALSE(any_pierces(two_triangles({3, 0, 0}), first));
  EXPECT_FALSE(any_pierces(two_triangles({0, 0, 0.6}), first));
}

TEST(Piercing, CommonVerticesDoNotCountButFoldsThroughOthersDo) {
  Mesh mesh = make_icosphere(2);
  std::vector<std::uint32_t> all(mesh.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  EXPECT_FALSE(any_pierces(mesh, all));
  mesh.vertices[20] *= -1.2;
  EXPECT_TRUE(any_pierces(mesh, all));
}

}  // namespace
}  // namespace evenmesh
