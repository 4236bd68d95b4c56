#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <sstream>

#include "evenmesh/error.h"
#include "evenmesh/io.h"

namespace evenmesh {
namespace {

TEST(Vdb, ComesBackAsItWas) {
  const SparseVolume volume{"distance",        {1, -2, 3}, 0.25, 9, {{0, 0, 0}, {5, 6, 7}, {8000, 1, 2}, {-3, 4, 5}},
                            {0.5f, 1.5f, 0, 2}};
  std::istringstream in(serialize_vdb(volume), std::ios::binary);
  openvdb::initialize();
  const auto grids = openvdb::io::Stream(in).getGrids();
  ASSERT_EQ(grids->size(), 1u);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(grids->front());
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getName(), "distance");
  EXPECT_EQ(grid->background(), 9);
  EXPECT_EQ(grid->activeVoxelCount(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& v = volume.voxels[i];
    EXPECT_EQ(grid->getAccessor().getValue({v[0], v[1], v[2]}), volume.values[i]);
  }
  const openvdb::Vec3d p = grid->indexToWorld(openvdb::Coord(5, 6, 7));
  EXPECT_EQ(p, openvdb::Vec3d(1 + 1.25, -2 + 1.5, 3 + 1.75));
}

TEST(Vdb, RefusesWhatIsNoVolume) {
  EXPECT_THROW(serialize_vdb({"", {}, 0, 0, {}, {}}), InvalidInput);
  EXPECT_THROW(serialize_vdb({"", {}, 1, 0, {{1, 2, 3}}, {}}), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
