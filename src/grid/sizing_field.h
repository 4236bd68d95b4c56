#pragma once
/// How long edges shall be.

#include "evenmesh/shape.h"

namespace evenmesh {

/// Mean edge length of an even mesh with n vertices on an area: √(2·area / (√3·n)), and back. Model units.
double edge_length_of(double area, double vertices);
double vertices_of(double area, double edge_length);

/// The wanted edge length at every point of a surface, model units.
///
/// A density of n vertices per area means edges ∝ n^-½; cells of equal mass with the weight edge⁻⁴ have it [NBEDT
/// §3.3]. Callable from several threads at once.
class SizingField {
 public:
  SizingField() = default;
  /// The same everywhere.
  explicit SizingField(double edge) : mean_(edge) {}
  /// @param edge          where the density is the mean one
  /// @param mean_density  over the surface, by area
  SizingField(double edge, Density density, double mean_density)
      : mean_(edge), density_(std::move(density)), mean_density_(mean_density) {}

  /// @pre  p is near the surface
  double edge(const Vec3& p) const;
  double mean() const { return mean_; }
  bool uniform() const { return !density_; }
  /// The same pattern for edges of another mean length.
  SizingField with_mean(double edge) const { return {edge, density_, mean_density_}; }

 private:
  double mean_ = 0;
  Density density_;
  double mean_density_ = 1;
};

}  // namespace evenmesh
