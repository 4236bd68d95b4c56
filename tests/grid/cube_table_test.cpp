#include "grid/cube_table.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "evenmesh/mesh.h"

namespace evenmesh {
namespace {

/// Lower and upper corner of an edge, from the numbering that the header describes.
std::pair<int, int> ends_of(int edge) {
  const int axis = edge / 4, a = edge & 1, b = edge >> 1 & 1;
  const int low = axis == 0 ? 2 * a + 4 * b : axis == 1 ? a + 4 * b : a + 2 * b;
  return {low, low | 1 << axis};
}
Vec3 corner_position(int c) {
  return {double(c & 1), double(c >> 1 & 1), double(c >> 2 & 1)};
}
Vec3 middle_of(int edge) {
  const auto [c, d] = ends_of(edge);
  return 0.5 * (corner_position(c) + corner_position(d));
}
bool is_inside(unsigned pattern, int corner) {
  return (pattern >> corner & 1u) != 0;
}
bool is_crossed(unsigned pattern, int edge) {
  return is_inside(pattern, ends_of(edge).first) != is_inside(pattern, ends_of(edge).second);
}

/// The face (axis, side) that two edges share, −1 if none; two edges of a cube share at most one.
int shared_face(int e, int f) {
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const auto on_face = [&](int edge) {
        const auto [c, d] = ends_of(edge);
        return (c >> axis & 1) == side && (d >> axis & 1) == side;
      };
      if (on_face(e) && on_face(f)) return 2 * axis + side;
    }
  return -1;
}

using Link = std::pair<int, int>;

/// Links of all loops by face, as pairs of edges.
std::map<int, std::set<Link>> links_by_face(unsigned pattern) {
  std::map<int, std::set<Link>> links;
  const CubeLoops& cube = cube_loops()[pattern];
  for (int l = 0; l < cube.count; ++l)
    for (int i = cube.start[l]; i < cube.start[l + 1]; ++i) {
      const int e = cube.edge[i], f = cube.edge[i + 1 == cube.start[l + 1] ? cube.start[l] : i + 1];
      links[shared_face(e, f)].insert({e, f});
    }
  return links;
}

TEST(CubeTable, EveryCrossedEdgeIsInExactlyOneLoop) {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    const CubeLoops& cube = cube_loops()[pattern];
    ASSERT_LE(cube.count, 4);
    ASSERT_EQ(cube.start[0], 0);
    std::array<int, 12> seen{};
    for (int l = 0; l < cube.count; ++l) {
      ASSERT_GE(cube.start[l + 1] - cube.start[l], 3) << pattern;
      for (int i = cube.start[l]; i < cube.start[l + 1]; ++i) ++seen[cube.edge[i]];
    }
    for (int e = 0; e < 12; ++e) EXPECT_EQ(seen[e], is_crossed(pattern, e) ? 1 : 0) << pattern;
  }
}

TEST(CubeTable, LoopsStepAcrossFacesAndTurnLeftSeenFromOutside) {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    EXPECT_FALSE(links_by_face(pattern).contains(-1)) << pattern;
    const CubeLoops& cube = cube_loops()[pattern];
    for (int l = 0; l < cube.count; ++l) {
      Vec3 area, outward;
      for (int i = cube.start[l]; i < cube.start[l + 1]; ++i) {
        const int e = cube.edge[i], f = cube.edge[i + 1 == cube.start[l + 1] ? cube.start[l] : i + 1];
        area += cross(middle_of(e), middle_of(f));
        const auto [c, d] = ends_of(e);
        outward += (is_inside(pattern, c) ? 1.0 : -1.0) * (corner_position(d) - corner_position(c));
      }
      EXPECT_GT(dot(area, outward), 0) << pattern;
    }
  }
}

TEST(CubeTable, NeighbouringCubesAgreeOnTheirFace) {
  // What happens on a face depends on its four corners alone, and the cube on the other side runs it backwards.
  for (int axis = 0; axis < 3; ++axis) {
    std::map<unsigned, std::set<Link>> links_of_corners;
    for (unsigned pattern = 0; pattern < 256; ++pattern) {
      const auto links = links_by_face(pattern);
      for (int side = 0; side < 2; ++side) {
        unsigned corners = 0, bit = 0;
        for (int c = 0; c < 8; ++c)
          if ((c >> axis & 1) == side) corners |= unsigned(is_inside(pattern, c)) << bit++;
        std::set<Link> normalized;
        const auto it = links.find(2 * axis + side);
        if (it != links.end())
          for (const auto& [e, f] : it->second) {
            // An edge by its place on the face; of the upper side backwards.
            const auto place = [&](int edge) {
              const Vec3 m = middle_of(edge);
              return static_cast<int>(2 * m[(axis + 1) % 3]) * 3 + static_cast<int>(2 * m[(axis + 2) % 3]);
            };
            normalized.insert(side == 0 ? Link{place(e), place(f)} : Link{place(f), place(e)});
          }
        const auto [known, fresh] = links_of_corners.insert({corners, normalized});
        EXPECT_EQ(known->second, normalized) << "axis " << axis << " pattern " << pattern;
      }
    }
    EXPECT_EQ(links_of_corners.size(), 16u);
  }
}

TEST(CubeTable, ComplementsRunBackwardsUnlessAFaceIsAmbiguous) {
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    const auto links = links_by_face(pattern), opposite = links_by_face(255 - pattern);
    for (const auto& [face, of_face] : links) {
      ASSERT_TRUE(opposite.contains(face));
      const auto& of_complement = opposite.at(face);
      EXPECT_EQ(of_face.size(), of_complement.size());
      if (of_face.size() != 1) continue;  // two links: the rule favours the inside corners
      const auto [e, f] = *of_face.begin();
      EXPECT_EQ(*of_complement.begin(), (Link{f, e}));
    }
  }
}

TEST(CubeTable, OfFourCrossingsThoseAroundAnInsideCornerBelongTogether) {
  const unsigned corners_0_and_3 = 1u << 0 | 1u << 3;  // diagonal on the face z = 0
  EXPECT_EQ(cube_loops()[corners_0_and_3].count, 2);
  const unsigned corners_0_and_7 = 1u << 0 | 1u << 7;
  EXPECT_EQ(cube_loops()[corners_0_and_7].count, 2);
  const unsigned four = 1u << 0 | 1u << 3 | 1u << 5 | 1u << 6;
  EXPECT_EQ(cube_loops()[four].count, 4);
  EXPECT_EQ(cube_loops()[0].count, 0);
  EXPECT_EQ(cube_loops()[255].count, 0);
}

TEST(CubeTable, CrossedEdgesTellTheCorners) {
  const auto& corners = corners_of_crossed_edges();
  std::set<unsigned> possible;
  for (unsigned pattern = 0; pattern < 256; pattern += 2) {  // corner 0 outside
    unsigned crossed = 0;
    for (int e = 0; e < 12; ++e) crossed |= unsigned(is_crossed(pattern, e)) << e;
    EXPECT_EQ(corners[crossed], pattern);
    possible.insert(crossed);
  }
  EXPECT_EQ(possible.size(), 128u);
  for (unsigned crossed = 0; crossed < 4096; ++crossed) {
    if (possible.contains(crossed)) continue;
    EXPECT_EQ(corners[crossed], 0) << crossed;
  }
}

}  // namespace
}  // namespace evenmesh
