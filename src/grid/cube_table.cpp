#include "grid/cube_table.h"

namespace evenmesh {
namespace {

constexpr int corner(int x, int y, int z) {
  return x + 2 * y + 4 * z;
}

/// Edge between two neighbouring corners.
int edge_between(int c, int d) {
  const int axis = (c ^ d) == 1 ? 0 : (c ^ d) == 2 ? 1 : 2;
  const int low = c & d;
  const int x = low & 1, y = low >> 1 & 1, z = low >> 2 & 1;
  const int a = axis == 0 ? y : x, b = axis == 2 ? y : z;
  return 4 * axis + a + 2 * b;
}

/// The four corners of each face, counter-clockwise seen from outside the cube.
constexpr int face_corners[6][4] = {
    {corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0)},
    {corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)},
    {corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)},
    {corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0)},
    {corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0)},
    {corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)},
};

bool on_lower_face(int edge, int other) {
  constexpr unsigned faces[12] = {6, 4, 2, 0, 5, 4, 1, 0, 3, 2, 1, 0};  // bit a: the edge lies where axis a is 0
  return (faces[edge] & faces[other]) != 0;
}

CubeLoops loops_of(unsigned inside) {
  const auto is_inside = [&](int c) { return (inside >> c & 1u) != 0; };
  std::array<int, 12> next{};
  next.fill(-1);
  for (const auto& face : face_corners)
    for (int i = 0; i < 4; ++i) {
      if (is_inside(face[i]) || !is_inside(face[(i + 1) % 4])) continue;
      // Entering an inside run at this edge; the link joins it with the edge where the run ends.
      int j = (i + 1) % 4;
      while (is_inside(face[(j + 1) % 4])) j = (j + 1) % 4;
      next[edge_between(face[i], face[(i + 1) % 4])] = edge_between(face[j], face[(j + 1) % 4]);
    }
  CubeLoops loops;
  std::array<bool, 12> done{};
  int filled = 0;
  for (int first = 0; first < 12; ++first) {
    if (next[first] < 0 || done[first]) continue;
    for (int e = first; !done[e]; e = next[e]) {
      done[e] = true;
      if (on_lower_face(e, next[e])) loops.lower_links |= static_cast<std::uint16_t>(1u << filled);
      loops.edge[filled++] = static_cast<std::uint8_t>(e);
    }
    loops.start[++loops.count] = static_cast<std::uint8_t>(filled);
  }
  return loops;
}

}  // namespace

const std::array<CubeLoops, 256>& cube_loops() {
  static const auto table = [] {
    std::array<CubeLoops, 256> t;
    for (unsigned inside = 0; inside < 256; ++inside) t[inside] = loops_of(inside);
    return t;
  }();
  return table;
}

const std::array<std::uint8_t, 4096>& corners_of_crossed_edges() {
  static const auto table = [] {
    std::array<std::uint8_t, 4096> t{};
    for (unsigned inside = 0; inside < 256; inside += 2) {
      unsigned crossed = 0;
      for (int c = 0; c < 8; ++c)
        for (const int bit : {1, 2, 4})
          if (!(c & bit) && ((inside >> c ^ inside >> (c | bit)) & 1u)) crossed |= 1u << edge_between(c, c | bit);
      t[crossed] = static_cast<std::uint8_t>(inside);
    }
    return t;
  }();
  return table;
}

}  // namespace evenmesh
