#include <nlohmann/json.hpp>

#include "core/instruction_sets.h"
#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

TEST(MeshOptions, OutOfRangeIsRefused) {
  const Shape ball = gallery_shape("sphere");
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const MeshOptions wrong[] = {
      {.vertices = 3},
      {.vertices = 1'000'000'001},
      {.vertices = 100, .edge_length = 0.1},
      {.edge_length = 0},
      {.edge_length = -1},
      {.edge_length = nan},
      {.edge_length = infinity},
      {.vertices = 100, .resolution = 7},
      {.vertices = 100, .resolution = 8193},
      {.vertices = 100, .thickness = 0},
      {.vertices = 100, .thickness = 21},
      {.vertices = 100, .bounds = Box{}},
      {.vertices = 100, .bounds = Box{{0, 0, 0}, {nan, 1, 1}}},
      {.vertices = 100, .bounds = Box{{0, 0, 0}, {infinity, 1, 1}}},
      {.vertices = 100, .bounds = Box{{0, 0, 0}, {0, 0, 0}}},
      {.vertices = 100, .iterations = 10'001},
      {.vertices = 100, .tolerance = 0},
      {.vertices = 100, .tolerance = 1},
      {.vertices = 100, .tolerance = nan},
      {.vertices = 100, .evenness = -0.1},
      {.vertices = 100, .evenness = 1.1},
      {.vertices = 100, .evenness = nan},
  };
  for (std::size_t i = 0; i < std::size(wrong); ++i) EXPECT_THROW(meshed(ball, wrong[i]), InvalidInput) << "case " << i;
}

TEST(MeshOptions, RaysNeedASolid) {
  const Shape points = shape_from_points({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}});
  EXPECT_THROW(meshed(points, {.vertices = 100, .method = Method::raster}), InvalidInput);
}

TEST(MeshOptions, AreLookedAtBeforeTheShape) {
  const Shape line = shape_from_points({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}});
  EXPECT_THROW(meshed(line, {.vertices = 3}), InvalidInput);
  EXPECT_THROW(meshed(line, {.vertices = 100}), UnusableInput);
}

struct Choice {
  const char* name;
  MeshOptions options;
  friend void PrintTo(const Choice& c, std::ostream* out) { *out << c.name; }
};

class EveryChoice : public testing::TestWithParam<Choice> {};

TEST_P(EveryChoice, GivesAGoodMeshOfTheSameBytesForAnyNumberOfThreads) {
  MeshOptions options = GetParam().options;
  options.vertices = 300;
  const Shape torus = gallery_shape("torus");
  const MeshResult one = meshed(torus, options, 1), two = meshed(torus, options, 2);
  expect_good_mesh(one);
  expect_count(one, 300);
  EXPECT_EQ(one.report.quality.euler, 0);
  EXPECT_GT(one.report.quality.q_avg, 0.8);
  EXPECT_TRUE(same_mesh(one.mesh, two.mesh));
  EXPECT_EQ(one.report.energies, two.report.energies);
}

INSTANTIATE_TEST_SUITE_P(
    Options, EveryChoice,
    testing::Values(Choice{"fast", {.quality = Quality::fast}}, Choice{"normal", {}},
                    Choice{"high", {.quality = Quality::high}}, Choice{"lloyd", {.optimizer = Optimizer::lloyd}},
                    Choice{"random", {.start = Start::random}}, Choice{"blue_noise", {.start = Start::blue_noise}},
                    Choice{"centroid", {.placement = Placement::centroid}},
                    Choice{"constrained", {.placement = Placement::constrained}},
                    Choice{"fragments", {.connect = Connect::fragments}},
                    Choice{"simplify", {.topology = TopologyRule::simplify}},
                    Choice{"few_iterations", {.iterations = 3}}, Choice{"other_seed", {.seed = 77}}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(MeshOptions, ThreadsDoNotChangeMeshInputsOrThinParts) {
  const MeshOptions options{.vertices = 500, .quality = Quality::fast};
  for (const Shape& shape : {shape_from_mesh(make_torus()), gallery_shape("thin-plate")})
    EXPECT_TRUE(same_mesh(meshed(shape, options, 1).mesh, meshed(shape, options, 3).mesh)) << shape.name;
}

TEST(MeshOptions, InstructionSetsDoNotChangeTheMesh) {
  const MeshOptions options{.vertices = 300, .quality = Quality::fast};
  for (const Shape& shape : {shape_from_mesh(make_torus()), gallery_shape("sphere")}) {
    const MeshResult expected = meshed(shape, options);
    on_every_instruction_set([&](const char* target) {
      EXPECT_TRUE(same_mesh(meshed(shape, options).mesh, expected.mesh)) << shape.name << " on " << target;
    });
  }
}

TEST(MeshOptions, SeedsChangeTheMesh) {
  const Shape ball = gallery_shape("sphere");
  EXPECT_FALSE(
      same_mesh(meshed(ball, {.vertices = 200, .seed = 1}).mesh, meshed(ball, {.vertices = 200, .seed = 2}).mesh));
  EXPECT_TRUE(
      same_mesh(meshed(ball, {.vertices = 200, .seed = 2}).mesh, meshed(ball, {.vertices = 200, .seed = 2}).mesh));
}

TEST(MeshOptions, EdgeLengthIsMet) {
  for (const char* name : {"sphere", "torus", "tangle"}) {
    const Shape shape = gallery_shape(name);
    const double edge = 0.05 * shape.bounds.longest_side();
    const MeshResult result = meshed(shape, {.edge_length = edge});
    expect_good_mesh(result);
    EXPECT_NEAR(result.report.quality.edge_length_avg, edge, 0.05 * edge) << name;
  }
}

TEST(MeshOptions, WithoutFinenessOneIsEstimatedAndSaid) {
  for (const char* name : {"sphere", "torus"}) {
    const MeshResult result = meshed(gallery_shape(name), {.quality = Quality::fast});
    expect_good_mesh(result);
    EXPECT_GE(result.mesh.vertices.size(), 200u) << name;
    EXPECT_LE(result.mesh.vertices.size(), 20'000u) << name;
    EXPECT_TRUE(has_finding(result.report, FindingCode::fineness_estimated));
  }
}

TEST(MeshOptions, TooFewSamplesLowerTheCount) {
  const MeshResult result = meshed(gallery_shape("sphere"), {.vertices = 5000, .resolution = 40});
  expect_good_mesh(result);
  EXPECT_LT(result.mesh.vertices.size(), 1000u);
  EXPECT_GE(result.report.alpha, 49.0);
  EXPECT_EQ(result.report.resolution, 40u);
  EXPECT_TRUE(has_finding(result.report, FindingCode::vertices_limited));
}

TEST(MeshOptions, DefaultResolutionGivesAHundredSamplesPerSeed) {
  for (const char* name : {"sphere", "cube", "torus"})
    EXPECT_GE(meshed(gallery_shape(name), {.vertices = 300}).report.alpha, 99) << name;
}

TEST(MeshOptions, VeryFewVerticesStillCloseTheSurface) {
  for (const std::size_t vertices : {4u, 6u, 12u, 40u}) {
    const MeshResult ball = meshed(gallery_shape("sphere"), {.vertices = vertices});
    expect_good_mesh(ball);
    EXPECT_EQ(ball.report.quality.euler, 2) << vertices;
    const MeshResult torus = meshed(gallery_shape("torus"), {.vertices = vertices});
    expect_good_mesh(torus);
    // The hole stays, unless it was closed on purpose.
    EXPECT_TRUE(torus.report.quality.euler == 0 || torus.report.regularization_rounds > 0) << vertices;
    expect_count(torus, vertices);
  }
}

TEST(MeshOptions, MoreEffortGivesLessEnergy) {
  const Shape shape = gallery_shape("tangle");
  const auto quality = [&](Quality q) { return meshed(shape, {.vertices = 400, .quality = q}).report; };
  const Report fast = quality(Quality::fast), high = quality(Quality::high);
  EXPECT_LT(high.energy_ratio, fast.energy_ratio);
}

TEST(Runs, CancelBeforeAndDuringTheRun) {
  const Shape ball = gallery_shape("sphere");
  evenmesh::ExecutionContext before(1);
  before.cancel();
  EXPECT_THROW(mesh_shape(ball, {.vertices = 200}, before), Cancelled);
  for (const char* stage : {"sample", "relax", "connect", "place", "refine", "measure"}) {
    evenmesh::ExecutionContext during(2);
    during.on_progress([&](std::string_view running, double) {
      if (running == stage) during.cancel();
    });
    EXPECT_THROW(mesh_shape(ball, {.vertices = 200}, during), Cancelled) << stage;
  }
}

TEST(Runs, ProgressGrowsToOne) {
  evenmesh::ExecutionContext context(2);
  double last = 0;
  std::size_t calls = 0;
  context.on_progress([&](std::string_view stage, double fraction) {
    EXPECT_FALSE(stage.empty());
    EXPECT_GE(fraction, last);
    last = fraction;
    ++calls;
  });
  mesh_shape(gallery_shape("touching-balls"), {.vertices = 300}, context);
  EXPECT_EQ(last, 1);
  EXPECT_GT(calls, 5u);
}

TEST(Reports, AreJsonWithTheKeysOfTheCommandLine) {
  const MeshResult result = meshed(gallery_shape("torus"), {.vertices = 300});
  const auto json = nlohmann::json::parse(report_json(result.report));
  for (const char* key : {"vertices",
                          "faces",
                          "q_min",
                          "q_avg",
                          "theta_min",
                          "theta_avg",
                          "irregular_ratio",
                          "boundary_edges",
                          "non_manifold_edges",
                          "non_manifold_vertices",
                          "components",
                          "euler",
                          "closed",
                          "oriented",
                          "area",
                          "volume",
                          "edge_length_avg",
                          "seeds",
                          "samples",
                          "alpha",
                          "energy_ratio",
                          "evaluations",
                          "regularization_rounds",
                          "seconds",
                          "peak_memory_bytes",
                          "self_intersections",
                          "findings"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["vertices"], result.mesh.vertices.size());
  EXPECT_EQ(json["faces"], result.mesh.triangles.size());
  EXPECT_EQ(json["euler"], 0);
  EXPECT_EQ(json["closed"], true);
  EXPECT_EQ(json["evaluations"], json["energies"].size());
  for (const char* stage : {"sample", "relax", "connect", "place", "refine", "measure"})
    EXPECT_TRUE(json["seconds"].contains(stage)) << stage;
}

TEST(Reports, OfNothingAreJsonToo) {
  Report report;
  report.findings.push_back(
      {FindingCode::no_area, Severity::broken_promise, Vec3{1, 2, 3}, {{"count", 4.0}}, "a \"quoted\" sentence\n"});
  const auto json = nlohmann::json::parse(report_json(report));
  const auto& finding = json["findings"][0];
  EXPECT_EQ(finding["code"], "no-area");
  EXPECT_EQ(finding["severity"], "broken promise");
  EXPECT_EQ(finding["place"], nlohmann::json::parse("[1, 2, 3]"));
  EXPECT_EQ(finding["values"]["count"], 4);
  EXPECT_EQ(finding["sentence"], "a \"quoted\" sentence\n");
}

TEST(Density, VerticesGatherWhereTheyAreWanted) {
  // On a ball, three times as many per area at the top as at the bottom.
  EXPECT_DOUBLE_EQ(density_from_expression("2 + a x", {{"a", 3}})({1, 2, 3}), 5);
  for (const Method method : {Method::raster, Method::shell}) {
    MeshOptions options{.vertices = 1500, .method = method, .quality = Quality::fast};
    options.density = density_from_expression("2 + z");
    const MeshResult result = meshed(shape_from_mesh(make_icosphere(4)), options);
    expect_good_mesh(result);
    EXPECT_GT(result.report.quality.q_avg, 0.9);
    double wanted = 0, above = 0;
    const std::size_t slices = 1000;
    for (std::size_t i = 0; i < slices; ++i) {
      const double z = -1 + 2 * (static_cast<double>(i) + 0.5) / slices;  // equal areas
      wanted += 2 + z;
      above += z > 0 ? 2 + z : 0;
    }
    const auto counted =
        std::count_if(result.mesh.vertices.begin(), result.mesh.vertices.end(), [](const Vec3& v) { return v.z > 0; });
    EXPECT_NEAR(static_cast<double>(counted) / static_cast<double>(result.mesh.vertices.size()), above / wanted, 0.03);
  }
}

TEST(Density, MustBeAboveZero) {
  MeshOptions options{.vertices = 100};
  options.density = density_from_expression("z");
  EXPECT_THROW(meshed(gallery_shape("sphere"), options), InvalidInput);
}

}  // namespace
}  // namespace evenmesh
