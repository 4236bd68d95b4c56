#pragma once
/// Invariants of sample sets, shared by the tests of this folder.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "grid/morton.h"
#include "sample/sample.h"

namespace evenmesh {

inline Shape solid_of(const Mesh& mesh) {
  return {"test", mesh.bounds(), std::make_shared<const Mesh>(mesh), false};
}

inline SampleSet sampled(const Mesh& mesh, std::size_t resolution, unsigned threads = 1) {
  ExecutionContext context(threads);
  const Shape shape = solid_of(mesh);
  return sample_shape(shape, make_grid(shape.bounds, resolution), context);
}

inline SampleSet sampled(const Shape& shape, std::size_t resolution, unsigned threads = 2) {
  ExecutionContext context(threads);
  return sample_shape(shape, make_grid(shape.bounds, resolution), context);
}

struct EdgeOf {
  unsigned axis;
  std::array<std::size_t, 3> at;
};

/// Grid edge of sample i of block b.
inline EdgeOf edge_of(const SampleSet& set, const SampleBlock& b, std::size_t i) {
  const EdgeCode e = set.edge[i];
  return {e.axis(), {b.brick[0] * 8u + e.i(), b.brick[1] * 8u + e.j(), b.brick[2] * 8u + e.k()}};
}

/// Inside of every grid point as the crossings of one axis imply it; also checks that they enter and leave in turn.
inline std::vector<bool> signs_of(const SampleSet& set, unsigned axis) {
  const auto& n = set.grid.size;
  const std::array<std::size_t, 3> stride{1, n[0], std::size_t{n[0]} * n[1]};
  std::vector<std::uint8_t> change(stride[2] * n[2]);
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const EdgeOf e = edge_of(set, b, i);
      if (e.axis != axis) continue;
      std::uint8_t& c = change[e.at[0] * stride[0] + e.at[1] * stride[1] + e.at[2] * stride[2]];
      EXPECT_EQ(c, 0) << "two samples on one edge";
      c = set.edge[i].lower_end_inside() ? 2 : 1;
    }
  std::vector<bool> inside(change.size());
  std::size_t out_of_turn = 0, outermost = 0;
  for (std::size_t p = 0; p < change.size(); ++p) {
    const std::size_t w = p / stride[axis] % n[axis];
    if (w == 0) continue;
    const bool before = inside[p - stride[axis]];
    const std::uint8_t c = change[p - stride[axis]];
    inside[p] = before != (c != 0);
    if (c != 0 && (c == 2) != before) ++out_of_turn;
    if (inside[p])
      for (unsigned a = 0; a < 3; ++a) {
        const std::size_t i = p / stride[a] % n[a];
        if (i == 0 || i + 1 == n[a]) ++outermost;
      }
  }
  EXPECT_EQ(out_of_turn, 0u) << "axis " << axis;
  EXPECT_EQ(outermost, 0u) << "axis " << axis;
  return inside;
}

/// All three directions imply one and the same sign grid; returns it.
inline std::vector<bool> expect_one_sign_grid(const SampleSet& set) {
  const std::vector<bool> x = signs_of(set, 0), y = signs_of(set, 1), z = signs_of(set, 2);
  EXPECT_TRUE(x == y);
  EXPECT_TRUE(x == z);
  return x;
}

inline double volume_of(const SampleSet& set, const std::vector<bool>& inside) {
  double count = 0;
  for (const bool b : inside) count += b;
  return count * set.grid.spacing * set.grid.spacing * set.grid.spacing;
}

inline Vec3 position(const SampleSet& set, const SampleBlock& b, std::size_t i) {
  return set.block_center(b) + Vec3{set.x[i], set.y[i], set.z[i]};
}

/// Arrays of one length, blocks sorted and complete, codes sorted, positions on their edges, weights as documented.
inline void expect_well_formed(const SampleSet& set) {
  const std::size_t n = set.size();
  ASSERT_EQ(set.y.size(), n);
  ASSERT_EQ(set.z.size(), n);
  ASSERT_EQ(set.area.size(), n);
  ASSERT_EQ(set.normal.size(), n);
  ASSERT_EQ(set.edge.size(), n);
  ASSERT_FALSE(set.blocks.empty());
  std::uint32_t next = 0;
  std::uint64_t last_code = 0;
  double area = 0;
  std::size_t off_axis = 0, off_edge = 0, against = 0, weights = 0, unsorted = 0;
  const double h = set.grid.spacing;
  for (std::size_t k = 0; k < set.blocks.size(); ++k) {
    const SampleBlock& b = set.blocks[k];
    ASSERT_EQ(b.begin, next);
    ASSERT_LT(b.begin, b.end);
    next = b.end;
    const std::uint64_t code = morton_code(b.brick[0], b.brick[1], b.brick[2]);
    ASSERT_TRUE(k == 0 || last_code < code);
    last_code = code;
    for (int a = 0; a < 3; ++a)
      for (std::uint32_t i = b.begin_of_axis(a); i < b.end_of_axis(a); ++i)
        if (static_cast<int>(set.edge[i].axis()) != a) ++off_axis;
    for (std::size_t i = b.begin; i < b.end; ++i) {
      if (i > b.begin && set.edge[i - 1].bits >> 1 >= set.edge[i].bits >> 1) ++unsorted;
      const EdgeOf e = edge_of(set, b, i);
      const Vec3 p = (position(set, b, i) - set.grid.origin) / h;
      for (unsigned a = 0; a < 3; ++a) {
        const double along = p[static_cast<int>(a)] - static_cast<double>(e.at[a]);
        if (along < -1e-3 || along > (a == e.axis ? 1 + 1e-3 : 1e-3)) ++off_edge;
      }
      const Vec3 normal = unpack_normal(set.normal[i]);
      const double outward = normal[static_cast<int>(e.axis)] * (set.edge[i].lower_end_inside() ? 1 : -1);
      if (outward < -1e-3) ++against;
      const double weight = sample_area(normal, static_cast<int>(e.axis), h);
      if (std::abs(set.area[i] - weight) > 1e-4 * h * h) ++weights;
      area += set.area[i];
    }
  }
  EXPECT_EQ(next, n);
  EXPECT_EQ(unsorted, 0u);
  EXPECT_EQ(off_axis, 0u);
  EXPECT_EQ(off_edge, 0u);
  EXPECT_LE(against, n / 1000);
  EXPECT_EQ(weights, 0u);
  EXPECT_NEAR(set.total_area, area, 1e-6 * area);
  if (set.even()) {
    EXPECT_EQ(set.total_weight, set.total_area);
  }
}

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expect_same(const SampleSet& a, const SampleSet& b) {
  const auto same_block = [](const SampleBlock& u, const SampleBlock& v) {
    return u.begin == v.begin && u.end == v.end && u.brick == v.brick && u.axis_begin == v.axis_begin;
  };
  EXPECT_TRUE(std::equal(a.blocks.begin(), a.blocks.end(), b.blocks.begin(), b.blocks.end(), same_block));
  std::size_t columns = 0;
  for_each_column([&](const auto& u, const auto& v) { EXPECT_TRUE(same_bytes(u, v)) << "column " << columns++; }, a, b);
  EXPECT_EQ(a.total_area, b.total_area);
  EXPECT_EQ(a.total_weight, b.total_weight);
  EXPECT_EQ(a.disagreements, b.disagreements);
  EXPECT_EQ(a.unresolved, b.unresolved);
}

using Edges = std::map<std::tuple<unsigned, std::size_t, std::size_t, std::size_t>, Vec3>;

inline Edges edges_of(const SampleSet& set) {
  Edges edges;
  for (const SampleBlock& b : set.blocks)
    for (std::size_t i = b.begin; i < b.end; ++i) {
      const EdgeOf e = edge_of(set, b, i);
      edges[{e.axis, e.at[0], e.at[1], e.at[2]}] = position(set, b, i);
    }
  return edges;
}

/// The same surface up to rounding: samples on the same edges, no farther apart than so many cells, except few.
/// @param few  share of the samples
inline void expect_near(const SampleSet& one, const SampleSet& other, double cells = 1e-3, double few = 0) {
  const Edges a = edges_of(one), b = edges_of(other);
  std::size_t shared = 0, apart = 0;
  for (const auto& [edge, p] : a) {
    const auto found = b.find(edge);
    if (found == b.end()) continue;
    ++shared;
    apart += norm(p - found->second) > cells * one.grid.spacing;
  }
  EXPECT_GE(double(shared), 0.999 * double(std::max(a.size(), b.size())));
  EXPECT_LE(double(apart), few * double(shared));
}

}  // namespace evenmesh
