#include "grid/dexels.h"

#include <algorithm>
#include <cmath>

#include "evenmesh/error.h"
#include "grid/blocks.h"
#include "grid/dual_surface.h"
#include "grid/inside_runs.h"
#include "grid/morton.h"

namespace evenmesh {
namespace {

constexpr std::uint32_t largest_size = 8200;

void check(const Dexels& dexels) {
  if (!(dexels.spacing > 0) || !std::isfinite(dexels.spacing) || !is_finite(dexels.origin))
    throw UnusableInput(
        "the grid of the dexels has no place or size: origin and spacing must be finite, spacing above 0");
  for (const std::uint32_t n : dexels.size)
    if (n < 3 || n > largest_size)
      throw UnusableInput("the grid of the dexels must have 3 to 8,200 points along each axis");
  for (const Dexels::Crossing& c : dexels.crossings) {
    bool within = c.axis < 3 && c.t >= 0 && c.t <= 1;
    for (std::size_t a = 0; within && a < 3; ++a) within = c.point[a] + (a == c.axis ? 1u : 0u) < dexels.size[a];
    if (!within) throw UnusableInput("a crossing lies beyond the grid of the dexels");
  }
}

struct Placed {
  std::uint64_t key = 0;  ///< brick, then edge
  std::uint32_t crossing = 0;
  bool operator<(const Placed& other) const { return key < other.key; }
};

EdgeCode edge_of(const Dexels::Crossing& c) {
  return {c.axis, c.point[0] % brick_size, c.point[1] % brick_size, c.point[2] % brick_size, c.leaves};
}

std::vector<Placed> placed(const Dexels& dexels) {
  std::vector<Placed> list(dexels.crossings.size());
  for (std::uint32_t i = 0; i < list.size(); ++i) {
    const Dexels::Crossing& c = dexels.crossings[i];
    const std::uint64_t brick = morton_code(c.point[0] / brick_size, c.point[1] / brick_size, c.point[2] / brick_size);
    list[i] = {brick << 12 | edge_of(c).bits >> 1, i};
  }
  std::sort(list.begin(), list.end());
  for (std::size_t i = 1; i < list.size(); ++i)
    if (list[i].key == list[i - 1].key) throw UnusableInput("an edge of the dexels' grid is crossed twice");
  return list;
}

/// All directions must tell the same inside: that of the rays along x.
void check_agreement(const SampleSet& samples, const ExecutionContext& context) {
  const InsideRuns inside(samples, context);
  const auto [nx, ny, nz] = samples.grid.size;
  std::size_t crossings = 0;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const EdgeCode edge = samples.edge[s];
      std::array<std::int32_t, 3> at{std::int32_t(block.brick[0] * brick_size + edge.i()),
                                     std::int32_t(block.brick[1] * brick_size + edge.j()),
                                     std::int32_t(block.brick[2] * brick_size + edge.k())};
      const bool lower = inside(at[0], at[1], at[2]);
      ++at[edge.axis()];
      if (lower != edge.lower_end_inside() || inside(at[0], at[1], at[2]) == lower)
        throw UnusableInput("the dexels of different directions do not agree on what is inside");
    }
  for (std::int32_t k = 0; k < std::int32_t(nz); ++k)
    for (std::int32_t j = 0; j < std::int32_t(ny); ++j)
      for (std::int32_t i = 0; i < std::int32_t(nx); ++i) {
        const bool in = inside(i, j, k);
        crossings += in != inside(i + 1, j, k);
        crossings += in != inside(i, j + 1, k);
        crossings += in != inside(i, j, k + 1);
        const bool outermost = i == 0 || j == 0 || k == 0 || i + 1 == std::int32_t(nx) || j + 1 == std::int32_t(ny) ||
                               k + 1 == std::int32_t(nz);
        if (in && outermost) throw UnusableInput("the dexels' solid reaches the border of its grid");
      }
  if (crossings != samples.size()) throw UnusableInput("crossings are missing: the dexels bound no solid");
}

}  // namespace

Dexels dexels_of(const SampleSet& samples) {
  Dexels dexels{samples.grid.origin, samples.grid.spacing, samples.grid.size, {}};
  dexels.crossings.reserve(samples.size());
  constexpr double half = brick_size / 2.0;
  for (const SampleBlock& block : samples.blocks)
    for (std::uint32_t s = block.begin; s < block.end; ++s) {
      const EdgeCode edge = samples.edge[s];
      const std::array<unsigned, 3> cell{edge.i(), edge.j(), edge.k()};
      const float along = edge.axis() == 0 ? samples.x[s] : edge.axis() == 1 ? samples.y[s] : samples.z[s];
      Dexels::Crossing c;
      for (std::size_t a = 0; a < 3; ++a)
        c.point[a] = static_cast<std::uint16_t>(block.brick[a] * brick_size + cell[a]);
      c.axis = static_cast<std::uint8_t>(edge.axis());
      c.leaves = edge.lower_end_inside();
      c.t = static_cast<float>(std::clamp(along / samples.grid.spacing + half - cell[edge.axis()], 0.0, 1.0));
      c.normal = samples.normal[s].bits;
      dexels.crossings.push_back(c);
    }
  return dexels;
}

SampleSet samples_of(const Dexels& dexels, const ExecutionContext& context) {
  check(dexels);
  const std::vector<Placed> list = placed(dexels);
  SampleSet set;
  set.grid = {dexels.origin, dexels.spacing, dexels.size};
  resize_samples(set, list.size(), false, context);
  for (std::uint32_t s = 0; s < list.size(); ++s) {
    const Dexels::Crossing& c = dexels.crossings[list[s].crossing];
    const auto brick = morton_decode(list[s].key >> 12);
    if (s == 0 || list[s].key >> 12 != list[s - 1].key >> 12) set.blocks.push_back({s, s, brick, {}});
    SampleBlock& block = set.blocks.back();
    block.end = s + 1;
    Vec3 at{double(c.point[0]), double(c.point[1]), double(c.point[2])};
    at[c.axis] += c.t;
    const Vec3 local = set.grid.point(at.x, at.y, at.z) - set.block_center(block);
    set.x[s] = static_cast<float>(local.x);
    set.y[s] = static_cast<float>(local.y);
    set.z[s] = static_cast<float>(local.z);
    set.edge[s] = edge_of(c);
    set.normal[s] = {c.normal};
    set.area[s] = static_cast<float>(sample_area(unpack_normal({c.normal}), c.axis, dexels.spacing));
  }
  mark_axes(set, context);
  sum_area(set, context);
  check_agreement(set, context);
  return set;
}

Shape shape_from_dexels(const Dexels& dexels, std::string name) {
  const ExecutionContext& context = ExecutionContext::silent();
  const SampleSet samples = samples_of(dexels, context);
  if (samples.size() == 0) throw UnusableInput(name + " has no crossing, so there is no solid");
  return shape_from_mesh(dual_surface(samples, context), std::move(name));
}

}  // namespace evenmesh
