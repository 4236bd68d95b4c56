#include "topology/regularize.h"

#include <gtest/gtest.h>

namespace evenmesh {
namespace {

TEST(RegularizationBalls, StartWithHalfTheEdgeAndGrowToAllOfIt) {
  RegularizationBalls list(0.1, 1);
  const std::vector<BadEdge> edges{{{0, 0, 0}, {1, 0, 0}}};
  EXPECT_EQ(list.next_round(edges), std::vector<std::uint32_t>{0});
  ASSERT_EQ(list.balls().size(), 1u) << "its shortest projection is zero";
  EXPECT_EQ(list.balls()[0].center, (Vec3{0.5, 0, 0}));
  EXPECT_DOUBLE_EQ(list.balls()[0].radius, 0.5);
  for (int round = 1; round <= 10; ++round) {
    EXPECT_EQ(list.next_round(edges), std::vector<std::uint32_t>{0});
    EXPECT_NEAR(list.balls()[0].radius, 0.5 + 0.05 * round, 1e-12);
  }
  EXPECT_EQ(list.next_round(edges), std::vector<std::uint32_t>{1}) << "a grown ball makes room for a new one";
  EXPECT_EQ(list.balls().size(), 2u);
  EXPECT_NEAR(list.balls()[0].radius, 1, 1e-12);
}

TEST(RegularizationBalls, AreAsManyAsTheGridTells) {
  RegularizationBalls list(0.1, 1);
  // Shortest projection 0.5: five spacings.
  EXPECT_EQ(list.next_round(std::vector<BadEdge>{{{0, 0, 0}, {1, 0.5, 2}}}).size(), 3u);
  for (const Ball& ball : list.balls()) EXPECT_NEAR(ball.center.x, 2 * ball.center.y, 1e-12);
}

TEST(RegularizationBalls, NoLongerMetAreForgottenButStay) {
  RegularizationBalls list(0.1, 1);
  list.next_round(std::vector<BadEdge>{{{0, 0, 0}, {1, 0, 0}}});
  EXPECT_EQ(list.next_round(std::vector<BadEdge>{{{5, 0, 0}, {6, 0, 0}}}), std::vector<std::uint32_t>{1});
  EXPECT_EQ(list.next_round(std::vector<BadEdge>{{{0, 0, 0}, {1, 0, 0}}}), std::vector<std::uint32_t>{2});
  EXPECT_EQ(list.balls().size(), 3u);
  EXPECT_TRUE(list.next_round({}).empty());
}

TEST(RegularizationBalls, PointsHaveTheCommonEdgeLength) {
  RegularizationBalls list(0.1, 3);
  list.next_round(std::vector<BadEdge>{{{1, 2, 3}, {1, 2, 3}}});
  ASSERT_EQ(list.balls().size(), 1u);
  EXPECT_DOUBLE_EQ(list.balls()[0].radius, 1.5);
}

}  // namespace
}  // namespace evenmesh
