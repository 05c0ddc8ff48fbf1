#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/terms/problem.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/model_builder.h"

namespace hbar::testing {

/// A double pendulum with damping in gravity, both joints driven by torques of period 1 s; one
/// period, `steps` steps. With contact its end strikes through a soft ground.
[[nodiscard]] inline Problem driven_pendulum(const std::string& integrator, int steps,
                                             bool contact = false) {
  ModelBuilder builder("driven pendulum");
  builder.set_gravity({0.0, 0.0, -9.8});
  Joint shoulder{.name = "shoulder", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}, .damping = 0.8};
  shoulder.stiffness = 0.3;
  const RigidTransform<double> middle{Eigen::Matrix3d::Identity(), {0.0, 0.0, -0.25}};
  const int upper =
      builder.add_link(-1, shoulder, solid_body("upper", Cuboid{{0.05, 0.05, 0.5}}, 800.0, middle),
                       "upper", kMaskAll);
  Joint elbow{.name = "elbow", .kind = RevoluteJoint{{0.2, 1.0, 0.0}}, .damping = 0.4};
  elbow.X_PJ.p = {0.0, 0.0, -0.5};
  elbow.stiffness = 0.6;
  Body end = solid_body("lower", Cuboid{{0.05, 0.05, 0.5}}, 800.0, middle);
  end.contact_points = surface_points(end.shape, {.cuboid = {2, 2, 2}});
  const int lower = builder.add_link(upper, elbow, end, "lower", kMaskAll);
  if (contact) {
    Contact ground{.coefficients = {.kn = 400.0, .kt = 10.0, .mu = 0.3, .damping = 100.0}};
    ground.link = lower;
    ground.surface = Plane{{0.0, 0.0, -0.97}, {0.0, 0.0, 1.0}};
    builder.add_contact(ground);
  }
  builder.add_motor({.link = upper, .kind = Motor::Kind::kForce});
  builder.add_motor({.link = lower, .kind = Motor::Kind::kForce});
  builder.add_end_effector({.name = "tip", .link = lower, .position = {0.0, 0.02, -0.5}});
  Model model = builder.build();
  ParameterSet set = ParameterSet::all(model);
  SimulationOptions options{.integrator = integrator, .h = 1.0 / steps, .steps = steps};
  options.newton.rtol = 1e-13;
  Objective objective(squared_variables(0.5));
  objective.add(squared_velocity(0.2)).add(effort(0.1)).add(squared_final_position(0.7));
  Problem problem{Horizon(std::move(model), std::move(set), options), objective, {}};
  problem.inputs = problem.horizon.nominal_inputs();
  for (Eigen::Index k = 0; k < steps; ++k) {
    const double angle =
        2.0 * std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(steps);
    problem.inputs.u(0, k) = 2.5 * std::sin(angle) + 0.4;
    problem.inputs.u(1, k) = 0.8 * std::cos(2.0 * angle);
  }
  return problem;
}

}  // namespace hbar::testing
