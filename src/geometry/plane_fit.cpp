#include "geometry/plane_fit.h"

#include <Eigen/Eigenvalues>

namespace evenmesh {

PlaneFit::Plane PlaneFit::plane() const {
  const Vec3 mean = moment_ / weight_;
  const double xx = a_[0] / weight_ - mean.x * mean.x, yx = a_[1] / weight_ - mean.y * mean.x;
  const double zx = a_[2] / weight_ - mean.z * mean.x, yy = a_[3] / weight_ - mean.y * mean.y;
  const double zy = a_[4] / weight_ - mean.z * mean.y, zz = a_[5] / weight_ - mean.z * mean.z;
  Eigen::Matrix3d covariance;
  covariance << xx, yx, zx, yx, yy, zy, zx, zy, zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d n = solver.eigenvectors().col(0), values = solver.eigenvalues();
  return {{n[0], n[1], n[2]}, {values[0], values[1], values[2]}};
}

}  // namespace evenmesh
