#include "geometry/quadric.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace evenmesh {
namespace {

constexpr double smallest_share = 0.01;  ///< of the largest eigenvalue: below, planes hardly differ

Eigen::Matrix3d symmetric(const std::array<double, 6>& a) {
  Eigen::Matrix3d m;
  m << a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5];
  return m;
}

Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(const Eigen::Matrix3d& a) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(a);
  return solver;
}

}  // namespace

void Quadric::add(const Quadric& other) {
  weight_ += other.weight_;
  moment_ += other.moment_;
  b_ += other.b_;
  for (std::size_t i = 0; i < 6; ++i) a_[i] += other.a_[i];
}

Vec3 Quadric::minimum() const {
  const Eigen::Vector3d x = symmetric(a_).ldlt().solve(Eigen::Vector3d(b_.x, b_.y, b_.z));
  return {x.x(), x.y(), x.z()};
}

Vec3 Quadric::minimum(int least, int most) const {
  const Eigen::Matrix3d a = symmetric(a_);
  const Vec3 m = mean();
  const Eigen::Vector3d at(m.x, m.y, m.z), residual = Eigen::Vector3d(b_.x, b_.y, b_.z) - a * at;
  const auto solver = solved(a);
  const auto& values = solver.eigenvalues();
  Eigen::Vector3d x = at;
  for (int rank = 0; rank < most; ++rank) {
    const int i = 2 - rank;  // ascending
    if (!(values[i] > (rank < least ? 1e-6 : smallest_share) * values[2])) break;
    x += solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(residual) / values[i]);
  }
  return {x.x(), x.y(), x.z()};
}

int Quadric::rank() const {
  const Eigen::Vector3d values = solved(symmetric(a_)).eigenvalues();
  return static_cast<int>((values.array() > smallest_share * values[2]).count());
}

}  // namespace evenmesh
