#pragma once
/// What every mesh that mesh_shape() returns must be.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "evenmesh/mesh_shape.h"
#include "geometry/primitives.h"

namespace evenmesh {

inline MeshResult meshed(const Shape& shape, const MeshOptions& options, unsigned threads = 2) {
  ExecutionContext context(threads);
  return mesh_shape(shape, options, context);
}

inline bool has_finding(const Report& report, FindingCode code) {
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& f) { return f.code == code; });
}

inline bool breaks_a_promise(const Report& report) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [](const Finding& f) { return f.severity == Severity::broken_promise; });
}

/// Closed, two-manifold, oriented outward, not through itself, and the report tells the same.
inline void expect_good_mesh(const MeshResult& result) {
  const MeshQuality q = measure_quality(result.mesh);
  EXPECT_TRUE(q.closed());
  EXPECT_TRUE(q.two_manifold());
  EXPECT_TRUE(q.oriented());
  EXPECT_GT(q.volume, 0);
  EXPECT_EQ(q.unused_vertices, 0u);
  EXPECT_EQ(q.degenerate_faces, 0u);
  EXPECT_TRUE(self_intersections(result.mesh).empty());

  const Report& report = result.report;
  EXPECT_EQ(report.self_intersections, 0u);
  EXPECT_EQ(report.quality.faces, q.faces);
  EXPECT_EQ(report.quality.euler, q.euler);
  EXPECT_EQ(report.quality.volume, q.volume);
  EXPECT_EQ(report.seeds, result.mesh.vertices.size());
  EXPECT_EQ(report.evaluations, report.energies.size());
  EXPECT_NEAR(report.alpha, static_cast<double>(report.samples) / static_cast<double>(report.seeds),
              1e-9 * report.alpha);
  EXPECT_GT(report.peak_memory_bytes, 0u);
  EXPECT_FALSE(report.seconds.empty());
  for (const Finding& finding : report.findings) {
    EXPECT_NE(finding.severity, Severity::broken_promise) << finding.sentence;
    EXPECT_FALSE(finding.sentence.empty());
  }
}

/// The count asked for within 0.5 %, or a finding that says otherwise.
inline void expect_count(const MeshResult& result, std::size_t asked) {
  EXPECT_EQ(result.report.seeds_asked, asked);
  const double made = static_cast<double>(result.mesh.vertices.size()), wanted = static_cast<double>(asked);
  if (std::abs(made - wanted) <= 0.005 * wanted) return;
  EXPECT_TRUE(has_finding(result.report, FindingCode::vertex_count)) << made << " instead of " << wanted;
}

inline bool same_mesh(const Mesh& a, const Mesh& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(Vec3)) == 0;
}

}  // namespace evenmesh
