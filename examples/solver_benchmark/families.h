#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/model/model.h"

namespace hbar::solver_benchmark {

/// A kind of mechanism that exists for every number of joints.
struct Family {
  std::string name;
  std::string sentence;  ///< what it is, for help texts
  int smallest = 1;      ///< number of joints
  double h = 0.01;       ///< a time step that suits it, s
  double q0 = 0.0;       ///< amplitude of the joints' angles at the start, rad
  double torque = 0.0;   ///< amplitude of the motors' torques, N·m
  Model (*make)(int) = nullptr;
};

/// chain, tree, hand.
[[nodiscard]] const std::vector<Family>& families();

/// @throws InvalidInput listing the known families
[[nodiscard]] const Family& find_family(std::string_view name);

/// The mechanism of a family with n motorised, damped revolute joints, in metres and kilograms.
///
/// @throws InvalidInput if n is smaller than the family allows
[[nodiscard]] Model make_model(const Family& family, int joints);

/// A sustained motion: controls oscillate gently, each out of phase with the next.
///
/// @param inputs     of the model's horizon; q0 and u are set
/// @param amplitude  of the controls
void set_swinging_controls(Inputs& inputs, double amplitude);

/// The start of a family's motion.
///
/// @param inputs  of a horizon of make_model(family, …); q0, qdot0 and u are set
void set_gentle_motion(const Family& family, const Model& model, Inputs& inputs);

}  // namespace hbar::solver_benchmark
