#include "connect/flood.h"

#include "connect/connect_testing.h"
#include "grid/surface_components.h"

namespace evenmesh {
namespace {

/// Connected pieces of all cells.
std::size_t pieces_of(const SampleSet& samples, std::vector<std::uint32_t> labels, const std::vector<Vec3>& seeds) {
  evenmesh::ExecutionContext context(2);
  std::size_t pieces = 0;
  for (const CellComponent& piece : connect_labels(samples, labels, seeds, context).pieces) pieces += piece.area > 0;
  return pieces;
}

TEST(Flood, CellsOfAThinPlateStayOnTheirSide) {
  // All seeds lie on the upper side of a plate thinner than their spacing, but one.
  const SampleSet samples = sampled(make_box({1, 1, 0.05}), 120);
  std::vector<Vec3> seeds{{0, 0, -0.05}};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) seeds.push_back({0.33 * i - 0.83, 0.33 * j - 0.83, 0.05});
  const std::vector<std::uint32_t> nearest = nearest_labels(samples, seeds);
  ASSERT_GT(pieces_of(samples, nearest, seeds), 0u);
  evenmesh::ExecutionContext context(2);
  std::vector<std::uint32_t> labels = nearest;
  EXPECT_GT(flood_labels(samples, labels, seeds, context), samples.size() / 20);
  EXPECT_EQ(pieces_of(samples, labels, seeds), 0u);
  // What lies next to a seed stays with it.
  std::size_t same = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) same += labels[i] == nearest[i];
  EXPECT_GT(same, labels.size() / 3);
  for (const unsigned threads : {1u, 5u}) {
    evenmesh::ExecutionContext other(threads);
    std::vector<std::uint32_t> again = nearest;
    flood_labels(samples, again, seeds, other);
    EXPECT_EQ(again, labels);
  }
}

TEST(Flood, LeavesConnectedCellsAndWhatHasNoLabelAlone) {
  const SampleSet samples = sampled(make_icosphere(3), 60);
  const std::vector<Vec3> seeds{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::uint32_t> labels = nearest_labels(samples, seeds);
  for (std::size_t i = 0; i < labels.size(); ++i)
    if (labels[i] == 5) labels[i] = no_label;
  const std::vector<std::uint32_t> before = labels;
  evenmesh::ExecutionContext context(2);
  EXPECT_EQ(flood_labels(samples, labels, seeds, context), 0u);
  EXPECT_EQ(labels, before);
}

}  // namespace
}  // namespace evenmesh
