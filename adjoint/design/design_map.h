#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

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

/// One design variable, in the form in which a user writes it.
struct DesignVariable {
  std::string name;
  std::string unit = {};  ///< in the model's unit system
  double start = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// Typical size > 0 of a change; 0: a quarter of the range between the bounds or, if one of them
  /// is infinite, |start|, or 1 if that is 0.
  double scale = 0.0;
};

/// @throws InvalidInput naming the variable if a name is empty or taken, a number is not finite
///         (bounds may be infinite), the start is not within the bounds, or the scale is negative
[[nodiscard]] DesignVariables design_variables(const std::vector<DesignVariable>& variables);

/// A differentiable map d ↦ p from what a designer changes to a ParameterSet's vector: one length
/// may change a joint, a body, a mass and three moments at once.
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
  /// Names of the parameters, in their order, where the map knows them; a program refuses a map of
  /// others than its own. Empty (as this default) where it does not.
  [[nodiscard]] virtual std::vector<std::string> parameter_names() const { return {}; }
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
  /// Whether a parameter can depend on a variable at all; where it cannot, sparse matrices have no
  /// entry. By default every parameter depends on every variable.
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

using DesignMapPointer = std::shared_ptr<const DesignMap>;

}  // namespace hbar
