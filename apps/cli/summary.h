#pragma once
/// Figures of a mesh or a run as text for people.

#include <cstddef>
#include <optional>
#include <string>

#include "evenmesh/measure.h"
#include "evenmesh/mesh_shape.h"
#include "evenmesh/points.h"

namespace evenmesh::cli {

/// 1234567 as "1,234,567".
std::string grouped(std::size_t number);

/// "closed, two-manifold, oriented, 1 component, Euler number 2 (genus 0)".
std::string topology(const MeshQuality& quality);

/// A few lines after a run.
std::string summary(const Report& report, const std::string& output, double seconds);

/// The table of `evenmesh info`, for meshes and for points.
std::string table(const MeshQuality& quality, std::size_t self_intersections, std::optional<LengthUnit> unit);
std::string table(const PointCloud& cloud, double spacing);

}  // namespace evenmesh::cli
