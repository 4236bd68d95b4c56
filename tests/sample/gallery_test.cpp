#include <gtest/gtest.h>

#include "sample_checks.h"

namespace evenmesh {
namespace {

std::vector<std::string> gallery_names() {
  std::vector<std::string> names;
  for (const GalleryEntry& entry : gallery()) names.emplace_back(entry.name);
  return names;
}

class SampleGallery : public testing::TestWithParam<std::string> {};

TEST_P(SampleGallery, OneSignGridBoundsIt) {
  const Shape shape = gallery_shape(GetParam());
  const SampleSet set = sample_shape(shape, make_grid(shape.bounds, 64));
  expect_one_sign_grid(set);
  EXPECT_GT(set.size(), 100u);
  EXPECT_GT(set.total_area, 0);
}

INSTANTIATE_TEST_SUITE_P(All, SampleGallery, testing::ValuesIn(gallery_names()), [](const auto& entry) {
  std::string name = entry.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace evenmesh
