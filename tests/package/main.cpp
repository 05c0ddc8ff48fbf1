#include <cmath>
#include <cstdio>

#include "hbar/adjoint/gradient.h"
#include "hbar/adjoint/objective_terms.h"
#include "hbar/core/model_builder.h"
#include "hbar/scene/build_model.h"
#include "hbar/scene/read_xml.h"
#include "hbar/solvers/klu.h"

// What a stranger does first: a pendulum in C++ and one from a scene, a simulation, its gradient.
// Exits with 0 if the gradient is that of central differences.

namespace {

double final_angle_squared(hbar::Simulator& simulator, const hbar::Inputs& inputs) {
  const hbar::Rollout rollout = simulator.rollout(inputs);
  const double angle = simulator.values(rollout.trajectory()).q.rightCols(1)(0);
  return 0.5 * angle * angle;
}

bool gradient_is_right(const hbar::Model& model) {
  hbar::Simulator simulator(model, hbar::ParameterSet::all(model),
                            {.integrator = "bdf2", .h = 0.01, .steps = 20});
  hbar::Inputs inputs = simulator.nominal_inputs();
  inputs.q0(0) = 0.3;

  const hbar::Objective objective(hbar::squared_final_position());
  const hbar::Rollout rollout = simulator.rollout(inputs);
  const double slope = hbar::gradient(simulator, rollout.trajectory(), objective).q0(0);

  const double step = 1e-5;
  inputs.q0(0) = 0.3 + step;
  const double above = final_angle_squared(simulator, inputs);
  inputs.q0(0) = 0.3 - step;
  const double below = final_angle_squared(simulator, inputs);
  const double difference = (above - below) / (2.0 * step);
  std::printf("stranger: gradient %.12g, central difference %.12g\n", slope, difference);
  return std::abs(slope - difference) < 1e-8;
}

}  // namespace

int main() {
  hbar::ModelBuilder builder("pendulum");
  builder.set_gravity({0.0, 0.0, -9.81});
  builder.add_link(-1, {.name = "hinge", .kind = hbar::RevoluteJoint{{0.0, 1.0, 0.0}}},
                   hbar::solid_body("rod", hbar::Cuboid{{0.1, 0.1, 1.0}}, 800.0,
                                    hbar::RigidTransform<double>{.p = {0.0, 0.0, -0.5}}));

  const auto scene = hbar::scene::read_scene_text(
      R"(<redmax model="pendulum">
  <robot>
    <link name="rod">
      <joint type="revolute" axis="0 1 0"/>
      <body type="cuboid" size="1 1 10" pos="0 0 -5" density="1"/>
    </link>
  </robot>
</redmax>)",
      "pendulum.xml");

  const bool solver_is_there = hbar::solvers::make_klu() != nullptr;
  const bool ok = gradient_is_right(builder.build()) &&
                  gradient_is_right(hbar::scene::build_model(scene)) && solver_is_there;
  return ok ? 0 : 1;
}
