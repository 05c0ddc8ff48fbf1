#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/terms/constraint.h"

namespace hbar {

// Linear rows over the numbers of a trajectory, most of them bounds on single numbers. Since
// measurements are among the values, limits on grip, clearance, torque and power are such bounds
// too. Where both bounds are infinite there is no row.

/// Steps first … last, each `stride` after the one before.
[[nodiscard]] std::vector<int> step_range(int first, int last, int stride = 1);

/// lower ≤ x_k ≤ upper for a number x of a trajectory, along a path or at its end. Rows are named
/// "NAME at step K".
///
/// @param name   of x, for messages
/// @param field  member of the values that holds x; kP has no steps and gives one row, "NAME"
/// @param index  row of the member
/// @param steps  each k = 0 … N (of kU: 0 … N − 1)
/// @throws InvalidInput if an index or a step is negative, or lower exceeds upper
[[nodiscard]] ConstraintPointer value_limits(const std::string& name, ValueField field, int index,
                                             const std::vector<int>& steps, double lower,
                                             double upper);

/// lower ≤ q̇_coordinate ≤ upper at the ends of the given steps: "hinge rate at step 12".
///
/// @param coordinate    index
/// @param lower, upper  rad or length, over time
[[nodiscard]] ConstraintPointer rate_limits(const Model& model, int coordinate,
                                            const std::vector<int>& steps, double lower,
                                            double upper);

/// The path of an end effector stays in a box: "tip.x at step 12".
///
/// @param end_effector  name
/// @param steps         each k = 0 … N
/// @param lower, upper  corners in the world, length                                     [3]
/// @throws InvalidInput if the model has no such end effector, or lower exceeds upper
[[nodiscard]] ConstraintPointer variable_limits(const Model& model, const std::string& end_effector,
                                                const std::vector<int>& steps,
                                                const Eigen::Vector3d& lower,
                                                const Eigen::Vector3d& upper);

/// |u_k − u_{k−1}| ≤ change for k = 1 … N − 1: "hinge change at step 12".
///
/// @param steps   N
/// @param change  ≥ 0, one per control or one for all; infinity if there is none [controls or 1]
[[nodiscard]] ConstraintPointer control_rate(const Model& model, int steps,
                                             const Eigen::VectorXd& change);

/// The end repeats the start: q_N − q_0 = advance and q̇_N − q̇_0 = 0: "hinge period", "hinge rate
/// period". Coordinates are compared as numbers: a rotation that has changed its chart
/// (doc/integrators.md) within the period does not count as equal.
///
/// @param steps        N
/// @param coordinates  indices; empty: all
/// @param advance      such as the length of a step forward; empty: zeros     [coordinates]
[[nodiscard]] ConstraintPointer periodicity(const Model& model, int steps,
                                            std::vector<int> coordinates = {},
                                            const Eigen::VectorXd& advance = Eigen::VectorXd());

/// p_a = ratio p_b + offset, for example for two equal limbs.
///
/// @param a, b    names of two parameters in the set
/// @param offset  in a's unit
[[nodiscard]] ConstraintPointer parameter_tie(const ParameterSet& set, const std::string& a,
                                              double ratio, const std::string& b,
                                              double offset = 0.0);

/// lower ≤ the mass of all bodies ≤ upper; bodies whose mass is not in the set count with the
/// model's own mass.
///
/// @throws InvalidInput if the set contains no mass, or contains a size, on which masses depend
///         nonlinearly
[[nodiscard]] ConstraintPointer total_mass(const ParameterSet& set, const Model& model,
                                           double lower, double upper);

}  // namespace hbar
