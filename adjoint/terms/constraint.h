#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hbar/adjoint/trajectory/trajectory_values.h"
#include "hbar/adjoint/trajectory/value_place.h"

namespace hbar {

class Model;
class ParameterSet;

/// The rows of a constraint term: lower ≤ c ≤ upper; lower = upper is an equation.
struct ConstraintRows {
  std::vector<std::string> names;  ///< for messages                                      [rows]
  Eigen::VectorXd lower;           ///< − infinity if there is no bound                   [rows]
  Eigen::VectorXd upper;           ///< + infinity if there is no bound                   [rows]

  [[nodiscard]] Eigen::Index size() const { return lower.size(); }
};

/// Constraints on a trajectory, with exact partials. The set of numbers they read never changes.
class ConstraintTerm {
 public:
  ConstraintTerm(const ConstraintTerm&) = delete;
  ConstraintTerm& operator=(const ConstraintTerm&) = delete;
  virtual ~ConstraintTerm() = default;

  [[nodiscard]] const ConstraintRows& rows() const { return rows_; }
  /// What the rows read.
  [[nodiscard]] const std::vector<PartialPlace>& places() const { return places_; }
  /// Writes the rows' values c.                                                      [rows]
  virtual void values(const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) const = 0;
  /// Writes the partial derivative of each place's row with respect to its number.  [places]
  virtual void partials(const TrajectoryValues& values,
                        Eigen::Ref<Eigen::VectorXd> partials) const = 0;
  /// The pairs of numbers in which the rows have second partials; none for linear rows (this
  /// default).
  /// @throws InvalidInput if the term has no second partials though its rows are not linear
  [[nodiscard]] virtual std::vector<SecondPlace> second_places() const { return {}; }
  /// Writes the second partial of each of second_places().                  [second places]
  virtual void second_partials(const TrajectoryValues& values,
                               Eigen::Ref<Eigen::VectorXd> second) const;

 protected:
  /// @throws InvalidInput if the rows' sizes differ, a lower bound exceeds an upper one, or a place
  ///         belongs to no row
  ConstraintTerm(ConstraintRows rows, std::vector<PartialPlace> places);

 private:
  ConstraintRows rows_;
  std::vector<PartialPlace> places_;
};

using ConstraintPointer = std::shared_ptr<const ConstraintTerm>;

/// The position of an end effector at the end of a step: target − half_width ≤ v ≤ target +
/// half_width for each of x, y, z. A half width of 0 makes three equations.
///
/// @param end_effector  name
/// @param step          k = 0 … N
/// @param target        in the world, length                                          [3]
/// @param half_width    of the box around the target, length, ≥ 0
/// @throws InvalidInput if the model has no such end effector, or a number is out of range
[[nodiscard]] ConstraintPointer variable_at_step(const Model& model,
                                                 const std::string& end_effector, int step,
                                                 const Eigen::Vector3d& target,
                                                 double half_width = 0.0);

/// Keeps every joint that has limits within them at the ends of the given steps. (The simulation
/// itself models limits by springs, if at all.)
///
/// @param steps   each k = 0 … N
/// @param margin  how far inside the limits to stay, rad or length, ≥ 0
[[nodiscard]] ConstraintPointer joint_limits(const Model& model, const std::vector<int>& steps,
                                             double margin = 0.0);

/// lower ≤ q_coordinate ≤ upper at the ends of the given steps.
///
/// @param coordinate  index
/// @param steps       each k = 0 … N
[[nodiscard]] ConstraintPointer coordinate_limits(const Model& model, int coordinate,
                                                  const std::vector<int>& steps, double lower,
                                                  double upper);

/// Bounds on a weighted sum of design parameters, Σ weight p, such as a total mass.
///
/// @param names    of parameters in the set
/// @param weights  one each; empty: ones
/// @param lower    − infinity if there is none
/// @param upper    + infinity if there is none
/// @throws InvalidInput if the set has no such parameter, or the sizes differ
[[nodiscard]] ConstraintPointer parameter_sum(const ParameterSet& set, const std::string& name,
                                              const std::vector<std::string>& names, double lower,
                                              double upper,
                                              const Eigen::VectorXd& weights = Eigen::VectorXd());

/// Linear rows, c_row = constant_row + Σ weight · number over the row's places.
///
/// @param places     each at most once per row
/// @param weights    one per place                                                  [places]
/// @param constants  empty: zeros                                                     [rows]
/// @throws InvalidInput if the sizes differ, or a weight or constant is not finite
[[nodiscard]] ConstraintPointer linear_constraint(ConstraintRows rows,
                                                  std::vector<PartialPlace> places,
                                                  Eigen::VectorXd weights,
                                                  Eigen::VectorXd constants = Eigen::VectorXd());

/// The second partials of custom rows, and the function that writes them.
struct RowSecondPartials {
  std::vector<SecondPlace> places;
  /// As ConstraintTerm::second_partials; not called if there are no places
  std::function<void(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>)> partials;

  /// Linear rows have none.
  [[nodiscard]] static RowSecondPartials of_linear_rows() { return {}; }
};

/// Custom rows from functions for values and partials (check_constraint_term tells whether they
/// agree). generic_constraint needs only a formula.
///
/// @param places    what the rows read
/// @param values    writes c                                                          [rows]
/// @param partials  writes the partial of each place                                [places]
/// @param second    for exact Hessians; without it second_places() throws InvalidInput
/// @throws InvalidInput if a second place belongs to no row, or there is no function that writes it
[[nodiscard]] ConstraintPointer user_constraint(
    ConstraintRows rows, std::vector<PartialPlace> places,
    std::function<void(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>)> values,
    std::function<void(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>)> partials,
    std::optional<RowSecondPartials> second = std::nullopt);

}  // namespace hbar
