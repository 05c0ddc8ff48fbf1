#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/terms/problem.h"
#include "hbar/core/base/rotation.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/model_builder.h"

namespace hbar::testing {

/// A free body with a hinged arm, a ball joint and motors of every kind: small, smooth, and with a
/// member of every parameter class.
[[nodiscard]] inline Model small_model() {
  ModelBuilder builder("small");
  builder.set_gravity({0.2, -0.1, -9.8});
  const auto pose = [](double x, double y, double z, double angle) {
    return RigidTransform<double>{exp_rotation<double>(angle * Eigen::Vector3d(0.6, -0.3, 0.5)),
                                  {x, y, z}};
  };
  Joint base{.name = "base", .kind = Free3dExpJoint{}, .X_PJ = pose(0.1, 0.2, 0.3, 0.4)};
  base.damping = 0.05;
  base.stiffness = 0.2;
  const int trunk = builder.add_link(
      -1, base, solid_body("trunk", Cuboid{{0.3, 0.4, 0.5}}, 20.0, pose(0.02, 0.01, -0.03, 0.3)),
      "trunk", kMaskAll);
  Joint hinge{.name = "hinge", .kind = RevoluteJoint{{0.3, 1.0, 0.2}}};
  hinge.X_PJ = pose(0.2, 0.1, 0.0, 0.7);
  hinge.damping = 0.1;
  hinge.stiffness = 0.7;
  const int arm = builder.add_link(
      trunk, hinge, solid_body("arm", Capsule{0.05, 0.4}, 300.0, pose(0.2, 0.0, 0.0, 1.1)), "arm",
      kMaskAll);
  Joint ball{.name = "ball", .kind = SphericalExpJoint{}, .X_PJ = pose(0.4, 0.0, 0.1, -0.5)};
  ball.damping = 0.1;
  ball.stiffness = 0.3;
  const int hand =
      builder.add_link(arm, ball, solid_body("hand", Sphere{0.1}, 400.0, pose(0.1, 0.02, 0.0, 0.2)),
                       "hand", kMaskAll);
  Joint slider{.name = "slider", .kind = PrismaticJoint{{1.0, 0.0, 0.5}}};
  slider.X_PJ = pose(-0.2, 0.1, 0.1, 0.9);
  slider.stiffness = 30.0;
  slider.damping = 0.4;
  const int weight = builder.add_link(
      trunk, slider, solid_body("weight", Cylinder{0.1, 0.2}, 200.0, pose(0.0, 0.1, 0.0, 0.6)),
      "weight", kMaskAll);
  Motor force{.link = arm, .kind = Motor::Kind::kForce};
  force.lower = -2.0;
  force.upper = 3.0;
  builder.add_motor(force);
  builder.add_motor({.link = hand, .kind = Motor::Kind::kPosition, .P = 1.5, .D = 0.02});
  builder.add_motor(
      {.link = weight, .kind = Motor::Kind::kPosition, .P = 40.0, .D = 0.4, .implicit = true});
  builder.add_end_effector({.name = "tip", .link = hand, .position = {0.2, 0.05, 0.0}});
  builder.add_end_effector({.name = "corner", .link = trunk, .position = {0.1, 0.2, 0.3}});
  return builder.build();
}

/// A free body that spins past the chart's limit within `steps`.
[[nodiscard]] inline Model spinning_model() {
  ModelBuilder builder("spinning");
  builder.set_gravity({0.0, 0.0, -1.0});
  Joint joint{.name = "free", .kind = Free3dExpJoint{}};
  joint.stiffness = 0.01;
  joint.damping = 0.01;
  const int body = builder.add_link(-1, joint, solid_body("brick", Cuboid{{0.3, 0.2, 0.1}}, 500.0),
                                    "brick", kMaskAll);
  builder.add_end_effector({.name = "corner", .link = body, .position = {0.15, 0.1, 0.05}});
  return builder.build();
}

/// What contacts of contact_model() are made of.
struct ContactChoice {
  FrictionLaw friction = FrictionLaw::kDocument;
  Reaction reaction = Reaction::kPoint;
};

/// A box that falls and slides on the ground, a finger of two links that presses it, and a ball
/// that bounces and rolls: contacts of every kind with a member of every parameter class, and a
/// sensor on the finger.
[[nodiscard]] inline Model contact_model(const ContactChoice& choice = {}) {
  ModelBuilder builder("contact");
  builder.set_gravity({0.1, -0.2, -9.8});
  const auto solid = [](const char* name, const Shape& shape, double density,
                        const SurfaceResolution& resolution) {
    Body body = solid_body(name, shape, density);
    body.contact_points = surface_points(shape, resolution);
    return body;
  };
  Joint free{.name = "free", .kind = Free3dExpJoint{}};
  free.damping = 0.02;
  const int box = builder.add_link(
      -1, free, solid("box", Cuboid{{0.4, 0.3, 0.2}}, 200.0, {.cuboid = {2, 2, 2}}), "box",
      kMaskAll);
  Joint shoulder{.name = "shoulder", .kind = RevoluteJoint{{0.0, 1.0, 0.1}}, .damping = 0.1};
  shoulder.X_PJ.p = {-0.5, 0.02, 0.6};
  shoulder.stiffness = 0.5;
  const int upper = builder.add_link(
      -1, shoulder,
      solid_body("upper", Capsule{0.03, 0.4}, 400.0,
                 {exp_rotation<double>(Eigen::Vector3d(0.0, 1.5, 0.0)), {0.2, 0.0, 0.0}}),
      "upper", kMaskAll);
  Joint elbow{.name = "elbow", .kind = RevoluteJoint{{0.0, 1.0, -0.1}}, .damping = 0.1};
  elbow.X_PJ.p = {0.4, 0.0, 0.0};
  Body tip = solid("tip", Capsule{0.04, 0.2}, 400.0, {.capsule = {2, 3}});
  tip.X_JB = {exp_rotation<double>(Eigen::Vector3d(0.1, 1.5, 0.2)), {0.1, 0.0, 0.0}};
  const int lower = builder.add_link(upper, elbow, tip, "lower", kMaskAll);
  const int ball = builder.add_link(-1, Joint{.name = "ball", .kind = Free3dExpJoint{}},
                                    solid("ball", Sphere{0.1}, 300.0, {}), "ball", kMaskAll);
  builder.add_motor({.link = upper, .kind = Motor::Kind::kForce});
  builder.add_motor(
      {.link = lower, .kind = Motor::Kind::kPosition, .P = 4.0, .D = 0.1, .implicit = true});
  const ContactCoefficients k{.kn = 800.0, .kt = 15.0, .mu = 0.4, .damping = 300.0};
  Contact contact{.coefficients = k, .friction_law = choice.friction, .friction_width = 0.05};
  contact.reaction = choice.reaction;
  contact.link = box;
  contact.surface = Plane{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  builder.add_contact(contact);
  contact.link = ball;
  contact.adhesion = false;
  contact.surface = Plane{{0.0, 0.0, 0.02}, Eigen::Vector3d(0.1, 0.05, 1.0).normalized()};
  builder.add_contact(contact);
  contact.link = lower;
  contact.other = box;
  contact.surface = OwnShape{};
  builder.add_contact(contact);
  TactileSensor sensor{.name = "skin", .link = lower};
  sensor.points = tip.contact_points;
  const Eigen::Index count = sensor.points.cols();
  sensor.axis0 = Eigen::Vector3d::UnitX().replicate(1, count);
  sensor.axis1 = Eigen::Vector3d::UnitY().replicate(1, count);
  sensor.coefficients = {.kn = 300.0, .kt = 5.0, .mu = 0.6, .damping = 50.0};
  builder.add_tactile_sensor(sensor);
  builder.add_end_effector({.name = "corner", .link = box, .position = {0.2, 0.1, 0.05}});
  builder.add_end_effector({.name = "tip", .link = lower, .position = {0.2, 0.0, 0.0}});
  return builder.build();
}

/// A problem whose objective reads every field, at inputs without symmetry.
[[nodiscard]] inline Problem make_problem(Model model, const std::string& integrator, double h,
                                          int steps) {
  ParameterSet set = ParameterSet::all(model);
  SimulationOptions options;
  options.integrator = integrator;
  options.h = h;
  options.steps = steps;
  options.newton.rtol = 1e-13;
  Objective objective(squared_variables(0.5));
  objective.add(squared_final_position(0.3)).add(squared_velocity(0.2)).add(effort(0.1));
  Problem problem{Horizon(std::move(model), std::move(set), options), objective, {}};
  problem.inputs = problem.horizon.nominal_inputs();
  const int n = problem.horizon.model().dof();
  for (int i = 0; i < n; ++i) {
    problem.inputs.q0[i] = 0.3 * std::sin(1.0 + i);
    problem.inputs.qdot0[i] = 0.8 * std::cos(0.5 + 2.0 * i);
  }
  for (Eigen::Index k = 0; k < problem.inputs.u.cols(); ++k) {
    for (Eigen::Index i = 0; i < problem.inputs.u.rows(); ++i) {
      problem.inputs.u(i, k) = 0.4 * std::sin(0.3 * static_cast<double>(k + 2 * i));
    }
  }
  for (int i = 0; i < problem.horizon.parameters().size(); ++i) {
    const ParameterKind kind = problem.horizon.parameters()[i].kind;
    if (kind == ParameterKind::kJointTransform || kind == ParameterKind::kBodyTransform) {
      problem.inputs.p[i] = 0.05 * std::sin(1.7 * i);
    }
  }
  return problem;
}

[[nodiscard]] inline Problem small_problem(const std::string& integrator) {
  return make_problem(small_model(), integrator, 0.01, 30);
}

/// The contact model dropped and pressed: points begin and cease to touch, to stick and to slide.
/// From this state none of that happens within the smaller steps of check_gradient, for nearly
/// every class and direction; it leaves out the larger ones itself.
[[nodiscard]] inline Problem contact_problem(const std::string& integrator, double h, int steps,
                                             const ContactChoice& choice = {}) {
  Problem problem = make_problem(contact_model(choice), integrator, h, steps);
  problem.objective.add(squared_tactile(0.01));
  problem.inputs.q0 << 0.0, 0.02, 0.14, 0.12, -0.18, 0.3, 0.35, 0.55, 0.5, 0.2, 0.16, 0.1, 0.3,
      -0.2;
  problem.inputs.qdot0 << 0.6, -0.2, -0.5, 0.3, 0.2, -0.6, 0.5, 0.2, 0.4, -0.3, -0.8, 1.0, 0.5,
      -2.0;
  for (Eigen::Index k = 0; k < problem.inputs.u.cols(); ++k) {
    const auto t = static_cast<double>(k);
    problem.inputs.u.col(k) << 2.0 + 0.5 * std::sin(0.1 * t), 0.6 + 0.1 * std::cos(0.07 * t);
  }
  return problem;
}

/// Crosses into the other chart after some twenty steps.
[[nodiscard]] inline Problem spinning_problem(const std::string& integrator) {
  Problem problem = make_problem(spinning_model(), integrator, 0.02, 40);
  problem.inputs.q0.tail<3>() = Eigen::Vector3d(2.0, 1.5, -1.0);
  problem.inputs.qdot0.tail<3>() = Eigen::Vector3d(4.0, 3.0, -1.0);
  return problem;
}

}  // namespace hbar::testing
