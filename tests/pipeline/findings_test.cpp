#include <gtest/gtest.h>

#include <set>

#include "pipeline/pipeline_testing.h"

namespace evenmesh {
namespace {

TEST(Findings, AreNamedOnceAndInKebabCase) {
  std::set<std::string_view> names;
  for (int code = 0; code <= static_cast<int>(FindingCode::stl_as_text); ++code) {
    const std::string_view name = finding_name(static_cast<FindingCode>(code));
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string_view::npos) << name;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
}

TEST(Findings, SentencesAreMadeOfTheValues) {
  const Finding finding =
      make_finding(FindingCode::vertex_count, {{"vertices", 120.0}, {"asked", 100.0}, {"reason", "needs more"}});
  EXPECT_EQ(finding.sentence, "120 vertices instead of 100: the topology needs more");
  EXPECT_EQ(finding.severity, Severity::note);
  const Finding merged = make_finding(FindingCode::sheets_merged,
                                      {{"width", 0.25}, {"count", 2.0}, {"cure", "nothing helps"}}, Vec3{1, 2, 3.5});
  EXPECT_NE(merged.sentence.find("within 0.25 of each other merge in 2 places, first at (1, 2, 3.5): nothing helps"),
            std::string::npos)
      << merged.sentence;
}

TEST(Findings, AGoodRunHasNone) {
  EXPECT_TRUE(meshed(gallery_shape("torus"), {.vertices = 1000}).report.findings.empty());
}

}  // namespace
}  // namespace evenmesh
