#pragma once

#include <string>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/core/model/model_builder.h"

namespace hbar::testing {

inline const Eigen::Vector3d kGravity{0.0, 0.0, -9.81};

/// A body with its centre of mass at `com`.
[[nodiscard]] inline Body body_at(const Eigen::Vector3d& com, double mass,
                                  const Eigen::Vector3d& inertia, std::string name = "") {
  Body body;
  body.name = std::move(name);
  body.X_JB.p = com;
  body.mass = mass;
  body.inertia = inertia;
  return body;
}

/// One body on a joint at the world's origin, its centre of mass at the origin too; an end effector
/// off all of its axes.
[[nodiscard]] inline Model single_body(const JointKind& kind, const Eigen::Vector3d& gravity,
                                       double stiffness = 0.0, double damping = 0.0) {
  ModelBuilder builder("single body");
  builder.set_gravity(gravity);
  Joint joint{.name = "joint", .kind = kind, .damping = damping, .stiffness = stiffness};
  builder.add_link(-1, joint, body_at(Eigen::Vector3d::Zero(), 2.0, {0.3, 0.5, 0.7}, "body"));
  builder.add_end_effector({.name = "tip", .link = 0, .position = {0.4, -0.3, 0.5}});
  return builder.build();
}

/// A point mass of 2 that slides along z, with a force motor.
[[nodiscard]] inline Model slider(double stiffness, const Eigen::Vector3d& gravity) {
  ModelBuilder builder("slider");
  builder.set_gravity(gravity);
  Joint joint{
      .name = "slide", .kind = PrismaticJoint{Eigen::Vector3d::UnitZ()}, .stiffness = stiffness};
  builder.add_link(-1, joint, body_at(Eigen::Vector3d::Zero(), 2.0, {0.1, 0.1, 0.1}, "mass"));
  builder.add_motor({.link = 0, .kind = Motor::Kind::kForce});
  return builder.build();
}

/// Two links on hinges with skew axes, without friction; end effectors at the centres of mass.
[[nodiscard]] inline ModelBuilder double_pendulum_builder() {
  ModelBuilder builder("double pendulum");
  builder.set_gravity(kGravity);
  const Joint shoulder{.name = "shoulder", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}};
  Joint elbow{.name = "elbow", .kind = RevoluteJoint{{0.6, 0.8, 0.0}}};
  elbow.X_PJ.p = {0.0, 0.0, -0.8};
  const Eigen::Vector3d com0{0.0, 0.1, -0.4};
  const Eigen::Vector3d com1{0.1, 0.0, -0.3};
  const int upper = builder.add_link(-1, shoulder, body_at(com0, 1.5, {0.08, 0.09, 0.05}, "upper"));
  const int lower = builder.add_link(upper, elbow, body_at(com1, 0.9, {0.05, 0.05, 0.04}, "lower"));
  builder.add_end_effector({.name = "upper", .link = upper, .position = com0});
  builder.add_end_effector({.name = "lower", .link = lower, .position = com1});
  return builder;
}

[[nodiscard]] inline Model double_pendulum() { return double_pendulum_builder().build(); }

/// The same with limits that a swing runs into, as springs so stiff that no Newton step survives
/// their onset unharmed, and a stiff position motor on the elbow.
[[nodiscard]] inline Model stiff_pendulum(bool implicit_motor) {
  ModelBuilder builder("stiff pendulum");
  builder.set_gravity(kGravity);
  Joint shoulder{.name = "shoulder", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}};
  shoulder.limits = JointLimits{-0.2, 0.2, 1e8};
  shoulder.damping = 0.01;
  shoulder.stiffness = 0.1;
  Joint elbow{.name = "elbow", .kind = RevoluteJoint{{0.6, 0.8, 0.0}}, .damping = 0.01};
  elbow.X_PJ.p = {0.0, 0.0, -0.8};
  elbow.stiffness = 0.1;
  builder.add_link(-1, shoulder, body_at({0.0, 0.1, -0.4}, 1.5, {0.08, 0.09, 0.05}, "upper"));
  builder.add_link(0, elbow, body_at({0.1, 0.0, -0.3}, 0.9, {0.05, 0.05, 0.04}, "lower"));
  builder.add_motor({.link = 1,
                     .kind = Motor::Kind::kPosition,
                     .P = implicit_motor ? 1e6 : 5.0,
                     .D = implicit_motor ? 1e3 : 0.1,
                     .implicit = implicit_motor});
  builder.add_end_effector({.name = "tip", .link = 1, .position = {0.0, 0.0, -0.6}});
  return builder.build();
}

/// ½ ‖v_N − target‖²: the same in every chart of the coordinates.
[[nodiscard]] inline TermPointer final_variables(const Eigen::VectorXd& target) {
  return user_term(
      "final variables",
      [target](const TrajectoryValues& values) {
        return 0.5 * (values.v().rightCols<1>() - target).squaredNorm();
      },
      [target](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.v().rightCols<1>() += values.v().rightCols<1>() - target;
      });
}

/// ½ weight ‖p − centre‖².
[[nodiscard]] inline TermPointer near_parameters(const Eigen::VectorXd& centre, double weight) {
  return user_term(
      "near parameters",
      [=](const TrajectoryValues& values) {
        return 0.5 * weight * (values.p - centre).squaredNorm();
      },
      [=](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.p += weight * (values.p - centre);
      });
}

[[nodiscard]] inline SimulationOptions options_of(const std::string& integrator, double h,
                                                  int steps) {
  SimulationOptions options;
  options.integrator = integrator;
  options.h = h;
  options.steps = steps;
  return options;
}

/// A horizon with all parameters of a model.
inline Horizon make_horizon(const Model& model, const SimulationOptions& options) {
  return {model, ParameterSet::all(model), options};
}

}  // namespace hbar::testing
