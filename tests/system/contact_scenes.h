#pragma once

#include <string>
#include <utility>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/contact/contact_forces.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/model_builder.h"

namespace hbar::testing {

/// Eight contact points on a cuboid, a hundred or so on what is round.
inline const SurfaceResolution kTouching{
    .cuboid = {2, 2, 2}, .sphere = {7, 12}, .cylinder = {12, 2}, .capsule = {5, 12}};

/// A homogeneous solid with contact points.
[[nodiscard]] inline Body touching_body(std::string name, const Shape& shape, double density) {
  Body body = solid_body(std::move(name), shape, density);
  body.contact_points = surface_points(shape, kTouching);
  return body;
}

/// Adds a free body whose joint frame is its body frame; returns its link.
inline int add_free_body(ModelBuilder& builder, const std::string& name, const Shape& shape,
                         double density, const JointKind& kind = Free3dExpJoint{}) {
  return builder.add_link(-1, Joint{.name = name + "_joint", .kind = kind},
                          touching_body(name, shape, density));
}

/// One body above the plane z = 0, z of its centre its third coordinate.
[[nodiscard]] inline Model body_on_ground(const Shape& shape, const ContactCoefficients& k,
                                          const Eigen::Vector3d& gravity,
                                          const JointKind& kind = Free3dExpJoint{}) {
  ModelBuilder builder("on ground");
  builder.set_gravity(gravity);
  const int body = add_free_body(builder, "body", shape, 1000.0, kind);
  builder.add_contact({.link = body, .surface = Plane{}, .coefficients = k, .adhesion = false});
  return builder.build();
}

[[nodiscard]] inline Horizon contact_horizon(const Model& model, const std::string& integrator,
                                             double h, int steps, const ParameterSet& set = {}) {
  SimulationOptions options;
  options.integrator = integrator;
  options.h = h;
  options.steps = steps;
  return {model, set, options};
}

/// A simulation from a given state.
struct ContactRun {
  ContactRun(const Model& model, const std::string& integrator, double h, int steps,
             const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot0)
      : horizon(contact_horizon(model, integrator, h, steps)) {
    Inputs inputs = horizon.nominal_inputs();
    inputs.q0 = q0;
    inputs.qdot0 = qdot0;
    trajectory = simulate(horizon, inputs).trajectory();
  }

  [[nodiscard]] Eigen::VectorXd q_end() const {
    return trajectory.q_at_step(trajectory.step_count());
  }
  [[nodiscard]] Eigen::VectorXd qdot_end() const {
    return trajectory.qdot_at_step(trajectory.step_count());
  }

  Horizon horizon;
  Trajectory trajectory;
};

/// Contact of a model at given states, point by point.
class ContactProbe {
 public:
  explicit ContactProbe(const Model& model)
      : model_(model),
        mechanism_(nominal_mechanism<double>(model)),
        motion_(model.tree()),
        forces_(model) {}

  /// Poses, twists and forces at a state.
  const ContactForces<double>& at(const Eigen::VectorXd& q, const Eigen::VectorXd& qdot) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(model_.dof());
    compute_motion<double>(model_.tree(), mechanism_, q, qdot, none, motion_);
    forces_.linearize(mechanism_, motion_);
    return forces_;
  }
  /// Spatial momentum of all bodies at the state, about the world's origin: angular, linear.  [6]
  [[nodiscard]] Eigen::Matrix<double, 6, 1> momentum() const {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (int i = 0; i < model_.link_count(); ++i) {
      const Body& body = model_.link(i).body;
      const NodeMotion<double>& node = motion_.at(model_.node_of_link(i));
      const RigidTransform<double> X = RigidTransform<double>{node.R, node.p} * body.X_JB;
      const Eigen::Vector3d omega = node.V.head<3>();
      const Eigen::Vector3d velocity = node.V.tail<3>() + omega.cross(X.p);
      const Eigen::Vector3d spin = X.R * body.inertia.cwiseProduct(X.R.transpose() * omega);
      sum.head<3>() += spin + body.mass * X.p.cross(velocity);
      sum.tail<3>() += body.mass * velocity;
    }
    return sum;
  }
  /// Energy of motion, of gravity and of the contacts' springs (scale 1).
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (int i = 0; i < model_.link_count(); ++i) {
      const Body& body = model_.link(i).body;
      const NodeMotion<double>& node = motion_.at(model_.node_of_link(i));
      const RigidTransform<double> X = RigidTransform<double>{node.R, node.p} * body.X_JB;
      const Eigen::Vector3d omega = X.R.transpose() * node.V.head<3>();
      const Eigen::Vector3d velocity =
          node.V.tail<3>() + Eigen::Vector3d(node.V.head<3>()).cross(X.p);
      sum += 0.5 * body.mass * velocity.squaredNorm() +
             0.5 * omega.dot(body.inertia.cwiseProduct(omega)) -
             body.mass * model_.gravity().dot(X.p);
    }
    for (const ActivePair<double>& pair : forces_.active()) {
      const double kn = model_.contact(pair.contact).coefficients.kn;
      for (const TouchingPoint<double>& point : forces_.points(pair)) {
        sum += 0.5 * kn * point.d * point.d;
      }
    }
    return sum;
  }

 private:
  const Model& model_;
  Mechanism<double> mechanism_;
  Motion<double> motion_;
  ContactForces<double> forces_;
};

}  // namespace hbar::testing
