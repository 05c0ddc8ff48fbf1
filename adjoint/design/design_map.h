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

/// One of them, as it is written down.
struct DesignVariable {
  std::string name;
  std::string unit = {};  ///< in the model's unit system
  double start = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double scale = 0.0;  ///< typical size > 0 of a change; 0: a quarter of what the bounds leave, or
                       ///< where one is open, |start|, or 1 where that is 0
};

/// @throws InvalidInput naming the variable if a name is empty or taken, a number is not finite
///         (bounds may be infinite), the start is not within the bounds, or the scale is negative
[[nodiscard]] DesignVariables design_variables(const std::vector<DesignVariable>& variables);

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

using DesignMapPointer = std::shared_ptr<const DesignMap>;

}  // namespace hbar
