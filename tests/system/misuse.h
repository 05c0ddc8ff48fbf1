#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model_builder.h"

// What the tests of misuse combine wrongly: two chains, a horizon and a program of one of them.
namespace hbar::testing::misuse {

[[nodiscard]] inline Model chain(int links, const char* name, double density = 800.0) {
  ModelBuilder builder(name);
  builder.set_gravity({0.0, 0.0, -9.81});
  int parent = -1;
  for (int i = 0; i < links; ++i) {
    Joint joint{.name = concat("j", i), .kind = RevoluteJoint{{0.0, 1.0, 0.0}}};
    joint.X_PJ.p = {0.0, 0.0, i > 0 ? -0.5 : 0.0};
    joint.damping = 0.1;
    parent = builder.add_link(
        parent, joint,
        solid_body(concat("b", i), Cuboid{{0.05, 0.05, 0.5}}, density, {.p = {0.0, 0.0, -0.25}}));
    builder.add_motor({.link = parent, .lower = -5.0, .upper = 5.0});
  }
  builder.add_end_effector({.name = "tip", .link = parent, .position = {0.0, 0.0, -0.5}});
  return builder.build();
}

[[nodiscard]] inline const Model& two() {
  static const Model model = chain(2, "two");
  return model;
}
[[nodiscard]] inline const Model& three() {
  static const Model model = chain(3, "three");
  return model;
}
[[nodiscard]] inline SimulationOptions options(double h = 0.01, int steps = 20) {
  return {.integrator = "bdf2", .h = h, .steps = steps};
}
[[nodiscard]] inline ParameterSet set_of_two() {
  return ParameterSet::named(two(), {"body.b0.mass", "joint.j1.damping"});
}
[[nodiscard]] inline Horizon horizon() { return Horizon(two(), set_of_two(), options()); }
[[nodiscard]] inline Inputs inputs(const Horizon& of) {
  Inputs out = of.nominal_inputs();
  out.q0.setConstant(0.3);
  out.u.setConstant(0.1);
  return out;
}
[[nodiscard]] inline Trajectory trajectory(const Horizon& of) {
  return simulate(of, inputs(of)).trajectory();
}
[[nodiscard]] inline Objective objective() { return Objective(squared_final_position()); }
/// A simulation that fails at its first step.
[[nodiscard]] inline Rollout failed() {
  SimulationOptions hasty = options(0.5);
  hasty.newton.max_iter = 1;
  hasty.max_halvings = 0;
  const Horizon of(two(), set_of_two(), hasty);
  Inputs fast = inputs(of);
  fast.qdot0.setConstant(30.0);
  return simulate(of, fast);
}
[[nodiscard]] inline TrajectoryProblem problem() {
  return {.horizon = horizon(), .map = parameter_map(set_of_two()), .objective = objective()};
}

struct Misuse {
  std::string name;
  std::function<void()> call;
  std::string message;  // part of it
};
inline void PrintTo(const Misuse& misuse, std::ostream* out) { *out << misuse.name; }

}  // namespace hbar::testing::misuse
