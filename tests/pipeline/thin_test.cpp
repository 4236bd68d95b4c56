#include <charconv>
#include <cmath>

#include "evenmesh/solid.h"
#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

Mesh box_between(const Vec3& lo, const Vec3& hi) {
  return make_box_around({lo, hi});
}

const Finding& finding_of(const Report& report, FindingCode code) {
  const auto found =
      std::find_if(report.findings.begin(), report.findings.end(), [&](const Finding& f) { return f.code == code; });
  return found == report.findings.end() ? throw std::runtime_error("nothing is said of it") : *found;
}

double value_of(const Finding& finding, std::string_view name) {
  for (const auto& [key, value] : finding.values)
    if (key == name) return std::get<double>(value);
  throw std::runtime_error("no such value");
}

/// The number behind a word of the sentence, as "-r 120".
std::size_t number_after(const Finding& finding, const std::string& word) {
  const std::size_t at = finding.sentence.find(word);
  if (at == std::string::npos) return 0;
  std::size_t number = 0;
  const char* begin = finding.sentence.data() + at + word.size();
  std::from_chars(begin, finding.sentence.data() + finding.sentence.size(), number);
  return number;
}

/// A block of one by one by one with a fin on top, in one piece or as a boolean.
Shape block_with_fin(double thickness, bool boolean) {
  const Mesh block = box_between({0, 0, 0}, {1, 1, 1});
  const Mesh fin = box_between({0.37, 0, 0.9}, {0.37 + thickness, 1, 1.6});
  if (boolean) return unite({shape_from_mesh(block), shape_from_mesh(fin)});
  return shape_from_mesh(merged(block, fin));
}

TEST(ThinParts, AFinBetweenTheGridPointsIsKeptWithAFinerGrid) {
  for (const bool boolean : {false, true}) {
    const MeshResult result = meshed(block_with_fin(0.004, boolean), {.vertices = 600});
    expect_good_mesh(result);
    EXPECT_NEAR(result.report.quality.volume, 1 + 0.6 * 0.004, 0.0005);
    EXPECT_NEAR(result.report.quality.area, 6 + 2 * 0.6, 0.05);
    EXPECT_NEAR(result.report.quality.bounds.hi.z, 1.6, 1e-3);
    EXPECT_TRUE(has_finding(result.report, FindingCode::grid_refined)) << "more samples than asked for are said";
  }
}

TEST(ThinParts, WhatTheGridAskedForLosesIsNamedWithTheOneThatKeepsIt) {
  const Shape shape = block_with_fin(0.004, false);
  const MeshResult lost = meshed(shape, {.vertices = 600, .resolution = 90});
  const Finding& finding = finding_of(lost.report, FindingCode::thin_parts_lost);
  EXPECT_EQ(finding.severity, Severity::broken_promise);
  EXPECT_NEAR(value_of(finding, "thickness"), 0.004, 0.0005);
  EXPECT_NEAR(value_of(finding, "area"), 0.6, 0.12);
  EXPECT_NEAR(finding.place->x, 0.372, 0.01);
  EXPECT_NEAR(finding.place->z, 1.3, 0.1);
  const std::size_t resolution = number_after(finding, "-r ");
  ASSERT_GT(resolution, 90u) << finding.sentence;
  const MeshResult kept = meshed(shape, {.vertices = 600, .resolution = resolution});
  expect_good_mesh(kept);
  EXPECT_NEAR(kept.report.quality.volume, 1 + 0.6 * 0.004, 0.0005);
}

TEST(ThinParts, AGapBetweenTheGridPointsIsKeptOrNamed) {
  const Mesh boxes = merged(box_between({0, 0, 0}, {1, 1, 0.4}), box_between({0, 0, 0.403}, {1, 1, 0.9}));
  const MeshResult kept = meshed(shape_from_mesh(boxes), {.vertices = 600});
  expect_good_mesh(kept);
  EXPECT_EQ(kept.report.quality.components, 2u);
  const MeshResult filled = meshed(shape_from_mesh(boxes), {.vertices = 600, .resolution = 90});
  EXPECT_EQ(filled.report.quality.components, 1u);
  EXPECT_NEAR(value_of(finding_of(filled.report, FindingCode::thin_parts_lost), "thickness"), 0.003, 0.0003);
}

TEST(ThinParts, PartsThatTouchAreOneWithoutAWord) {
  const Mesh boxes = merged(box_between({0, 0, 0}, {1, 1, 0.4}), box_between({0, 0, 0.4}, {1, 1, 0.9}));
  const MeshResult result = meshed(shape_from_mesh(boxes), {.vertices = 600});
  expect_good_mesh(result);
  EXPECT_EQ(result.report.quality.components, 1u);
  EXPECT_FALSE(has_finding(result.report, FindingCode::grid_refined));
}

TEST(ThinParts, AKnifeEdgeIsNoWall) {
  Mesh wedge = box_between({0, 0, 0}, {1, 2, 0.2});
  for (Vec3& v : wedge.vertices)
    if (v.x > 0.5) v.z = 0.1;
  const MeshResult result = meshed(shape_from_mesh(wedge), {.vertices = 1500});
  EXPECT_FALSE(has_finding(result.report, FindingCode::thin_parts_lost));
  EXPECT_FALSE(has_finding(result.report, FindingCode::grid_refined));
  EXPECT_FALSE(has_finding(result.report, FindingCode::parts_lost));
}

TEST(ThinParts, AClosedPlateStaysClosed) {
  const Shape plate = shape_from_mesh(box_between({0, 0, 0}, {2, 2, 0.012}));
  const MeshResult result = meshed(plate, {.edge_length = 0.1});
  expect_good_mesh(result);
  EXPECT_EQ(result.report.quality.euler, 2);
  EXPECT_NEAR(result.report.quality.volume, 0.048, 0.001);
  EXPECT_NEAR(result.report.quality.edge_length_avg, 0.1, 0.005);
}

TEST(ThinParts, APlateTooThinForAnyGridBecomesASheetAndIsNamed) {
  const MeshResult result = meshed(shape_from_mesh(box_between({0, 0, 0}, {2, 2, 0.0004})), {.vertices = 300});
  EXPECT_FALSE(result.report.quality.closed());
  const Finding& finding = finding_of(result.report, FindingCode::closed_as_sheets);
  EXPECT_EQ(finding.severity, Severity::broken_promise);
  EXPECT_NEAR(value_of(finding, "thickness"), 0.0004, 0.00002);
  EXPECT_GT(value_of(finding, "vertices"), 300);
}

TEST(ThinParts, TwoSidesInOnePlaceHaveNoThickness) {
  Mesh sheet = make_grid_plane(4, 4, 0.25), back = sheet;
  for (Triangle& t : back.triangles) std::swap(t[0], t[1]);
  const MeshResult result = meshed(shape_from_mesh(merged(sheet, back)), {.vertices = 300});
  EXPECT_FALSE(result.report.quality.closed());
  EXPECT_FALSE(has_finding(result.report, FindingCode::closed_as_sheets)) << "it never had two sides apart";
}

TEST(LostParts, APieceBesideTheMeshIsNamed) {
  // An open sheet beside a solid bounds nothing.
  const Mesh sheet = translated(make_grid_plane(4, 4, 0.2), {0.1, 0.1, 1.7});
  const MeshResult result =
      meshed(shape_from_mesh(merged(box_between({0, 0, 0}, {1, 1, 1}), sheet)), {.vertices = 600});
  const Finding& finding = finding_of(result.report, FindingCode::sheets_left_out);
  EXPECT_EQ(finding.severity, Severity::broken_promise);
  EXPECT_NEAR(value_of(finding, "area"), 0.64, 0.1);
  EXPECT_NEAR(finding.place->z, 1.7, 1e-6);
  EXPECT_FALSE(has_finding(result.report, FindingCode::parts_lost)) << "said once";
}

TEST(LostParts, ABodyFarSmallerThanAnEdgeIsNamed) {
  const Mesh boxes =
      merged(box_between({0, 0, 0}, {1, 1, 1}), box_between({1.505, 0.505, 0.505}, {1.509, 0.509, 0.509}));
  const MeshResult result = meshed(shape_from_mesh(boxes), {.vertices = 300});
  EXPECT_EQ(result.report.quality.components, 1u);
  EXPECT_TRUE(has_finding(result.report, FindingCode::small_components_dropped));
  EXPECT_EQ(result.report.dropped_components, 1u);
}

TEST(LostParts, WhatLiesWithinTheSolidIsNotMissed) {
  Mesh bodies = merged(box_between({0, 0, 0}, {2, 2, 2}), box_between({0.8, 0.8, 0.8}, {1.2, 1.2, 1.2}));
  bodies = merged(bodies, box_between({1.5, 0.5, 0.5}, {3, 1.5, 1.5}));
  const MeshResult result = meshed(shape_from_mesh(bodies), {.vertices = 1500});
  expect_good_mesh(result);
  EXPECT_TRUE(result.report.findings.empty());
}

}  // namespace
}  // namespace evenmesh
