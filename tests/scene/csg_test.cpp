/// OpenSCAD's .csg: bodies with known volumes, sets, motions, and where it says that something is wrong.

#include <cmath>
#include <numbers>

#include "scene_testing.h"

namespace evenmesh::testing_scene {
namespace {

class Csg : public SceneTest {
 protected:
  void says(const std::string& text, const std::string& words) const { expect_says(refusal(text, "a.csg"), words); }
};

/// The one mesh of a scene, closed.
const Mesh& only_mesh(const Shape& shape) {
  EXPECT_NE(shape.mesh(), nullptr);
  if (shape.mesh() == nullptr) throw std::runtime_error("no mesh");
  expect_closed(*shape.mesh());
  return *shape.mesh();
}

/// Area of the regular polygon in a circle.
double polygon_area(double n, double r) {
  return n / 2 * r * r * std::sin(2 * std::numbers::pi / n);
}

TEST_F(Csg, Cubes) {
  const Shape shape = csg("cube(size = [1, 2, 3], center = false);");
  EXPECT_NEAR(volume(only_mesh(shape)), 6, 1e-12);
  expect_box(shape.bounds, {0, 0, 0}, {1, 2, 3});
  expect_box(csg("cube(size = 2, center = true);").bounds, {-1, -1, -1}, {1, 1, 1});
  expect_box(csg("cube();").bounds, {0, 0, 0}, {1, 1, 1});
}

TEST_F(Csg, CylindersAndCones) {
  const Shape shape = csg("cylinder($fn = 8, $fa = 12, $fs = 2, h = 3, r1 = 2, r2 = 2, center = true);");
  EXPECT_NEAR(volume(only_mesh(shape)), 3 * polygon_area(8, 2), 1e-9);
  expect_box(shape.bounds, {-2, -2, -1.5}, {2, 2, 1.5}, 1e-9);
  const double cone = volume(only_mesh(csg("cylinder($fn = 8, h = 3, r1 = 2, r2 = 0);")));
  EXPECT_NEAR(cone, polygon_area(8, 2), 1e-9);
  EXPECT_NEAR(volume(only_mesh(csg("cylinder($fn = 8, h = 3, r1 = 0, r2 = 2);"))), cone, 1e-9);
}

TEST_F(Csg, RoundnessFollowsOpenScad) {
  const auto corners = [&](const std::string& arguments) {
    return (csg("cylinder(" + arguments + ", h = 1);").mesh()->vertices.size() - 2) / 2;
  };
  EXPECT_EQ(corners("$fn = 7, r1 = 9, r2 = 9"), 7u);
  EXPECT_EQ(corners("$fn = 1, r1 = 9, r2 = 9"), 3u);
  EXPECT_EQ(corners("$fn = 0, $fa = 12, $fs = 2, r1 = 100, r2 = 100"), 30u) << "limited by the angle";
  EXPECT_EQ(corners("$fn = 0, $fa = 12, $fs = 2, r1 = 5, r2 = 2"), 16u) << "limited by the length: ⌈2π·5 / 2⌉";
  EXPECT_EQ(corners("$fn = 0, $fa = 12, $fs = 2, r1 = 1, r2 = 1"), 5u) << "never below five";
}

TEST_F(Csg, SpheresHaveRingsHalfAStepFromThePoles) {
  const Shape shape = csg("sphere($fn = 64, $fa = 12, $fs = 2, r = 1);");
  EXPECT_NEAR(volume(only_mesh(shape)), 4 * std::numbers::pi / 3, 0.02);
  EXPECT_NEAR(shape.bounds.hi.z, std::cos(std::numbers::pi / 64), 1e-12);
  EXPECT_EQ(shape.mesh()->vertices.size(), 64u * 32 + 2);
}

TEST_F(Csg, PolyhedraTurnOutward) {
  const std::string points = "points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], ";
  const std::string clockwise = "faces = [[0,1,2],[0,3,1],[1,3,2],[2,3,0]]";
  const std::string other = "faces = [[0,2,1],[0,1,3],[1,2,3],[2,0,3]]";
  EXPECT_NEAR(volume(only_mesh(csg("polyhedron(" + points + clockwise + ", convexity = 1);"))), 1.0 / 6, 1e-12);
  EXPECT_NEAR(volume(only_mesh(csg("polyhedron(" + points + other + ");"))), 1.0 / 6, 1e-12);
  // A box with an L-shaped front: a face that is not convex.
  const Shape l =
      csg("polyhedron(points = [[0,0,0],[2,0,0],[2,1,0],[1,1,0],[1,2,0],[0,2,0],"
          "[0,0,1],[2,0,1],[2,1,1],[1,1,1],[1,2,1],[0,2,1]], faces = [[0,1,2,3,4,5],[11,10,9,8,7,6],"
          "[6,7,1,0],[7,8,2,1],[8,9,3,2],[9,10,4,3],[10,11,5,4],[11,6,0,5]]);");
  EXPECT_NEAR(volume(only_mesh(l)), 3, 1e-12);
}

TEST_F(Csg, LinearExtrusion) {
  EXPECT_NEAR(volume(only_mesh(csg("linear_extrude(height = 3) { square(size = [1, 2], center = true); }"))), 6, 1e-12);
  const Shape centered = csg("linear_extrude(height = 4, center = true) { circle($fn = 6, r = 1); }");
  EXPECT_NEAR(volume(only_mesh(centered)), 4 * polygon_area(6, 1), 1e-9);
  expect_near({0, 0, centered.bounds.lo.z}, {0, 0, -2});
  const Shape pyramid = csg("linear_extrude(height = 3, scale = [0, 0]) { square(size = [2, 2], center = true); }");
  EXPECT_NEAR(volume(only_mesh(pyramid)), 4, 1e-12);
  EXPECT_EQ(pyramid.mesh()->vertices.size(), 5u);
  // Turning by −twist: the corner (1, 0) arrives at (0, −1).
  const Shape turned =
      csg("linear_extrude(height = 1, twist = 90, slices = 200) { polygon(points = [[0,0],[1,0],[0,0.1]]); }");
  EXPECT_NEAR(turned.bounds.lo.y, -1, 1e-12);
  EXPECT_NEAR(volume(only_mesh(turned)), 0.05, 0.002);
}

TEST_F(Csg, PolygonsWithHoles) {
  const std::string points = "points = [[0,0],[4,0],[4,4],[0,4],[1,1],[3,1],[3,3],[1,3]]";
  for (const char* paths : {"[[0,1,2,3],[4,5,6,7]]", "[[3,2,1,0],[4,5,6,7]]", "[[4,7,6,5],[0,1,2,3]]"}) {
    const Shape shape = csg("linear_extrude(height = 2) { polygon(" + points + ", paths = " + paths + "); }");
    EXPECT_NEAR(volume(only_mesh(shape)), 24, 1e-12) << paths;
    // Caps are triangulated, not signed: the area is that of the frame.
    double area = 0;
    for (const Triangle& t : shape.mesh()->triangles) {
      const auto& v = shape.mesh()->vertices;
      area += norm(cross(v[t[1]] - v[t[0]], v[t[2]] - v[t[0]])) / 2;
    }
    EXPECT_NEAR(area, 2 * 12 + 16 * 2 + 8 * 2, 1e-9);
  }
  EXPECT_NEAR(volume(only_mesh(csg("linear_extrude(height = 1) { polygon(" + points + ", paths = [0,1,2,3]); }"))), 16,
              1e-12);
}

TEST_F(Csg, PolygonsThatCross) {
  const auto volume_of = [&](const std::string& polygon) {
    const Shape shape = csg("linear_extrude(height = 1) { polygon(" + polygon + "); }");
    EXPECT_NE(shape.mesh(), nullptr) << polygon;
    if (shape.mesh() == nullptr) return 0.0;
    expect_closed(*shape.mesh(), false);
    return volume(*shape.mesh());
  };
  // Of OpenSCAD's meshes, which have what an odd number of lobes covers.
  EXPECT_NEAR(volume_of("points = [[0,0],[20,12],[20,0],[0,12]]"), 120, 1e-9) << "a bow tie";
  EXPECT_NEAR(volume_of("points = [[0,0],[30,20],[30,0],[0,12]]"), 255, 1e-9) << "an uneven one";
  EXPECT_NEAR(
      volume_of("points = [[15,0],[-12.1353,8.81678],[4.63525,-14.2658],[4.63525,14.2658],[-12.1353,-8.81678]]"),
      872.64 / 5, 1e-2)
      << "a pentagram has a hole";
  const std::string squares = "points = [[0,0],[20,0],[20,20],[0,20],[10,10],[30,10],[30,30],[10,30]], paths = ";
  EXPECT_NEAR(volume_of(squares + "[[0,1,2,3],[4,5,6,7]]"), 600, 1e-9) << "without what both cover";
  EXPECT_NEAR(volume_of(squares + "[[0,1,2,3],[7,6,5,4]]"), 600, 1e-9);
  EXPECT_NEAR(volume_of("points = [[0,0],[20,0],[20,20],[0,20],[0,5],[10,5],[10,15],[0,15]], paths = [[0,1,2,3],"
                        "[4,5,6,7]]"),
              300, 1e-9)
      << "a hole that shares an edge";
  EXPECT_NEAR(volume_of("points = [[0,0],[10,0],[10,5],[20,5],[10,5],[10,10],[0,10]]"), 100, 1e-9) << "a spur";
  EXPECT_NEAR(volume_of("points = [[0,0],[10,0],[10,10],[20,10],[20,20],[10,20],[10,10],[0,10]]"), 200, 1e-9);
  const std::string twice = "[[0,0],[10,0],[10,10],[0,10],[0,0],[10,0],[10,10],[0,10]]";
  expect_says(refusal("linear_extrude(height = 1) { polygon(points = " + twice + "); }", "a.csg"), "holds no solid");
}

TEST_F(Csg, ScribblesAreClosed) {
  std::uint32_t state = 1;
  const auto random = [&] { return (state = state * 1664525u + 1013904223u) >> 20; };
  for (const int step : {1, 97}) {  // any crossings, and many in the same point
    std::string points;
    for (int i = 0; i < 60; ++i) {
      const unsigned x = random() / static_cast<unsigned>(step), y = random() / static_cast<unsigned>(step);
      points += (i ? ",[" : "[") + std::to_string(x) + "," + std::to_string(y) + "]";
    }
    const Shape shape = csg("linear_extrude(height = 1) { polygon(points = [" + points + "]); }");
    ASSERT_NE(shape.mesh(), nullptr);
    expect_closed(*shape.mesh(), false);
    EXPECT_GT(volume(*shape.mesh()), 0);
  }
}

TEST_F(Csg, SlicesFollowOpenScad) {
  const auto extruded = [&](const std::string& how, const std::string& what) {
    const Shape shape = csg("linear_extrude(" + how + ") { " + what + " }");
    return std::pair(shape.mesh()->vertices.size() / 4 - 1, volume(*shape.mesh()));
  };
  const std::string block = "square(size = [8, 5], center = true);", fine = "$fn = 0, $fa = 3, $fs = 0.7";
  EXPECT_EQ(extruded("height = 10, twist = -150", block).first, 8u);
  EXPECT_EQ(extruded("height = 10, twist = -150, scale = [0.5, 0.5]", block).first, 7u) << "a shorter way";
  EXPECT_EQ(extruded("height = 6, twist = 45, scale = [0.5, 1.5]", block).first, 4u);
  EXPECT_EQ(extruded("height = 1, twist = 90", block).first, 4u);
  EXPECT_EQ(extruded("height = 20, twist = 120, " + fine, block).first, 32u);
  EXPECT_EQ(extruded("height = 40, twist = 120, " + fine, block).first, 40u) << "limited by the angle";
  EXPECT_EQ(extruded("height = 10, twist = 360, $fn = 60", block).first, 60u);
  EXPECT_EQ(extruded("height = 10, scale = [2, 2]", block).first, 1u);
  // The volumes tell which diagonals the walls have.
  EXPECT_NEAR(extruded("height = 15, twist = 200, slices = 4", "square(size = [8, 6], center = true);").second,
              825.7804, 1e-3);
  const std::string beside = "polygon(points = [[0,-2],[4,-2],[4,2],[0,2]]);";
  EXPECT_NEAR(extruded("height = 10, twist = -150, scale = [0.5, 0.5]", beside).second, 102.5220, 1e-3) << "equal ones";
}

TEST_F(Csg, RotateExtrusion) {
  const std::string square = "{ multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { square(size = [1, 1]); } }";
  const Shape ring = csg("rotate_extrude(angle = 360, $fn = 100) " + square);
  EXPECT_NEAR(volume(only_mesh(ring)), polygon_area(100, 3) - polygon_area(100, 2), 1e-9);
  const Shape quarter = csg("rotate_extrude(angle = 90, $fn = 100) " + square);
  EXPECT_NEAR(volume(only_mesh(quarter)), (polygon_area(100, 3) - polygon_area(100, 2)) / 4, 1e-9);
  expect_box(quarter.bounds, {0, 0, 0}, {3, 3, 1}, 1e-12);
  expect_says(refusal("rotate_extrude() { square(size = 1, center = true); }", "scene.csg"), "both sides of the axis");
  expect_says(refusal("rotate_extrude(angle = 0) " + square, "scene.csg"), "holds no solid");
}

TEST_F(Csg, FlatSetsAreCombinedBeforeTheyAreExtruded) {
  const Shape shape =
      csg("linear_extrude(height = 1) { difference() { square(size = 4); multmatrix([[1,0,0,1],[0,1,0,1],[0,0,1,9],"
          "[0,0,0,1]]) { circle($fn = 20, r = 1); } } }");
  const double circle = polygon_area(20, 1);
  ASSERT_NE(shape.mesh(), nullptr);
  expect_closed(*shape.mesh(), false);  // the disc touches the sides of the square
  EXPECT_NEAR(volume(*shape.mesh()), 16 - circle, 1e-9);
  const auto volume_of = [&](const std::string& flat) {
    const Shape made = csg("linear_extrude(height = 1) { " + flat + " }");
    if (made.mesh() == nullptr) throw std::runtime_error("no mesh");
    expect_closed(*made.mesh(), false);
    return volume(*made.mesh());
  };
  const std::string square = "square(size = 4);", disc = "circle($fn = 20, r = 1);";
  EXPECT_NEAR(volume_of(square + disc), 16 + 0.75 * circle, 1e-9) << "around a corner of the square";
  EXPECT_NEAR(volume_of("intersection() { " + square + disc + " }"), 0.25 * circle, 1e-9);
  EXPECT_NEAR(volume_of("difference() { " + square + disc + disc + " }"), 16 - 0.25 * circle, 1e-9);
  EXPECT_NEAR(volume_of("union() { " + square + square + " }"), 16, 1e-9);
  EXPECT_NEAR(volume_of(square + "multmatrix([[1,0,0,4],[0,1,0,1],[0,0,1,0],[0,0,0,1]]) { square(size = 2); }"), 20,
              1e-9)
      << "side by side";
  EXPECT_NEAR(
      volume_of("multmatrix([[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { difference() { " + square + disc + " } }"),
      16 - 0.25 * circle, 1e-9);
  expect_says(refusal("linear_extrude(height = 1) { difference() { " + square + square + " } }", "a.csg"), "no solid");
  // Holes turn the diagonals of their walls: the volume is that of OpenSCAD's mesh.
  const Shape twisted = csg(
      "linear_extrude(height = 10, twist = 100, slices = 5) { multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {"
      "difference() { square(size = 4, center = true); square(size = 2, center = true); } } }");
  EXPECT_NEAR(volume(only_mesh(twisted)), 133.5487, 1e-3);
}

TEST_F(Csg, MatricesMoveFromTheInsideOut) {
  const Shape shape = csg(
      "multmatrix([[0,-1,0,0],[1,0,0,0],[0,0,1,0],[0,0,0,1]]) { multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) "
      "{ cube(size = [1,2,3]); } }");
  expect_box(shape.bounds, {-2, 5, 0}, {0, 6, 3});
  const Shape mirrored = csg("multmatrix([[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(size = 1); }");
  EXPECT_NEAR(volume(only_mesh(mirrored)), 1, 1e-12);
}

TEST_F(Csg, SetsAndGroups) {
  const Shape shape =
      csg("difference() { group() { cube(size = 2); } group(); color([1, 0, 0, 1]) { sphere(r = 1); }\n"
          "render(convexity = 1) { cube(size = 1); } }");
  ASSERT_NE(shape.compound(), nullptr);
  EXPECT_EQ(shape.compound()->kind, Compound::Kind::subtract);
  EXPECT_EQ(shape.compound()->operands.size(), 3u) << "empty groups vanish";
  const Shape nested = csg("union() { union() { cube(); sphere(); } group() { cylinder(); } }");
  EXPECT_EQ(nested.compound()->operands.size(), 3u) << "a union of unions is one";
  EXPECT_EQ(csg("cube(); sphere();").compound()->kind, Compound::Kind::unite);
}

TEST_F(Csg, NothingIsASetToo) {
  const std::string far = "multmatrix([[1,0,0,9],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(); }";
  EXPECT_NE(csg("union() { cube(); intersection() { cube(); " + far + " } }").mesh(), nullptr);
  EXPECT_NE(csg("union() { cube(); difference() { group(); sphere(); } }").mesh(), nullptr);
  EXPECT_NE(csg("union() { cube(); intersection() { cube(); group(); } }").mesh(), nullptr);
  EXPECT_NE(csg("difference() { cube(); " + far + " }").mesh(), nullptr);
  EXPECT_NE(csg("cube(); cube(size = 0); sphere(r = 0); cylinder(h = -1);").mesh(), nullptr);
  expect_says(refusal("group();", "a.csg"), "a.csg: holds no solid");
  expect_says(refusal("intersection() { cube(); " + far + " }", "a.csg"), "a.csg: holds no solid");
}

TEST_F(Csg, ModifiersLeaveOutOrChoose) {
  EXPECT_NE(csg("cube(); %sphere(); *sphere(); % group() { sphere(); }").mesh(), nullptr);
  EXPECT_NE(csg("difference() { %sphere(); cube(); }").mesh(), nullptr);
  EXPECT_NE(csg("#cube();").mesh(), nullptr);
  const Shape chosen = csg("sphere(); multmatrix([[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]) { !cube(); }");
  expect_box(chosen.bounds, {0, 0, 0}, {1, 1, 1});
}

TEST_F(Csg, Hulls) {
  EXPECT_NEAR(volume(only_mesh(csg("hull() { cube(size = 1); multmatrix([[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], "
                                   "[0, 0, 0, 1]]) { cube(size = 1); } }"))),
              3, 1e-12);
  // A cube and a point beyond its top, as a cone of no size; a hull within a hull.
  EXPECT_NEAR(
      volume(only_mesh(csg("hull() { hull() { cube(size = 2, center = true); } union() { multmatrix([[1, 0, 0, 0], "
                           "[0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]]) { cylinder($fn = 4, h = 3, r1 = 0.5, r2 = "
                           "0); } } }"))),
      8 + 4, 1e-9);
  EXPECT_NEAR(
      volume(only_mesh(csg("linear_extrude(height = 2) { hull() { square(size = 1); multmatrix([[1, 0, 0, 3], [0, "
                           "1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { square(size = 1); } } }"))),
      8, 1e-12);
  says("hull() { difference() { cube(); sphere(r = 0.1); } }",
       "a hull of differences and intersections is not supported");
}

TEST_F(Csg, OffsetsOfFlatShapes) {
  const auto area = [&](const std::string& what) {
    return volume(only_mesh(csg("linear_extrude(height = 1) { " + what + " }")));
  };
  const double pi = std::numbers::pi, corner = 1.5 - std::sqrt(2);  // cut off a unit square, half of it
  const std::string square = "{ square(size = 2, center = true); }";
  EXPECT_NEAR(area("offset(r = 1, $fn = 400) " + square), 12 + pi, 1e-3);
  EXPECT_NEAR(area("offset(delta = 1, chamfer = false) " + square), 16, 1e-9);
  EXPECT_NEAR(area("offset(delta = 1, chamfer = true) " + square), 16 - 8 * corner, 1e-9);
  EXPECT_NEAR(area("offset(delta = -0.25) " + square), 1.5 * 1.5, 1e-9);
  EXPECT_NEAR(area("offset(r = -0.25, $fn = 8) " + square), 1.5 * 1.5, 1e-9);
  const std::string bend = "{ polygon(points = [[4, 0], [4, 1], [1, 1], [1, 4], [0, 4], [0, 0]]); }";
  EXPECT_NEAR(area("offset(delta = -0.25) " + bend), 3.25, 1e-9);
  EXPECT_NEAR(area("offset(r = -0.25, $fn = 400) " + bend), 3.25 + (1 - pi / 4) / 16, 1e-4);
  const std::string frame = "{ difference() { square(size = 4, center = true); square(size = 2, center = true); } }";
  EXPECT_NEAR(area("offset(delta = 0.5) " + frame), 24, 1e-9);
  EXPECT_NEAR(area("offset(delta = 1) " + frame), 36, 1e-9) << "the hole is gone";
  EXPECT_EQ(area("multmatrix([[-2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { offset(delta = 0.5) " +
                 square + " }"),
            18);
  says("linear_extrude(height = 1) { offset(delta = -1) " + square + " }", "holds no solid");
}

TEST_F(Csg, DrawingsAreNamed) {
  says("linear_extrude(height = 1) { import(file = \"a.dxf\", layer = \"\"); }", "'a.dxf' is a drawing (DXF)");
  says("import(file = \"a.SVG\");", "'a.SVG' is a drawing (SVG)");
  says("linear_extrude(height = 1) { text(text = \"a\"); }", "the OpenSCAD node 'text' is not supported");
}

TEST_F(Csg, ImportsAreRelativeToTheScene) {
  const Shape shape =
      csg("import(file = \"tetra.off\", layer = \"\", origin = [0, 0], scale = 1, convexity = 1, timestamp = 1);");
  EXPECT_NEAR(volume(only_mesh(shape)), 1.0 / 6, 1e-12);
  expect_says(refusal("\n import(file = \"none.stl\");", "a.csg"), "a.csg: line 2, column 2: import: there is no file");
}

TEST_F(Csg, ErrorsNameLineAndColumn) {
  says("group() {\n  minkowski() { cube(); }\n}",
       "a.csg: line 2, column 3: the OpenSCAD node 'minkowski' is not supported");
  for (const char* name : {"minkowski", "projection", "text", "surface", "resize"}) {
    says(std::string(name) + "();", "line 1, column 1: the OpenSCAD node '" + std::string(name) + "' is not supported");
  }
  says("cubes();", "a.csg: line 1, column 1: the unknown node 'cubes' is not supported");
  says("cube(size = [1, 2]);", "line 1, column 13: needs a list of 3 numbers");
  says("cube(size = [1, 2, nan]);", "line 1, column 20: needs a finite number");
  says("sphere(r = \"big\");", "line 1, column 12: needs a finite number");
  says("cube(size = x);", "line 1, column 13: expected a value; a .csg file has no variables");
  says("cube(size = 1", "expected ',' or ')' in the arguments, found the end of the file");
  says("cube(size = 1)", "expected ';' or '{' behind the arguments, found the end of the file");
  says("group() { cube();", "line 1, column 1: the braces of this statement are never closed");
  says("cube(); }", "line 1, column 9: '}' closes nothing");
  says("cube; ", "expected '(' behind the name");
  says("$x = 3;", "line 1, column 1: a .csg file has no variables; make one with openscad");
  says("linear_extrude(height = 3) square(2);", "as openscad -o x.csg x.scad writes them, found 'square'");
  says("cube(\"", "never closed by a quote");
  says("/* cube();", "comment is never closed");
  says("square();", "line 1, column 1: 'square' is flat where a solid is needed");
  says("linear_extrude(height = 1) { cube(); }", "'cube' is a solid where a flat shape is needed");
  says("multmatrix([[1,0,0,0],[0,0,0,0],[0,0,1,0],[0,0,0,1]]) { cube(); }", "line 1, column 1: multmatrix: ");
  says("multmatrix() { cube(); }", "needs a matrix of four rows");
  says("polyhedron(points = [[0,0,0]], faces = [[0,1,2]]);", "is no index of a point; there are 1, counted from 0");
  says("sphere($fn = 1e9);", "asks for more than 1,000,000 pieces");
  says("sphere($fn = 1e6);", "asks for more triangles than a scene may have");
}

TEST_F(Csg, IsRecognizedByContent) {
  for (const char* text : {"cube();", "// a\n/* b */ % group (){}", "\xef\xbb\xbf!multmatrix([[", "difference() { }"}) {
    EXPECT_TRUE(is_scene("-", text)) << text;
    EXPECT_TRUE(is_scene("a.txt", text)) << text;
  }
  for (const char* text : {"cube", "cubes();", "g cube\nv 0 0 0\n", "1 2 3\n", "# cube\n1 2 3\n", "/* cube();", ""}) {
    EXPECT_FALSE(is_scene("-", text)) << text;
  }
  EXPECT_NE(parse_scene("cube();", "standard input", folder).mesh(), nullptr);
  EXPECT_TRUE(is_scene("a.scad", "x = 3;"));
  expect_says(refusal("cube();", "a.scad"),
              "a.scad: is a program of OpenSCAD, which has to be evaluated first: openscad");
}

TEST_F(Csg, DepthIsLimited) {
  const auto nested = [](std::size_t depth) {
    std::string text;
    for (std::size_t i = 0; i + 1 < depth; ++i) text += "group(){";
    text += "cube();";
    return text + std::string(depth - 1, '}');
  };
  EXPECT_NE(csg(nested(500)).mesh(), nullptr);
  expect_says(refusal(nested(501), "a.csg"), "is nested too deeply; 500 nodes");
  expect_says(refusal(nested(100'000), "a.csg"), "is nested too deeply");
  expect_says(refusal("cube(size = " + std::string(100'000, '['), "a.csg"), "lists are nested too deeply");
}

}  // namespace
}  // namespace evenmesh::testing_scene
