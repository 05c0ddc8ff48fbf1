#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/programs/design_map.h"

namespace hbar::manipulation {

/// A phalanx whose length may change: a capsule that reaches from its own joint to the next one.
struct Phalanx {
  std::string body;
  std::string next_joint;  ///< empty for the last one
};

/// Parameters that stay as they are set here.
struct FixedParameter {
  std::string name;
  double value = 0.0;
};

/// The parameters that the lengths of phalanges decide, and the fixed ones.
[[nodiscard]] ParameterSet length_parameters(const Model& model,
                                             const std::vector<Phalanx>& phalanges,
                                             const std::vector<FixedParameter>& fixed);

/// Lengths of phalanges onto length_parameters: a length l stretches its capsule (and with it the
/// contact points, the mass and the moments), moves the body by half and the next joint by all of
/// the change. Affine.
class LengthMap final : public DesignMap {
 public:
  /// @param share  how much shorter or longer than the scene's a phalanx may get, < 1
  /// @throws InvalidInput if a body is no capsule, or none of the names exists
  LengthMap(const Model& model, const std::vector<Phalanx>& phalanges,
            const std::vector<FixedParameter>& fixed, const ParameterSet& set, double share);

  /// Lets an optimisation begin at other lengths than the scene's.
  void begin_at(const Eigen::VectorXd& lengths) { variables_.start = lengths; }

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return base_.size(); }
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

}  // namespace hbar::manipulation
