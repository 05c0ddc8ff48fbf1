#pragma once

#include <array>
#include <string>

#include "hbar/adjoint/programs/design_map.h"

namespace hbar::walker {

/// A part of a leg: a capsule along −y of its joint, from there to the next joint.
struct Segment {
  std::string name;        ///< "thigh", "shank"
  std::string next_joint;  ///< "knee", "foot": the joint at its end
};

/// Thigh and shank, each of which is there as left_… and right_….
[[nodiscard]] const std::array<Segment, 2>& segments();

/// What the lengths of thighs and shanks decide: capsules, the bodies' places and the next joints.
[[nodiscard]] ParameterSet leg_parameters(const Model& model);

/// d = (length of the thighs, length of the shanks) onto leg_parameters, the same for both legs: a
/// length l stretches its capsules (and with them masses and moments), moves the bodies by half and
/// the next joints by all of the change. Affine.
class LegMap final : public DesignMap {
 public:
  /// @param share  how much shorter or longer than the scene's a segment may get, 0 … 1; 0 holds
  ///               the lengths
  /// @throws InvalidInput if a segment is no capsule, or the legs differ
  LegMap(const Model& model, const ParameterSet& set, double share);

  /// Lets an optimisation begin at other lengths than the scene's; held lengths are held there.
  void begin_at(const Eigen::Vector2d& lengths);

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return base_.size(); }
  [[nodiscard]] bool depends(Eigen::Index parameter, Eigen::Index variable) const override {
    return slope_(parameter, variable) != 0.0;
  }
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override {
    return base_ + slope_ * (d - nominal_);
  }
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd&) const override { return slope_; }
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd&) const override {
    return Eigen::MatrixXd::Zero(d.size(), d.size());
  }

 private:
  DesignVariables variables_;
  Eigen::VectorXd nominal_;  // the scene's lengths
  Eigen::VectorXd base_;     // p of the scene's lengths
  Eigen::MatrixXd slope_;    // dp/dd
};

}  // namespace hbar::walker
