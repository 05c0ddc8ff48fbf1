#pragma once

#include <string>
#include <vector>

#include "hbar/core/model/model.h"

namespace hbar::benchmarks {

/// One rigid body on one hinge, in numbers that hbar and MuJoCo are both given.
struct HingedBody {
  int parent = -1;          ///< body, or −1 for the world
  Eigen::Vector3d axis;     ///< unit                                             [3]
  Eigen::Vector3d offset;   ///< of the hinge from the parent's, m                [3]
  Eigen::Vector3d center;   ///< of mass from the hinge, m                        [3]
  double mass = 0.0;        ///< kg
  Eigen::Vector3d inertia;  ///< principal moments, kg·m²                         [3]
};

/// A mechanism of hinges, each with a motor that takes a torque. Nothing else: no damping, no
/// limits, no contact.
struct HingeModel {
  std::string name;
  std::vector<HingedBody> bodies;  ///< parents first, depth first
  std::vector<int> tips;           ///< bodies that carry an end effector
};

/// A hanging chain of n revolute joints with turning axes.
[[nodiscard]] HingeModel serial_chain(int n);

/// 23 coordinates: three at the wrist, then five fingers of four.
[[nodiscard]] HingeModel hand();

/// The chains of 4, 8, 16, 32, 64 joints and the hand.
[[nodiscard]] std::vector<HingeModel> all_models();

/// The mechanism as hbar sees it.
[[nodiscard]] Model build_model(const HingeModel& hinges);

/// The same as a MuJoCo model description.
///
/// @param h  time step, s
[[nodiscard]] std::string build_mjcf(const HingeModel& hinges, double h);

}  // namespace hbar::benchmarks
