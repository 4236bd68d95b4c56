#include "pipeline/random_solids.h"

#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int scenes = 3, divisor = 8;  // sanitizers take their time
#else
constexpr int scenes = 30, divisor = 1;
#endif

class RandomSolid : public testing::TestWithParam<int> {};

TEST_P(RandomSolid, IsMeshedWhateverItIs) {
  RandomSolids random(static_cast<std::uint64_t>(GetParam()));
  const Shape shape = random.tree();
  const std::size_t vertices = random.vertices() / divisor;
  try {
    expect_good_mesh(meshed(shape, {.vertices = vertices}));
  } catch (const UnusableInput& nothing_left) {
    EXPECT_NE(std::string(nothing_left.what()).find("nothing is left"), std::string::npos) << nothing_left.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Booleans, RandomSolid, testing::Range(1, 1 + scenes));

}  // namespace
}  // namespace evenmesh
