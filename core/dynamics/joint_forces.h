#pragma once

#include "hbar/core/model/mechanism.h"

namespace hbar {

/// The state at the start of a step, which explicit position motors read.
template <Scalar S>
struct StepStart {
  VectorX<S> q;     ///< rad or length                                            [dof]
  VectorX<S> qdot;  ///<                                                          [dof]
};

/// Generalised force of a motor on one coordinate, and its derivatives.
template <Scalar S>
struct MotorForce {
  S tau = S(0.0);      ///< torque or force
  S by_u = S(0.0);     ///< by the control
  S by_q = S(0.0);     ///< by the coordinate that it reads
  S by_qdot = S(0.0);  ///< by that coordinate's rate
  S by_P = S(0.0);     ///< by the motor's P
  S by_D = S(0.0);     ///< by the motor's D
};

/// @param motor    which motor of the model
/// @param u        the motor's control for the coordinate
/// @param q, qdot  the coordinate and its rate, as the motor reads them
///
/// At a kink the derivatives are those described at compute_joint_forces.
template <Scalar S>
[[nodiscard]] MotorForce<S> motor_force(const Model& model, const Mechanism<S>& mechanism,
                                        int motor, const S& u, const S& q, const S& qdot);

/// Generalised forces that act coordinate by coordinate, and their derivatives: joint springs,
/// dampers, limit springs (f̃_r of (2)) and motors (u of (2)). Every derivative with respect to a
/// state is diagonal; every control acts on one coordinate.
template <Scalar S>
struct JointForces {
  explicit JointForces(const Model& model);

  VectorX<S> tau;            ///< torque or force                                [dof]
  VectorX<S> by_q;           ///< ∂τ_c/∂q_c                                      [dof]
  VectorX<S> by_qdot;        ///< ∂τ_c/∂q̇_c                                      [dof]
  VectorX<S> by_start_q;     ///< ∂τ_c/∂q_c at the step's start                  [dof]
  VectorX<S> by_start_qdot;  ///< ∂τ_c/∂q̇_c at the step's start                  [dof]
  VectorX<S> by_u;           ///< ∂τ of control i's coordinate by u_i            [controls]
  VectorX<S> by_P;           ///< ∂τ of control i's coordinate by its motor's P  [controls]
  VectorX<S> by_D;           ///< ∂τ of control i's coordinate by its motor's D  [controls]
  VectorX<S> by_stiffness;   ///< ∂τ_c by the stiffness of c's joint             [dof]
  VectorX<S> by_damping;     ///< ∂τ_c by the damping of c's joint               [dof]
};

/// @param u      controls of the step                                            [controls]
/// @param start  state at the step's start
///
/// Allocates nothing. At a kink (limit reached, motor saturated) the derivative is one-sided, from
/// the side whose interval includes the kink: the inner one at |u| = 1 and at the end of the
/// motor's range.
template <Scalar S>
void compute_joint_forces(const Model& model, const Mechanism<S>& mechanism, const VectorView<S>& q,
                          const VectorView<S>& qdot, const VectorView<S>& u,
                          const StepStart<S>& start, JointForces<S>& forces);

/// The coordinate that a control drives.
[[nodiscard]] int coordinate_of_control(const Model& model, int motor, int control);

}  // namespace hbar
