#pragma once

#include <Eigen/Geometry>
#include <random>

namespace hbar::testing {

/// Random numbers that are the same for the same seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double between(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  /// Entries in [−size, size].
  Eigen::VectorXd vector(Eigen::Index n, double size = 1.0) {
    Eigen::VectorXd v(n);
    for (double& entry : v) {
      entry = between(-size, size);
    }
    return v;
  }
  Eigen::Vector3d vector3(double size = 1.0) { return vector(3, size); }
  Eigen::MatrixXd matrix(Eigen::Index rows, Eigen::Index columns) {
    return vector(rows * columns).reshaped(rows, columns);
  }
  /// A unit vector.
  Eigen::Vector3d direction() {
    Eigen::Vector3d v = vector3();
    while (v.norm() < 0.1) {
      v = vector3();
    }
    return v.normalized();
  }
  Eigen::Matrix3d rotation() {
    const double angle = between(-3.0, 3.0);
    return Eigen::AngleAxisd(angle, direction()).toRotationMatrix();
  }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

}  // namespace hbar::testing
