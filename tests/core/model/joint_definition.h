#pragma once

#include <Eigen/Geometry>

#include "hbar/core/model/joint.h"

namespace hbar::testing {

/// The motion Q(q) of a joint, as the scene format defines it, by Eigen's own rotations.
class JointDefinition {
 public:
  explicit JointDefinition(Eigen::VectorXd q) : q_(std::move(q)) {}

  [[nodiscard]] RigidTransform<double> of(const JointKind& kind) const {
    return std::visit([this](const auto& joint) { return motion(joint); }, kind);
  }

 private:
  using Pose = RigidTransform<double>;

  static Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  }
  static Pose turned(const Eigen::Matrix3d& R) { return {R, Eigen::Vector3d::Zero()}; }
  static Pose moved(const Eigen::Vector3d& p) { return {Eigen::Matrix3d::Identity(), p}; }
  [[nodiscard]] Eigen::Matrix3d euler(int first) const {
    return turn(q_[first], Eigen::Vector3d::UnitX()) *
           turn(q_[first + 1], Eigen::Vector3d::UnitY()) *
           turn(q_[first + 2], Eigen::Vector3d::UnitZ());
  }
  [[nodiscard]] Eigen::Matrix3d exponential(int first) const {
    const Eigen::Vector3d r = q_.segment<3>(first);
    return r.norm() > 0.0 ? turn(r.norm(), r.normalized()) : Eigen::Matrix3d::Identity();
  }

  [[nodiscard]] Pose motion(const FixedJoint&) const { return {}; }
  [[nodiscard]] Pose motion(const RevoluteJoint& j) const { return turned(turn(q_[0], j.axis)); }
  [[nodiscard]] Pose motion(const PrismaticJoint& j) const { return moved(q_[0] * j.axis); }
  [[nodiscard]] Pose motion(const PlanarJoint& j) const {
    return moved(q_[0] * j.axis0 + q_[1] * j.axis1);
  }
  [[nodiscard]] Pose motion(const TranslationalJoint&) const { return moved(q_); }
  [[nodiscard]] Pose motion(const Free2dJoint&) const {
    return {turn(q_[2], Eigen::Vector3d::UnitZ()), {q_[0], q_[1], 0.0}};
  }
  [[nodiscard]] Pose motion(const SphericalEulerJoint&) const { return turned(euler(0)); }
  [[nodiscard]] Pose motion(const SphericalExpJoint&) const { return turned(exponential(0)); }
  [[nodiscard]] Pose motion(const Free3dEulerJoint&) const { return {euler(3), q_.head<3>()}; }
  [[nodiscard]] Pose motion(const Free3dExpJoint&) const { return {exponential(3), q_.head<3>()}; }
  [[nodiscard]] Pose motion(const UniversalJoint& j) const {
    return turned(turn(q_[0], j.axis0) * turn(q_[1], j.axis1));
  }

  Eigen::VectorXd q_;
};

}  // namespace hbar::testing
