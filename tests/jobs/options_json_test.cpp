#include "evenmesh/options_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>
#include <utility>

#include "evenmesh/error.h"
#include "evenmesh/names.h"

namespace evenmesh {
namespace {

/// All members; no longer compiles when there is one more, which then belongs into the JSON, too.
auto members(const MeshOptions& options) {
  const auto& [vertices, edge_length, resolution, method, thickness, feature_angle, fill_cavities, wrap, density,
               bounds, quality, evenness, optimizer, start, connect, max_cycle, topology, placement, iterations,
               tolerance, seed] = options;
  return std::make_tuple(vertices, edge_length, resolution, method, thickness, feature_angle, fill_cavities, wrap,
                         expression_of(density), bounds, quality, evenness, optimizer, start, connect, max_cycle,
                         topology, placement, iterations, tolerance, seed);
}

/// Every member differs from its default, and numbers use all their bits.
MeshOptions unusual() {
  return {.vertices = 1'000'000'000,
          .edge_length = 0.1 + 0.2,
          .resolution = 8191,
          .method = Method::shell,
          .thickness = 20,
          .feature_angle = 1.0 / 3,
          .fill_cavities = true,
          .wrap = true,
          .density = density_from_expression("1 + a exp(-b x^2)", {{"a", 4.1}, {"b", 1e-300}}),
          .bounds = Box{{-1e300, -0.1, 2.0 / 3}, {1e-300, 1, 5}},
          .quality = Quality::high,
          .evenness = 0.1 + 0.6,
          .optimizer = Optimizer::lloyd,
          .start = Start::random,
          .connect = Connect::fragments,
          .max_cycle = 8,
          .topology = TopologyRule::simplify,
          .placement = Placement::centroid,
          .iterations = 0,
          .tolerance = std::numeric_limits<double>::denorm_min(),
          .seed = std::numeric_limits<std::uint64_t>::max()};
}

template <std::size_t... I>
void expect_all_differ(const MeshOptions& a, const MeshOptions& b, std::index_sequence<I...>) {
  const auto x = members(a);
  const auto y = members(b);
  for (const bool same : {std::get<I>(x) == std::get<I>(y)...}) EXPECT_FALSE(same);
}

std::string refusal(std::string_view json) {
  try {
    options_from_json(json);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OptionsJson, EveryFieldGoesThereAndBack) {
  const MeshOptions options = unusual();
  expect_all_differ(options, MeshOptions{}, std::make_index_sequence<std::tuple_size_v<decltype(members(options))>>());
  EXPECT_EQ(members(options_from_json(options_json(options))), members(options));
  EXPECT_EQ(members(options_from_json(options_json({}))), members(MeshOptions{}));
  EXPECT_EQ(options_json(options_from_json(options_json(options))), options_json(options));
}

TEST(OptionsJson, EveryNameGoesThereAndBack) {
  const auto check = [](auto MeshOptions::*member, auto value) {
    MeshOptions options;
    options.*member = value;
    EXPECT_EQ(options_from_json(options_json(options)).*member, value);
  };
  for (const auto& entry : names<Method>()) check(&MeshOptions::method, entry.value);
  for (const auto& entry : names<Quality>()) check(&MeshOptions::quality, entry.value);
  for (const auto& entry : names<Optimizer>()) check(&MeshOptions::optimizer, entry.value);
  for (const auto& entry : names<Start>()) check(&MeshOptions::start, entry.value);
  for (const auto& entry : names<Connect>()) check(&MeshOptions::connect, entry.value);
  for (const auto& entry : names<TopologyRule>()) check(&MeshOptions::topology, entry.value);
  for (const auto& entry : names<Placement>()) check(&MeshOptions::placement, entry.value);
}

TEST(OptionsJson, WhatIsMissingComesFromTheBase) {
  const MeshOptions base = unusual();
  EXPECT_EQ(members(options_from_json("{}", base)), members(base));
  EXPECT_EQ(members(options_from_json("{}")), members(MeshOptions{}));
  const MeshOptions changed = options_from_json(R"({"vertices": 5000, "features": "off"})", base);
  EXPECT_EQ(changed.vertices, 5000u);
  EXPECT_EQ(changed.feature_angle, std::nullopt);
  EXPECT_EQ(changed.seed, base.seed);
  EXPECT_EQ(options_from_json(R"({"features": "auto"})", base).feature_angle, MeshOptions{}.feature_angle);
  EXPECT_FALSE(options_from_json(R"({"density": "uniform"})", base).density);
}

TEST(OptionsJson, ParametersOfADensityMayChangeAlone) {
  const MeshOptions base = unusual();
  const MeshOptions changed = options_from_json(R"({"density_parameters": {"a": 2, "b": 0}})", base);
  EXPECT_EQ(changed.density({0, 0, 0}), 3);
  EXPECT_NE(refusal(R"({"density_parameters": {"a": 2}})").find("give density, too"), std::string::npos);
}

TEST(OptionsJson, ADensityOfTheCallersOwnHasNoText) {
  const std::string text = options_json({.density = [](const Vec3& p) { return 2 + p.x; }});
  EXPECT_NE(text.find("\"density\": null"), std::string::npos) << text;
  EXPECT_NE(refusal(text).find("density takes"), std::string::npos);
  const std::string endless = options_json({.edge_length = std::numeric_limits<double>::infinity()});
  EXPECT_NE(refusal(endless).find("edge_length takes a number"), std::string::npos);
}

TEST(OptionsJson, WhatIsWrongIsSaidInOneSentence) {
  const std::pair<const char*, const char*> cases[]{
      {"", "no JSON"},
      {"vertices: 5", "no JSON"},
      {"{\"vertices\": 5", "no JSON"},
      {R"({"tolerance": 1e999})", "no JSON"},
      {"[]", "one JSON object"},
      {"5", "one JSON object"},
      {R"({"vertixes": 5})", "there is no option \"vertixes\"; did you mean vertices?"},
      {R"({"feature_angle": 5})", "there is no option \"feature_angle\""},
      {R"({"\n": 5})", "there is no option \"\\n\""},
      {R"({"vertices": "5"})", "vertices takes a whole number from 4 to 1000000000, not \"5\""},
      {R"({"vertices": 3})", "from 4 to 1000000000, not 3"},
      {R"({"vertices": -5})", "not -5"},
      {R"({"vertices": 5.5})", "not 5.5"},
      {R"({"vertices": null})", "not null"},
      {R"({"thickness": 4294967298})", "thickness takes a whole number from 1 to 20"},
      {R"({"seed": 18446744073709551616})", "seed takes a whole number"},
      {R"({"edge_length": true})", "edge_length takes a number, not true"},
      {R"({"wrap": 1})", "wrap takes true or false, not 1"},
      {R"({"quality": 1})", "quality takes one of fast, normal, high, not 1"},
      {R"({"quality": "hihg"})", "not \"hihg\"; did you mean high?"},
      {R"({"start": "blue_noise"})", "did you mean blue-noise?"},
      {R"({"features": "on"})", "an angle in degrees, \"auto\" or \"off\", not \"on\""},
      {R"({"bounds": [0, 0, 0, 1, 1]})", "six numbers [x0, y0, z0, x1, y1, z1], not [0,0,0,1,1]"},
      {R"({"bounds": [0, 0, 0, 1, 1, "1"]})", "six numbers"},
      {R"({"density": 5})", "density takes \"uniform\" or an expression"},
      {R"({"density": "1 +"})", "density: "},
      {R"({"density": "a", "density_parameters": 1})", "density_parameters takes an object"},
      {R"({"density": "a", "density_parameters": {"a": "1"}})", "density_parameters.a takes a number"},
  };
  for (const auto& [json, words] : cases) EXPECT_NE(refusal(json).find(words), std::string::npos) << refusal(json);
}

}  // namespace
}  // namespace evenmesh
