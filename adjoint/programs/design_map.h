#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// What a designer may change: the variables d of a DesignMap.
struct DesignVariables {
  std::vector<std::string> names;  ///<                                                    [d]
  std::vector<std::string> units;  ///< in the model's unit system                         [d]
  Eigen::VectorXd start;           ///< where to begin, within the bounds                  [d]
  Eigen::VectorXd lower;           ///< − infinity if there is no bound                    [d]
  Eigen::VectorXd upper;           ///< + infinity if there is no bound                    [d]
  Eigen::VectorXd scale;           ///< typical size > 0 of a change                       [d]

  [[nodiscard]] Eigen::Index size() const { return start.size(); }
};

/// A differentiable map d ↦ p from what a designer changes to a ParameterSet's vector: one length
/// may move a joint, a body, a mass and three moments together.
///
/// Evaluations are pure: any d of the right size may be asked for, in any order.
class DesignMap {
 public:
  DesignMap() = default;
  DesignMap(const DesignMap&) = delete;
  DesignMap& operator=(const DesignMap&) = delete;
  virtual ~DesignMap() = default;

  [[nodiscard]] virtual const DesignVariables& variables() const = 0;
  /// Size of p.
  [[nodiscard]] virtual Eigen::Index parameter_count() const = 0;
  /// The parameters p(d).
  ///
  /// @param d  design variables                                                   [d]
  /// @returns  in the ParameterSet's order                                        [parameters]
  [[nodiscard]] virtual Eigen::VectorXd parameters(const Eigen::VectorXd& d) const = 0;
  /// The derivative dp/dd.
  ///
  /// @param d  design variables                                                   [d]
  /// @returns  one column per design variable                               [parameters x d]
  [[nodiscard]] virtual Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const = 0;
  /// Whether a parameter may change with a variable at all; where not, sparse matrices have no
  /// entry. By default every one may with every one.
  [[nodiscard]] virtual bool depends(Eigen::Index /*parameter*/, Eigen::Index /*variable*/) const {
    return true;
  }
  /// Σ_i y_i ∂²p_i/∂d², which exact Hessians need.
  ///
  /// @param d  design variables                                                   [d]
  /// @param y  weights                                                            [parameters]
  /// @returns  symmetric                                                          [d x d]
  /// @throws InvalidInput if the map has no second derivatives (as this default does)
  [[nodiscard]] virtual Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                                const Eigen::VectorXd& y) const;
};

/// p itself, within the set's bounds.
class IdentityDesignMap final : public DesignMap {
 public:
  explicit IdentityDesignMap(const ParameterSet& set);

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return variables_.size(); }
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override { return d; }
  [[nodiscard]] bool depends(Eigen::Index parameter, Eigen::Index variable) const override {
    return parameter == variable;
  }
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const override;
  /// Zero: the map is linear.
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd&) const override {
    return Eigen::MatrixXd::Zero(d.size(), d.size());
  }

 private:
  DesignVariables variables_;
};

/// p with the principal moments of each body replaced by its second moments of mass
/// s = ∫ (x², y², z²) dm, of which I = (s_y + s_z, s_x + s_z, s_x + s_y): every s > 0 is a body
/// that exists, so that bounds on d alone keep positive moments and the triangle inequality.
class InertiaChart final : public DesignMap {
 public:
  /// @param set          holds all three moments of a body, or none of them
  /// @param least_share  lower bound of s, as a share of the body's largest nominal moment, > 0
  /// @throws InvalidInput if only some of a body's moments are in the set, or the share is not
  ///         positive and below 1/2
  explicit InertiaChart(const ParameterSet& set, double least_share = 1e-3);

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return variables_.size(); }
  [[nodiscard]] bool depends(Eigen::Index parameter, Eigen::Index variable) const override;
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override;
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const override;
  /// Zero: the map is linear.
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd&) const override {
    return Eigen::MatrixXd::Zero(d.size(), d.size());
  }

 private:
  DesignVariables variables_;
  std::vector<Eigen::Index> first_moments_;  // index in p of each body's I_x
};

/// How far a map's Jacobian is from its values, and its Hessian from its Jacobian.
struct DesignMapCheck {
  /// Largest |central difference − derivative| of a parameter by a variable, over the norm of that
  /// parameter's derivatives, variables in units of their scale.
  double gap = 0.0;
  std::string gap_name;  ///< "parameter 3 by length"; empty if gap is 0
  /// Order in ε of p(d + ε δ) − p(d) − ε J δ along a direction that moves every variable: 2 if J is
  /// right; infinite if the remainder is mere rounding, as for a linear map.
  double slope = std::numeric_limits<double>::infinity();
  bool has_hessian = false;  ///< hessian() does not throw; the rest says nothing otherwise
  /// Largest |central difference of Jᵀ y − column of the Hessian|, over the Hessian's norm or 1,
  /// whichever is larger; variables in units of their scale, parameters in units of their
  /// derivatives, of which y weighs each differently.
  double hessian_gap = 0.0;
  std::string hessian_gap_name;  ///< "length and width"; empty if hessian_gap is 0
  /// Order in ε of J(d + ε δ)ᵀ y − J(d)ᵀ y − ε H δ: 2 if H is right; infinite as above.
  double hessian_slope = std::numeric_limits<double>::infinity();
};

/// Compares a map's Jacobian with differences of its values, and its Hessian with differences of
/// its Jacobian.
///
/// @param d  where; steps may leave the bounds by 1e-2 of the variables' scale  [d]
/// @throws InvalidInput if d, parameters(d), jacobian(d) or hessian(d, y) has the wrong size
[[nodiscard]] DesignMapCheck check_design_map(const DesignMap& map, const Eigen::VectorXd& d);

}  // namespace hbar
