#include "grid/sizing_field.h"

#include <cmath>
#include <numbers>

namespace evenmesh {

double edge_length_of(double area, double vertices) {
  return std::sqrt(2 * area / (std::numbers::sqrt3 * vertices));
}
double vertices_of(double area, double edge_length) {
  return 2 * area / (std::numbers::sqrt3 * edge_length * edge_length);
}

double SizingField::edge(const Vec3& p) const {
  return density_ ? mean_ * std::sqrt(mean_density_ / density_(p)) : mean_;
}

}  // namespace evenmesh
