/// What is drawn becomes the same solid as what is scanned.

#include "evenmesh/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "evenmesh/solid.h"
#include "geometry/primitives.h"
#include "gl/raster_sampler.h"
#include "gl/shaders.h"
#include "sample/sample.h"

namespace evenmesh {
namespace {

using namespace testing;

const std::string plain_vertex =
    "in vec3 position;\nuniform mat4 viewProjection;\nvoid main() { gl_Position = viewProjection * vec4(position, 1); "
    "}\n";

Mesh turned_cube() {
  Mesh mesh = make_box_around({{-1, -0.8, -0.6}, {1, 0.8, 0.6}});
  const Affine turn = Affine::rotate({1, 2, 3}, 11);
  for (Vec3& v : mesh.vertices) v = turn(v);
  return mesh;
}

Mesh read_obj(const std::filesystem::path& path) {
  Mesh mesh;
  std::ifstream file(path);
  std::string line, word;
  while (std::getline(file, line)) {
    std::istringstream in(line);
    in >> word;
    if (word == "v") {
      Vec3 v;
      in >> v.x >> v.y >> v.z;
      mesh.vertices.push_back(v);
    } else if (word == "f") {
      Triangle t{};
      for (std::uint32_t& corner : t) in >> word, corner = static_cast<std::uint32_t>(std::stoul(word)) - 1;
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

/// Boxes that follow each other as vertices, 36 for each, made without buffers.
const std::string boxes_vertex = R"(
uniform mat4 viewProjection;
void main() {
  const int corner[36] = int[36](0,2,1, 1,2,3, 4,5,6, 5,7,6, 0,1,4, 1,5,4, 2,6,3, 3,6,7, 0,4,2, 2,4,6, 1,3,5, 3,7,5);
  int c = corner[gl_VertexID % 36];
  vec3 p = vec3(c & 1, c >> 1 & 1, c >> 2 & 1) - 0.5;
  gl_Position = viewProjection * vec4(p * (1.0 - 0.02 * float(gl_VertexID / 36)), 1.0);
}
)";

Vec3 normal_of(const Mesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t[0]];
  return normalized(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

TriDexel scanned(const Shape& shape, const Grid& grid, std::vector<PackedNormal>& normals) {
  const auto* sampler = dynamic_cast<const gl::RasterSampler*>(shape.ray_source());
  EXPECT_NE(sampler, nullptr);
  return sampler->scan(grid, shape.bounds, normals, ExecutionContext::silent());
}

struct Agreement {
  std::size_t rays = 0, other_counts = 0, crossings = 0;
  std::size_t apart = 0;    ///< crossings that differ by more than 1e-5 of the box
  double worst = 0;         ///< difference of depths as a share of the box, where the surface is not steep
  double worst_steep = 0;   ///< the same for the rest
  double worst_normal = 0;  ///< radians
};

/// Compares the crossings of all rays; those on which the counts differ are silhouettes, where coverage is rounded.
Agreement compare(const Mesh& mesh, std::size_t resolution) {
  const Shape shape = shape_from_raster({.geometry = mesh});
  const Grid grid = make_grid(shape.bounds, resolution);
  const double cell = grid.spacing / shape.bounds.longest_side();
  std::vector<PackedNormal> normals;
  const TriDexel drawn = scanned(shape, grid, normals), exact = scan_mesh(mesh, grid);
  EXPECT_EQ(drawn.disagreements, 0u);
  Agreement result;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::uint32_t q = 0; q < grid.size[std::size_t(dexel_q_axis[a])]; ++q)
      for (std::uint32_t p = 0; p < grid.size[std::size_t(dexel_p_axis[a])]; ++p) {
        const auto one = drawn.axes[a].ray(p, q), other = exact.axes[a].ray(p, q);
        if (one.empty() && other.empty()) continue;
        ++result.rays;
        if (one.size() != other.size()) ++result.other_counts;
        for (std::size_t i = 0; one.size() == other.size() && i < one.size(); ++i) {
          const Vec3 n = normal_of(mesh, other[i].source);
          const double share = cell * std::abs((one[i].cell + double(one[i].t)) - (other[i].cell + double(other[i].t)));
          const bool steep = std::abs(n[static_cast<int>(a)]) < 0.05;
          (steep ? result.worst_steep : result.worst) = std::max(steep ? result.worst_steep : result.worst, share);
          ++result.crossings;
          result.apart += !steep && share > 1e-5;
          if (steep || one[i].synthetic || share > 1e-5) continue;
          Vec3 m = unpack_normal(normals[one[i].source]);
          if (dot(m, n) < 0) m = -m;
          result.worst_normal = std::max(result.worst_normal, norm(cross(m, n)));
        }
      }
  std::printf(
      "%zu rays, %zu with other counts, %zu crossings, %zu apart, worst %.3g of the box, steep %.3g, normal %.3g rad\n",
      result.rays, result.other_counts, result.crossings, result.apart, result.worst, result.worst_steep,
      result.worst_normal);
  // Vertices are rounded to 1/256 of a cell: next to edges of the mesh a ray may meet the other triangle.
  EXPECT_LT(result.apart, result.crossings / 1000);
  EXPECT_LT(result.worst, cell);
  return result;
}

TEST(Raster, AgreesWithTheScanOfASphere) {
  const Agreement a = compare(make_icosphere(5), 300);
  EXPECT_LT(a.other_counts, a.rays / 1000);
}

TEST(Raster, AgreesWithTheScanOfATurnedCube) {
  const Agreement a = compare(turned_cube(), 300);
  EXPECT_LT(a.other_counts, a.rays / 1000);
}

TEST(Raster, AgreesAcrossTheBordersOfViews) {
  // Edges that run almost along the columns of pixels, cut where views meet.
  Mesh mesh = make_box_around({{-1, -0.8, -0.6}, {1, 0.8, 0.6}});
  const Affine turn = Affine::rotate({0, 0, 1}, 1e-5).after(Affine::rotate({1, 0, 0}, 11));
  for (Vec3& v : mesh.vertices) v = turn(v);
  const Agreement a = compare(mesh, 700);
  EXPECT_LT(a.other_counts, a.rays / 1000);
}

TEST(Raster, AgreesWithTheScanOfAModel) {
  const std::filesystem::path path = std::filesystem::path(EVENMESH_SOURCE_DIR) / ".." / "shared/data/armadillo.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const Agreement a = compare(read_obj(path), 400);
  EXPECT_LT(a.other_counts, a.rays / 200);
}

/// Samples, at a resolution.
SampleSet sampled(const Shape& shape, std::size_t resolution) {
  return sample_shape(shape, make_grid(shape.bounds, resolution), ExecutionContext::silent());
}

/// Largest |f| at the samples, of the solid f < 0; and of the angle between normals and the gradient.
struct Fit {
  double distance = 0, angle = 0;
};
template <typename F, typename G>
Fit fit(const SampleSet& set, const F& f, const G& gradient) {
  Fit worst;
  for (const SampleBlock& b : set.blocks)
    for (std::uint32_t s = b.begin; s < b.end; ++s) {
      const Vec3 p = set.block_center(b) + Vec3{set.x[s], set.y[s], set.z[s]};
      worst.distance = std::max(worst.distance, std::abs(f(p)));
      const Vec3 n = unpack_normal(set.normal[s]), g = normalized(gradient(p));
      worst.angle = std::max(worst.angle, std::atan2(norm(cross(n, g)), dot(n, g)));
    }
  return worst;
}
const auto from_unit_sphere = [](const Vec3& p) { return norm(p) - 1; };
const auto itself = [](const Vec3& p) { return p; };

/// A unit sphere hit by rays within the faces of a box around it.
const std::string impostor = R"(
in vec3 vertex_position;
uniform vec3 viewDirection;
uniform mat4 viewProjection;
#ifdef WITH_NORMAL
out vec3 surface_normal;
#endif
void main() {
  vec3 o = vertex_position, d = viewDirection;
  float b = dot(o, d), h = b * b - dot(o, o) + 1.0;
  if (h < 0.0) discard;
  vec3 p = o + (-b + (gl_FrontFacing ? -1.0 : 1.0) * sqrt(h)) * d;
#ifdef WITH_NORMAL
  surface_normal = p;
#endif
  gl_FragDepth = (viewProjection * vec4(p, 1.0)).z * 0.5 + 0.5;
}
)";

TEST(Raster, TakesDepthsAndNormalsOfTheShader) {
  for (const bool own : {true, false}) {
    const std::string text = (own ? "#version 330\n#define WITH_NORMAL\n" : "") + impostor;
    const Shape shape =
        shape_from_raster({.fragment = text, .geometry = make_box_around({{-1.1, -1.2, -1.3}, {1.1, 1.2, 1.3}})});
    const SampleSet set = sampled(shape, 120);
    EXPECT_EQ(set.disagreements, 0u);
    const Fit worst = fit(set, from_unit_sphere, itself);
    EXPECT_LT(worst.distance, 1e-3) << own;  // where rays graze it
    EXPECT_LT(worst.angle, own ? 0.05 : 1.6) << own;
    EXPECT_NEAR(set.total_area, 4 * std::numbers::pi, 0.02 * 4 * std::numbers::pi) << own;
  }
}

TEST(Raster, FollowsMotions) {
  const Shape shape = shape_from_raster({.fragment = "#define WITH_NORMAL\n" + impostor,
                                         .geometry = make_box_around({{-1.1, -1.2, -1.3}, {1.1, 1.2, 1.3}})});
  const Affine motion =
      Affine::translate({1, 2, 3}).after(Affine::rotate({1, 2, 3}, 30).after(Affine::scale({-2, 1, 1})));
  const Affine back = motion.inverse();
  const SampleSet set = sampled(transformed(shape, motion), 100);
  const Fit worst = fit(
      set, [&](const Vec3& p) { return norm(back(p)) - 1; },
      [&](const Vec3& p) {
        const Vec3 n = back(p);
        return Vec3{dot(back.column[0], n), dot(back.column[1], n), dot(back.column[2], n)};
      });
  EXPECT_LT(worst.distance, 2e-3);
  EXPECT_LT(worst.angle, 0.1);
}

TEST(Raster, StandsWhereverASolidDoes) {
  const Mesh ball = make_icosphere(4);
  const Shape drawn = shape_from_raster({.geometry = ball}), box = shape_from_box({{-2, -2, -2}, {0, 2, 2}});
  const Shape mesh = shape_from_mesh(ball);
  const auto area = [](const Shape& shape) {
    const Shape whole = shape;
    return sample_shape(whole, make_grid(whole.bounds, 80), ExecutionContext::silent()).total_area;
  };
  EXPECT_NEAR(area(subtract(drawn, {box})), area(subtract(mesh, {box})), 1e-2);
  EXPECT_NEAR(area(intersect({box, drawn})), area(intersect({box, mesh})), 1e-2);
  EXPECT_NEAR(area(offset(drawn, 0.2)), area(offset(mesh, 0.2)), 5e-2);
}

TEST(Raster, DrawsWithoutBuffers) {
  const Shape shape =
      shape_from_raster({.vertex = boxes_vertex, .vertex_count = 36, .bounds = {{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}}});
  const SampleSet set = sampled(shape, 60);
  EXPECT_FALSE(set.cut_by_bounds);
  EXPECT_EQ(set.unresolved, 0u);
  EXPECT_NEAR(set.total_area, 6, 0.2);
}

TEST(Raster, TakesMoreFragmentsThanExpected) {
  // Forty boxes within each other: winding numbers up to forty, and a list many times longer than the first guess.
  const Shape shape = shape_from_raster(
      {.vertex = boxes_vertex, .vertex_count = 36 * 40, .bounds = {{-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}}});
  const SampleSet set = sampled(shape, 200);
  EXPECT_EQ(set.unresolved, 0u);
  EXPECT_NEAR(set.total_area, 6, 0.1);
}

TEST(Raster, IsCutByItsBounds) {
  RasterOptions options{.geometry = make_icosphere(4), .bounds = {{-2, -2, -2}, {0.25, 2, 2}}};
  const SampleSet cut = sampled(shape_from_raster(options), 80);
  EXPECT_TRUE(cut.cut_by_bounds);
  EXPECT_NEAR(cut.total_area, 2 * std::numbers::pi * 1.25 + std::numbers::pi * (1 - 0.0625), 0.1);
  options.bounds = {{-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}};  // within the ball: what is left is the box
  EXPECT_NEAR(sampled(shape_from_raster(options), 80).total_area, 2 * (0.8 + 0.6 + 0.48), 0.1);
}

TEST(Raster, DiscardsAndFindsNothing) {
  const Mesh ball = make_icosphere(3);
  EXPECT_THROW(sampled(shape_from_raster({.fragment = "void main() { discard; }", .geometry = ball}), 30),
               UnusableInput);
  const std::string front = "void main() { if (!gl_FrontFacing) discard; }";
  try {
    sampled(shape_from_raster({.fragment = front, .geometry = ball}), 30);
    FAIL();
  } catch (const UnusableInput& error) {
    EXPECT_TRUE(holds(error.what(), "back faces"));
  }
  // Half a ball, open: rays through the hole lose their partner.
  const std::string half = "in vec3 vertex_position; void main() { if (vertex_position.z > 0.9) discard; }";
  EXPECT_GT(sampled(shape_from_raster({.fragment = half, .geometry = ball}), 60).unresolved, 10u);
}

/// Twenty by twenty squares of a waving sheet, which has a rim and no inside.
const std::string sheet_vertex = R"(
uniform mat4 viewProjection;
void main() {
  const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
  int square = gl_VertexID / 6;
  vec2 at = (vec2(square % 20, square / 20) + vec2(corners[gl_VertexID % 6])) / 10.0 - 1.0;
  gl_Position = viewProjection * vec4(at, 0.2 * sin(3.0 * at.x), 1.0);
}
)";

TEST(Raster, SheetsAreSurfacesAndNoSolids) {
  const Shape sheet = shape_from_raster(
      {.vertex = sheet_vertex, .vertex_count = 2400, .bounds = {{-1.5, -1.5, -0.5}, {1.5, 1.5, 0.5}}});
  const Shape ball = shape_from_raster({.geometry = make_icosphere(4)});
  evenmesh::ExecutionContext& context = evenmesh::ExecutionContext::silent();
  EXPECT_LT(sheet.ray_source()->solidity(sheet.bounds, context), 0.1);
  EXPECT_GT(ball.ray_source()->solidity(ball.bounds, context), 0.99);
  const SampleSet samples = sheet.ray_source()->sample_surface(make_grid(sheet.bounds, 100), sheet.bounds, context);
  const Fit worst = fit(
      samples, [](const Vec3& p) { return p.z - 0.2 * std::sin(3 * p.x); },
      [](const Vec3& p) {
        return Vec3{-0.6 * std::cos(3 * p.x), 0, 1};
      });
  EXPECT_LT(worst.distance, 0.005);  // of the facets
  double length = 0;                 // of the wave
  for (double x = -1; x < 1; x += 1e-3) length += 1e-3 * std::hypot(1, 0.6 * std::cos(3 * x));
  EXPECT_NEAR(samples.total_area, 2 * length, 0.05);
  // Beyond the bounds nothing is put onto them.
  const Box part{{-1.5, -1.5, -0.5}, {0, 1.5, 0.5}};
  EXPECT_NEAR(sheet.ray_source()->sample_surface(make_grid(sheet.bounds, 100), part, context).total_area, length, 0.05);
}

TEST(Raster, TakesDefinitions) {
  const std::string vertex =
      "in vec3 position;\nuniform mat4 viewProjection;\nuniform float size;\n"
      "void main() { gl_Position = viewProjection * vec4(size * position, SIZE); }\n#define SIZE 1.0\n";
  RasterOptions options{.vertex = "#define SIZE 1.0\n" + vertex.substr(0, vertex.rfind("#define")),
                        .geometry = make_icosphere(4),
                        .bounds = {{-2, -2, -2}, {2, 2, 2}}};
  EXPECT_THROW(shape_from_raster(options), InvalidInput);  // size has no value
  options.definitions = {{"size", "1.5"}};
  EXPECT_NEAR(sampled(shape_from_raster(options), 80).total_area, 9 * std::numbers::pi, 0.5);
  options.definitions = {{"size", "1.5"}, {"SIZE", "2.0"}};
  EXPECT_NEAR(sampled(shape_from_raster(options), 80).total_area, 2.25 * std::numbers::pi, 0.3);
  options.definitions["sise"] = "1";
  EXPECT_THROW(shape_from_raster(options), InvalidInput);
}

template <typename E>
std::string refused(const RasterOptions& options) {
  try {
    const Shape shape = shape_from_raster(options);
    sampled(shape, 20);
  } catch (const E& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Raster, SaysWhatIsWrongAndWhere) {
  RasterOptions o{.vertex_name = "a.vert", .fragment_name = "b.frag", .geometry = make_icosphere(2)};
  const auto with = [&](const std::string& vertex, const std::string& fragment) {
    RasterOptions changed = o;
    changed.vertex = vertex, changed.fragment = fragment;
    return changed;
  };
  EXPECT_TRUE(holds(refused<UnusableInput>(with("in vec3 position;\nvoid main() {\n  gl_Position = position;\n}", "")),
                    "a.vert:3:"));
  EXPECT_TRUE(holds(refused<UnusableInput>(with("", "\n\nvoid main() { float x = unknown; }")), "b.frag:3:25: "));
  EXPECT_TRUE(holds(refused<UnusableInput>(with("", "in vec3 color;\nvoid main() { if (color.x > 0.5) discard; }")),
                    "do not fit together"));
  EXPECT_TRUE(holds(refused<UnusableInput>(with("in vec2 uv;\nvoid main() { gl_Position = vec4(uv, 0, 1); }", "")),
                    "a.vert:1:9: vertices have no such attribute"));
  EXPECT_TRUE(holds(refused<UnusableInput>(
                        with("", "uniform sampler2D t;\nvoid main() { if (texture(t, vec2(0)).x > 0.5) discard; }")),
                    "b.frag:2:"));
  EXPECT_TRUE(holds(refused<UnusableInput>(with("", "uniform vec3 viewProjection;\nvoid main() {}")), "b.frag:1:14"));
  EXPECT_TRUE(holds(refused<UnusableInput>(with("", "void main() {\n  float x = 0.0;\n  while (x < 1.0) x *= 0.5;\n}")),
                    "b.frag:3: this loop does not end"));
  EXPECT_TRUE(holds(refused<InvalidInput>(with("", "void mein() {}")), "b.frag: there is no function void main()"));
  o.geometry = {};
  EXPECT_TRUE(holds(refused<InvalidInput>(o), "draws nothing"));
  o.vertex_count = 36, o.vertex = plain_vertex;
  EXPECT_TRUE(holds(refused<InvalidInput>(o), "--bounds"));
  o.bounds = {{-1, -1, -1}, {1, 1, 1}};
  EXPECT_TRUE(holds(refused<InvalidInput>(o), "a.vert reads the attributes"));
  o.vertex_count = 35;
  EXPECT_TRUE(holds(refused<InvalidInput>(o), "multiple of 3"));
}

TEST(Raster, GivesTheSameBytesForAnyNumberOfThreads) {
  const Shape shape = shape_from_raster({.geometry = turned_cube()});
  evenmesh::ExecutionContext one(1), two(2);
  const Grid grid = make_grid(shape.bounds, 100);
  const SampleSet a = sample_shape(shape, grid, one), b = sample_shape(shape, grid, two);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.area, b.area);
}

}  // namespace
}  // namespace evenmesh
