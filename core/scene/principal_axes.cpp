#include "hbar/core/scene/principal_axes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "hbar/core/base/error.h"

namespace hbar::scene {
PrincipalAxes principal_axes(const Eigen::Matrix3d& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  PrincipalAxes result{solver.eigenvalues(), solver.eigenvectors()};
  for (int i = 0; i < 2; ++i) {
    Eigen::Index largest = 0;
    result.axes.col(i).cwiseAbs().maxCoeff(&largest);
    if (result.axes(largest, i) < 0.0) {
      result.axes.col(i) *= -1.0;
    }
  }
  result.axes.col(2) = result.axes.col(0).cross(result.axes.col(1)).normalized();
  return result;
}

Eigen::Matrix3d symmetric_matrix(const std::vector<double>& entries) {
  if (entries.size() != 6) {
    throw InvalidInput(concat("symmetric_matrix: got ", entries.size(),
                              " numbers; it takes the 6 numbers xx xy xz yy yz zz"));
  }
  Eigen::Matrix3d matrix;
  matrix << entries[0], entries[1], entries[2],  //
      entries[1], entries[3], entries[4],        //
      entries[2], entries[4], entries[5];
  return matrix;
}

}  // namespace hbar::scene
