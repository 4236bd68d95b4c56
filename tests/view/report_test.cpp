#include <gtest/gtest.h>

#include "evenmesh/render.h"
#include "geometry/primitives.h"
#include "view/charts.h"
#include "view/shell_cut.h"

namespace evenmesh {
namespace {

MeshResult example() {
  MeshResult result;
  result.mesh = make_icosphere(2);
  Report& report = result.report;
  report.quality = measure_quality(result.mesh);
  report.energies = {1.3, 1.1, 1.05, 1.02, 1.2, 1.01};
  report.energy_ratio = 1.01;
  report.seconds = {{"sample", 0.2}, {"relax <fast>", 0.7}};
  report.findings = {
      {FindingCode::vertex_count, Severity::note, {}, {}, "12 more vertices were needed."},
      {FindingCode::self_intersections, Severity::broken_promise, {}, {}, "2 pairs & more <intersect>."}};
  return result;
}

/// The page of the example, drawn once: pictures take their time under sanitizers.
const std::string& example_page() {
  static const std::string page = report_html(example(), "a <b> & \"c\"");
  return page;
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(Report, ShowsACutThroughTheShell) {
  const MeshResult result = example();
  Artifacts kept;
  SparseVolume& cut = kept.shell_cut.emplace();
  cut.side = 0.1;
  for (std::int32_t i = -12; i <= 12; ++i)
    for (std::int32_t j = -12; j <= 12; ++j)
      if (const double off = std::abs(std::hypot(i, j) - 10); off < 2)
        cut.voxels.push_back({i, 0, j}), cut.values.push_back(static_cast<float>(0.1 * off));
  EXPECT_EQ(count_of(report_html(result, "shell", ExecutionContext::silent(), kept),
                     "src=\"data:image/png;base64,iVBORw0KGgo"),
            5u);
  for (const double window : {0.0, 8.0}) {
    const Image image = shell_cut_image(cut, result.mesh, 300, window);
    EXPECT_EQ(image.width, 300);
    EXPECT_NEAR(image.height, 300, 2);
    std::size_t red = 0, white = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      red += image.rgb[i] == 0xd8 && image.rgb[i + 1] == 0x35;
      white += image.rgb[i] == 255 && image.rgb[i + 2] == 255;
    }
    EXPECT_GT(red, 200u) << "the mesh's section";
    EXPECT_GT(white, 1000u);
  }
}

TEST(Report, IsOneSelfContainedPage) {
  const std::string& html = example_page();
  EXPECT_EQ(html.rfind("<!doctype html>", 0), 0u);
  EXPECT_LT(html.size(), 1'500'000u);
  EXPECT_EQ(count_of(html, "src=\"data:image/png;base64,iVBORw0KGgo"), 3u);
  EXPECT_EQ(count_of(html, "src="), 3u);
  EXPECT_EQ(count_of(html, "<svg"), 3u);
  EXPECT_EQ(count_of(html, "http"), 0u);
  EXPECT_EQ(count_of(html, "<script"), 0u);
  for (const char* tag : {"div", "section", "figure", "table", "svg", "p", "ul", "li", "main", "body", "html"})
    EXPECT_EQ(count_of(html, std::string("<").append(tag).append(">")) +
                  count_of(html, std::string("<").append(tag).append(" ")),
              count_of(html, std::string("</").append(tag).append(">")))
        << tag;
}

TEST(Report, EscapesAllText) {
  const std::string& html = example_page();
  EXPECT_EQ(html.find("<b> &"), std::string::npos);
  EXPECT_NE(html.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(html.find("2 pairs &amp; more &lt;intersect&gt;."), std::string::npos);
  EXPECT_NE(html.find("relax &lt;fast&gt;"), std::string::npos);
}

TEST(Report, PutsBrokenPromisesFirst) {
  const std::string& html = example_page();
  EXPECT_LT(html.find("2 pairs"), html.find("12 more"));
  EXPECT_LT(html.find("12 more"), html.find("<figure"));
}

TEST(Report, OfAnEmptyResultIsStillAPage) {
  const std::string html = report_html({}, "nothing");
  EXPECT_NE(html.find("</html>"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(Charts, CopeWithExtremes) {
  EXPECT_TRUE(energy_svg({}).empty());
  EXPECT_TRUE(time_bar_html({{"nothing", 0.0}}).empty());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& ratios :
       {std::vector<double>{1.0}, {0.9, 1.0}, {1e6, 1.0001}, {infinity, 1.1}, std::vector<double>(100'000, 1.01)}) {
    const std::string svg = energy_svg(ratios);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    EXPECT_LT(svg.size(), 30'000u);
  }
  EXPECT_NE(histogram_svg(Histogram{0, 1, {0, 0}}, "none", "", 5, 1).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace evenmesh
