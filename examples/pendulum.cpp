// The shortest program: a pendulum is built, simulated, differentiated, and its gradient checked.
//
//   cmake --build build/release --target pendulum && build/release/examples/pendulum
//
// prints how far the rod has swung after a second and what that distance depends on:
//
//   angle after 1 s: -1.043647 rad
//   objective 1/2 angle^2: 0.544599
//   d objective / d initial angle:         1.102869
//   d objective / d initial rate:          0.103964
//   d objective / d body.rod.mass:        -0.051308
//   d objective / d joint.hinge.damping:  -0.865021
//   gradient confirmed: yes
#include <cstdio>

#include "hbar/hbar.h"

int main() {
  // 1. A rod of 1 m hangs on a hinge about y; its centre is half a metre below.
  hbar::ModelBuilder builder("pendulum");
  builder.set_gravity({0.0, 0.0, -9.81});
  const hbar::RigidTransform<double> X_JB = {.p = {0.0, 0.0, -0.5}};
  builder.add_link(-1,
                   {.name = "hinge", .kind = hbar::RevoluteJoint{{0.0, 1.0, 0.0}}, .damping = 0.1},
                   hbar::solid_body("rod", hbar::Cuboid{{0.05, 0.05, 1.0}}, 800.0, X_JB));
  const hbar::Model model = builder.build();

  // 2. A second in a hundred steps of BDF2, from 1.2 rad at rest. Two design parameters are free.
  const auto parameters =
      hbar::ParameterSet::named(model, {"body.rod.mass", "joint.hinge.damping"});
  const hbar::Horizon horizon(model, parameters, {.integrator = "bdf2", .h = 0.01, .steps = 100});
  hbar::Inputs inputs = horizon.nominal_inputs();
  inputs.q0(0) = 1.2;
  const hbar::Trajectory trajectory = simulate(horizon, inputs).trajectory();
  std::printf("angle after 1 s: %.6f rad\n", trajectory.q_at_step(100)(0));

  // 3. The objective's gradient with respect to everything, in one backward sweep.
  const hbar::Objective objective(hbar::squared_final_position());
  const hbar::Gradient gradient = hbar::gradient(horizon, trajectory, objective);
  std::printf("objective 1/2 angle^2: %.6f\n", gradient.value);
  std::printf("d objective / d initial angle:       %10.6f\n", gradient.q0(0));
  std::printf("d objective / d initial rate:        %10.6f\n", gradient.qdot0(0));
  std::printf("d objective / d body.rod.mass:       %10.6f\n", gradient.p(0));
  std::printf("d objective / d joint.hinge.damping: %10.6f\n", gradient.p(1));

  // 4. The check: finite differences, the order of the remainder, independent tangents.
  const bool confirmed = hbar::check_gradient({horizon, objective, inputs}).passed();
  std::printf("gradient confirmed: %s\n", confirmed ? "yes" : "no");
  return confirmed ? 0 : 1;
}
