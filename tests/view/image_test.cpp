#include <gtest/gtest.h>
#include <png.h>

#include <set>

#include "evenmesh/render.h"
#include "geometry/primitives.h"
#include "view/base64.h"

namespace evenmesh {
namespace {

/// Decodes by libpng's simplified interface, which is not what encode_png() uses.
Image decode(const std::string& png) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&header, png.data(), png.size()));
  header.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(header));
  EXPECT_TRUE(png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr));
  return image;
}

std::set<std::array<std::uint8_t, 3>> colours_of(const Image& image) {
  std::set<std::array<std::uint8_t, 3>> colours;
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    colours.insert({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
  return colours;
}

const RenderOptions small{.width = 160, .height = 120, .antialias = 2};

/// Pixels that differ clearly between two pictures of one size.
std::size_t differing(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3)
    count += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 2] - b.rgb[i + 2]) > 24;
  return count;
}

TEST(Image, PngDecodesToTheSamePixels) {
  const Image image = render_mesh(make_torus(), small);
  const Image decoded = decode(encode_png(image));
  EXPECT_EQ(decoded.width, image.width);
  EXPECT_EQ(decoded.height, image.height);
  EXPECT_EQ(decoded.rgb, image.rgb);
}

TEST(Image, BesideKeepsEveryPicture) {
  const Image left{2, 2, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}}, right{1, 1, {9, 9, 9}};
  const Image both = beside({left, right});
  EXPECT_EQ(both.width, 3);
  EXPECT_EQ(both.height, 2);
  EXPECT_EQ(both.rgb, (std::vector<std::uint8_t>{1, 1, 1, 2, 2, 2, 9, 9, 9, 3, 3, 3, 4, 4, 4, 255, 255, 255}));
  EXPECT_THROW(beside({}), InvalidInput);
  EXPECT_THROW(encode_png(Image{2, 2, {0}}), InvalidInput);
}

TEST(Render, FillsThePictureWithTheMeshAndLeavesAMargin) {
  for (const char up : {'y', 'z'})
    for (const double elevation : {-90.0, 0.0, 35.0, 90.0}) {
      RenderOptions options = small;
      options.up = up, options.elevation = elevation, options.wireframe = false;
      const Image image = render_mesh(translated(make_icosphere(3), {100, 50, -30}), options);
      ASSERT_EQ(image.rgb.size(), 3u * 160 * 120);
      const auto at = [&](int x, int y) { return image.rgb[3 * static_cast<std::size_t>(160 * y + x)]; };
      // The sphere is as high as the picture but for the margin; corners show the background.
      const int background = at(1, 60);
      EXPECT_NEAR(background, at(158, 60), 2);
      EXPECT_GT(std::abs(at(80, 100) - background), 10);
      EXPECT_NEAR(at(80, 1), at(1, 1), 2);
      EXPECT_GT(colours_of(image).size(), 50u);
    }
}

TEST(Render, DrawsWiresMarksAndQuality) {
  RenderOptions plain = small, wires = small, quality = small;
  plain.wireframe = false, quality.wireframe = false, quality.quality_colours = true;
  const Mesh mesh = make_icosphere(1);
  const Image without = render_mesh(mesh, plain);
  EXPECT_GT(differing(without, render_mesh(mesh, wires)), 100u);
  EXPECT_GT(differing(without, render_mesh(mesh, quality)), 1000u);
  // Its twelve vertices of valence 5 are marked in blue.
  std::size_t blue = 0;
  for (std::size_t i = 0; i < without.rgb.size(); i += 3) blue += without.rgb[i + 2] > without.rgb[i] + 60;
  EXPECT_GT(blue, 3u);
}

TEST(Render, IsTheSameForAnyNumberOfThreads) {
  evenmesh::ExecutionContext one(1), three(3);
  EXPECT_EQ(render_mesh(make_torus(), small, one).rgb, render_mesh(make_torus(), small, three).rgb);
}

TEST(Render, SurvivesFlatAndDegenerateMeshes) {
  Mesh point;
  point.vertices.resize(3);
  point.triangles = {{0, 1, 2}};
  EXPECT_EQ(render_mesh(point, small).width, 160);
  RenderOptions edge_on = small;
  edge_on.elevation = 0;
  EXPECT_EQ(render_mesh(make_grid_plane(3, 3), edge_on).width, 160);
  edge_on.up = 'z';
  EXPECT_EQ(render_mesh(make_grid_plane(3, 3), edge_on).width, 160);
  EXPECT_GT(colours_of(render_mesh(make_icosphere(1, 1e-30), small)).size(), 50u);
}

TEST(Render, RefusesNonsense) {
  EXPECT_THROW(render_mesh(Mesh{}, small), InvalidInput);
  EXPECT_THROW(render_mesh(make_box(), {.width = 15}), InvalidInput);
  EXPECT_THROW(render_mesh(make_box(), {.height = 9000}), InvalidInput);
  EXPECT_THROW(render_mesh(make_box(), {.up = 'x'}), InvalidInput);
  EXPECT_THROW(render_mesh(make_box(), {.antialias = 0}), InvalidInput);
}

TEST(Base64, FollowsTheStandard) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64("\xff\xff\xff"), "////");
}

}  // namespace
}  // namespace evenmesh
