/// Scenes as JSON: the shapes they stand for, and where they say that something is wrong.

#include <cmath>

#include "scene_testing.h"

namespace evenmesh::testing_scene {
namespace {

using Json = SceneTest;

constexpr const char* ball = R"({"implicit": "x^2+y^2+z^2-1", "bounds": [-1.5,-1.5,-1.5, 1.5,1.5,1.5]})";

TEST_F(Json, SetsBecomeCompounds) {
  const std::string b = ball;
  const Shape both = json(R"({"union": [)" + b + "," + b + "]}");
  ASSERT_NE(both.compound(), nullptr);
  EXPECT_EQ(both.compound()->kind, Compound::Kind::unite);
  EXPECT_EQ(both.compound()->operands.size(), 2u);
  EXPECT_EQ(json(R"({"intersection": [)" + b + "," + b + "]}").compound()->kind, Compound::Kind::intersect);
  const Shape rest = json(R"({"difference": [)" + b + R"(, {"gallery": "sphere"}, {"mesh": "tetra.off"}]})");
  ASSERT_EQ(rest.compound()->kind, Compound::Kind::subtract);
  EXPECT_EQ(rest.compound()->operands.size(), 3u);
  EXPECT_NE(rest.compound()->operands[0].field(), nullptr);
  EXPECT_NE(rest.compound()->operands[2].mesh(), nullptr);
}

TEST_F(Json, NameUnitsAndSchemaAtTheTop) {
  const std::string rest = R"(, "units": "mm", "$schema": "scene.schema.json", "mesh": "tetra.off"})";
  EXPECT_EQ(json(R"({"name": "part")" + rest).name, "part");
  EXPECT_EQ(json(R"({"mesh": "tetra.off"})").name, "scene.json");
  expect_says(refusal(R"({"units": "miles", "mesh": "tetra.off"})"),
              "scene.json: units: is none of micron, mm, cm, m, in, ft");
  expect_says(refusal(R"({"union": [{"mesh": "tetra.off", "units": "mm"}]})"),
              "scene.json: union[0]: has 'units', which is for the top");
}

TEST_F(Json, TransformsScaleThenRotateThenTranslate) {
  const Shape shape = json(R"({"transform": {"translate": [10,0,0], "rotate": {"axis": [0,0,1], "degrees": 90},
                               "scale": [2,1,1]}, "of": {"mesh": "tetra.off"}})");
  ASSERT_NE(shape.mesh(), nullptr);
  // (1,0,0) → (2,0,0) → (0,2,0) → (10,2,0); (0,1,0) → (−1,0,0) → (9,0,0)
  expect_near(shape.mesh()->vertices[1], {10, 2, 0});
  expect_near(shape.mesh()->vertices[2], {9, 0, 0});
  EXPECT_NEAR(volume(*shape.mesh()), 2.0 / 6, 1e-12);
}

TEST_F(Json, NestedTransformsWorkFromTheInsideOut) {
  const Shape shape = json(R"({"transform": {"scale": 2}, "of": {"union": [
      {"transform": {"translate": [1,0,0]}, "of": {"mesh": "tetra.off"}}, {"mesh": "tetra.off"}]}})");
  ASSERT_NE(shape.compound(), nullptr);
  expect_near(shape.compound()->operands[0].mesh()->vertices[0], {2, 0, 0});
  expect_near(shape.compound()->operands[1].mesh()->vertices[1], {2, 0, 0});
  expect_box(shape.bounds, {0, 0, 0}, {4, 2, 2});
}

TEST_F(Json, MatricesAreReadRowByRow) {
  for (const char* matrix : {"[1,0,0,5, 0,0,-1,6, 0,1,0,7, 0,0,0,1]", "[[1,0,0,5],[0,0,-1,6],[0,1,0,7],[0,0,0,1]]"}) {
    const Shape shape =
        json(std::string(R"({"transform": {"matrix": )") + matrix + R"(}, "of": {"mesh": "tetra.off"}})");
    expect_near(shape.mesh()->vertices[2], {5, 6, 8});
    expect_near(shape.mesh()->vertices[3], {5, 5, 7});
  }
}

TEST_F(Json, MirroringKeepsTheOutside) {
  const Shape shape = json(R"({"transform": {"scale": [-1,1,1]}, "of": {"mesh": "tetra.off"}})");
  EXPECT_NEAR(volume(*shape.mesh()), 1.0 / 6, 1e-12);
  expect_closed(*shape.mesh());
}

TEST_F(Json, OffsetsAreMeasuredWhereTheyStand) {
  const Shape shape = json(R"({"offset": 0.5, "of": {"mesh": "tetra.off"}})");
  ASSERT_NE(shape.compound(), nullptr);
  EXPECT_EQ(shape.compound()->kind, Compound::Kind::offset);
  EXPECT_EQ(shape.compound()->distance, 0.5);
  expect_box(shape.bounds, {-0.5, -0.5, -0.5}, {1.5, 1.5, 1.5});
  const Shape larger = json(R"({"transform": {"scale": 3}, "of": {"offset": 0.5, "of": {"mesh": "tetra.off"}}})");
  EXPECT_NEAR(larger.compound()->distance, 1.5, 1e-12);
  const Shape closed = json(R"({"closing": 0.5, "of": {"mesh": "tetra.off"}})");
  EXPECT_EQ(closed.compound()->distance, -0.5);
  EXPECT_EQ(closed.compound()->operands[0].compound()->distance, 0.5);
  EXPECT_EQ(json(R"({"opening": 0.5, "of": {"mesh": "tetra.off"}})").compound()->distance, 0.5);
  expect_says(refusal(R"({"transform": {"scale": [1,2,1]}, "of": {"offset": 0.5, "of": {"mesh": "tetra.off"}}})"),
              "scene.json: of.offset: ");
}

TEST_F(Json, ImplicitTakesBoundsAndParameters) {
  const Shape shape = json(R"({"implicit": "x^2+y^2+z^2-R^2", "parameters": {"R": 2}, "bounds": [-3,-3,-3,3,3,3]})");
  ASSERT_NE(shape.field(), nullptr);
  expect_box(shape.bounds, {-3, -3, -3}, {3, 3, 3});
  EXPECT_TRUE(json(R"({"implicit": "x^2+y^2+z^2-1"})").bounds.empty()) << "to be found";
  expect_says(refusal(R"({"implicit": "x^2+("})"), "scene.json: implicit: column ");
  expect_says(refusal(R"({"implicit": "x", "bounds": [0,0,0,1,0,1]})"), "scene.json: bounds: needs x0 < x1");
  expect_says(refusal(R"({"implicit": "x", "parameters": {"a": "b"}})"), "scene.json: parameters.a: needs a number");
}

TEST_F(Json, PointsHaveNoInside) {
  EXPECT_NE(json(R"({"points": "points.xyz"})").points(), nullptr);
  const Shape moved = json(R"({"transform": {"translate": [0,0,1]}, "of": {"points": "points.xyz"}})");
  expect_box(moved.bounds, {0, 0, 1}, {1, 1, 2});
  expect_says(refusal(R"({"union": [{"gallery": "sphere"}, {"points": "points.xyz"}]})"),
              "scene.json: union[1]: is a point cloud, which has no inside");
  expect_says(refusal(R"({"offset": 1, "of": {"points": "points.xyz"}})"), "scene.json: offset: ");
}

TEST_F(Json, FilesUsedTwiceAreOne) {
  const Shape shape = json(R"({"union": [{"mesh": "tetra.off"}, {"mesh": "./tetra.off"}]})");
  EXPECT_EQ(shape.compound()->operands[0].mesh(), shape.compound()->operands[1].mesh());
}

TEST_F(Json, ErrorsNameThePath) {
  const auto says = [&](const std::string& text, const std::string& words) { expect_says(refusal(text), words); };
  says(R"({"union": [{"mesh": "tetra.off"}, {"transform": {"rotate": {"axis": [0,0,0], "degrees": 1}},
          "of": {"mesh": "tetra.off"}}]})",
       "scene.json: union[1].transform.rotate.axis: needs three numbers, not all zero");
  says(R"({"transform": {"rotate": {"axis": [0,0,1]}}, "of": {"mesh": "tetra.off"}})",
       "scene.json: transform.rotate: needs 'axis' and 'degrees'");
  says(R"({"transform": {"scale": 0}, "of": {"mesh": "tetra.off"}})", "scene.json: transform.scale: must not be 0");
  says(R"({"transform": {"matrix": [1,2,3]}, "of": {"mesh": "tetra.off"}})", "transform.matrix: needs 16 numbers");
  says(R"({"transform": {"matrix": [1,0,0,0,1,0,0,0,0,0,1,0,0,0,0,1]}, "of": {"mesh": "tetra.off"}})",
       "scene.json: transform: has no inverse");
  says(R"({"transform": {"matrix": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,1,1]}, "of": {"mesh": "tetra.off"}})",
       "transform.matrix: needs 0, 0, 0, 1 in its last row");
  says(R"({"transform": {"turn": 1}, "of": {"mesh": "tetra.off"}})", "transform: has the unknown key 'turn'");
  says(R"({"transform": {}, "of": {"mesh": "tetra.off"}})", "scene.json: transform: needs 'scale'");
  says(R"({"transform": {"scale": 2}})", "scene.json: needs 'of', the node that 'transform' is done to");
  says(R"({"offset": "far", "of": {"mesh": "tetra.off"}})", "scene.json: offset: needs a number");
  says(R"({"closing": -1, "of": {"mesh": "tetra.off"}})", "scene.json: closing: the radius of a closing");
  says(R"({"union": []})", "scene.json: union: needs an array of at least one node");
  says(R"({"union": {"mesh": "tetra.off"}})", "scene.json: union: needs an array");
  says(R"({"union": [3]})", "scene.json: union[0]: needs an object with one of the keys union, intersection");
  says(R"({"sum": []})", "scene.json: needs one of the keys union, intersection");
  says("[]", "scene.json: needs an object with one of the keys");
  says(R"({"mesh": "tetra.off", "gallery": "sphere"})",
       "scene.json: has both 'mesh' and 'gallery'; put them into two nodes");
  says(R"({"transform": {"scale": 2}, "gallery": "sphere"})", "put 'gallery' into a node under 'of'");
  says(R"({"gallery": "sphere", "offset": 1})", "put 'gallery' into a node under 'of'");
  says(R"({"unoin": []})", "scene.json: has the unknown key 'unoin'; did you mean union?");
  says(R"({"name": "a", "Union": []})", "scene.json: has the unknown key 'Union'; did you mean union?");
  says(R"({"implicit": "x", "parameter": {}})", "'parameter' beside 'implicit'; did you mean parameters?");
  says(R"({"mesh": "tetra.off", "scale": 2})", "put the node under 'of' beside a 'transform' with 'scale'");
  write_file(folder / "other.json", "{}");
  says(R"({"mesh": "other.json"})", "scene.json: mesh: other.json: is a scene, not a mesh");
  says(R"({"mesh": "tetra.off", "colour": "red"})", "scene.json: has the unknown key 'colour' beside 'mesh'");
  says(R"({"mesh": "none.stl"})", "scene.json: mesh: there is no file '");
  says(R"({"mesh": ""})", "scene.json: mesh: needs a text in quotes");
  says(R"({"mesh": "."})", "is not a regular file");
  says(R"({"mesh": "points.xyz"})", "holds points, not a mesh; name it under 'points'");
  says(R"({"points": "tetra.off"})", "scene.json: points: ");
  says(R"({"gallery": "spere"})", "sphere");
  says(
      R"({"intersection": [{"mesh": "tetra.off"}, {"transform": {"translate": [9,9,9]}, "of": {"mesh": "tetra.off"}}]})",
      "scene.json: intersection: the operands of an intersection lie apart");
}

TEST_F(Json, ErrorsOfTheTextNameLineAndColumn) {
  expect_says(refusal("{\n  \"union\": [,]\n}"), "scene.json: line 2, column 13: this is no JSON");
  expect_says(refusal("{\"union\": ["), "the JSON text ends too early");
  expect_says(refusal(""), "scene.json: is empty");
  expect_says(refusal(R"({"offset": 1e999, "of": {}})"), "beyond the range of double");
  expect_says(refusal(R"({"mesh": "a.off", "mesh": "b.off"})"), "has the key 'mesh' twice in one object");
}

TEST_F(Json, ShadersThatCannotBeReadAreNamedWithTheirPlace) {
  expect_says(refusal(R"({"union": [{"glsl": "a.frag"}]})"), "scene.json: union[0].glsl: there is no file");
  expect_says(refusal(R"({"glsl": "a.frag", "level": "low"})"), "scene.json: level: ");
  expect_says(refusal(R"({"glsl": "a.frag", "parameters": {"a": {}}})"), "scene.json: parameters.a: ");
}

TEST_F(Json, DrawnSolidsAreNamedWithTheirPlace) {
  expect_says(refusal(R"({"raster": "a.vert"})"), "scene.json: raster: needs two files");
  expect_says(refusal(R"({"raster": ["a.vert", "default"]})"), "needs either 'geometry'");
  expect_says(refusal(R"({"raster": ["a.vert", "default"], "vertices": 1.5})"), "vertices: needs a whole number");
  expect_says(refusal(R"({"union": [{"raster": ["a.vert", "default"], "vertices": 36}]})"),
              "scene.json: union[0].raster: there is no file");
  expect_says(refusal(R"({"raster": ["default", "default"], "geometry": "a.off"})"), "geometry: there is no file");
}

TEST_F(Json, DepthAndSizeAreLimited) {
  const auto nested = [](std::size_t depth) {
    std::string text;
    for (std::size_t i = 0; i + 1 < depth; ++i) text += R"({"union":[)";
    text += R"({"gallery":"sphere"})";
    for (std::size_t i = 0; i + 1 < depth; ++i) text += "]}";
    return text;
  };
  EXPECT_NE(json(nested(500)).field(), nullptr);
  expect_says(refusal(nested(501)), "is nested too deeply; a scene may have 500 nodes");
  expect_says(refusal(nested(100'000)), "is nested too deeply");
  expect_says(refusal(std::string(1'000'000, '[')), "is nested too deeply");
  EXPECT_THROW(parse_scene(R"({"gallery": "sphere"})", "a.json", folder, ExecutionContext::silent(), {.bytes = 10}),
               UnusableInput);
  const std::string move = R"({"transform": {"scale": 2}, "of": {"mesh": "tetra.off"}})";
  EXPECT_THROW(parse_scene(move, "a.json", folder, ExecutionContext::silent(), {.triangles = 3}), UnusableInput);
}

TEST_F(Json, FilesAreRelativeToTheScene) {
  fs::create_directory(folder / "scenes");
  write_file(folder / "scenes" / "a.json", R"({"mesh": "../tetra.off"})");
  EXPECT_NE(read_scene(folder / "scenes" / "a.json").mesh(), nullptr);
  EXPECT_THROW(read_scene(folder / "none.json"), UnusableInput);
  EXPECT_THROW(read_scene(folder), UnusableInput);
}

TEST(Recognition, ByContentThenByName) {
  EXPECT_TRUE(is_scene("a.json", R"({"mesh": "b.stl"})"));
  EXPECT_TRUE(is_scene("a.csg", "cube(size = 1);"));
  EXPECT_TRUE(is_scene("A.CSG", ""));
  EXPECT_TRUE(is_scene("a.txt", " \n{\"union\": []}"));
  EXPECT_FALSE(is_scene("a.json", R"({"asset": {"version": "2.0"}})")) << "that is glTF";
  EXPECT_FALSE(is_scene("a.json", "ply\n"));
  EXPECT_FALSE(is_scene("a.xyz", "0 0 0\n"));
  EXPECT_FALSE(is_scene("-", ""));
}

}  // namespace
}  // namespace evenmesh::testing_scene
