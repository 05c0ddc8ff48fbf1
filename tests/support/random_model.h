#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "hbar/adjoint/stage/stage_residual.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model_builder.h"
#include "hbar/core/parameters/parameters.h"
#include "tests/support/duals.h"
#include "tests/support/random.h"

namespace hbar::testing {

[[nodiscard]] inline RigidTransform<double> random_pose(Random& random) {
  return {random.rotation(), random.vector3()};
}

/// One joint of every kind, with random axes.
[[nodiscard]] inline std::vector<JointKind> every_joint(Random& random) {
  return {FixedJoint{},
          RevoluteJoint{random.direction()},
          PrismaticJoint{random.direction()},
          PlanarJoint{random.direction(), random.direction()},
          TranslationalJoint{},
          Free2dJoint{},
          SphericalEulerJoint{},
          SphericalExpJoint{},
          Free3dEulerJoint{},
          Free3dExpJoint{},
          UniversalJoint{random.direction(), random.direction()}};
}

/// A body with sides of three lengths.
[[nodiscard]] inline Body brick(const std::string& name = "b") {
  return solid_body(name, Cuboid{{1.0, 2.0, 3.0}}, 1.0);
}

[[nodiscard]] inline Body random_body(Random& random) {
  const Eigen::Vector3d spread(random.between(0.05, 0.3), random.between(0.05, 0.3),
                               random.between(0.05, 0.3));
  Body body;
  body.X_JB = random_pose(random);
  body.mass = random.between(0.5, 2.0);
  body.inertia = Eigen::Vector3d::Constant(spread.sum()) - spread;
  return body;
}

/// A distance given by data whose gradient is not of unit length: half of xᵀ A x − size².
class QuadricField final : public DistanceField {
 public:
  QuadricField(const Eigen::Matrix3d& A, double size) : A_(A), size_(size) {}
  [[nodiscard]] double lower_bound(const Eigen::Vector3d& x) const override {
    return 0.5 * (x.dot(A_ * x) - size_ * size_);
  }
  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const override {
    return {lower_bound(x), A_ * x, A_};
  }
  [[nodiscard]] Eigen::Matrix3d hessian_slope(const Eigen::Vector3d&,
                                              const Eigen::Vector3d&) const override {
    return Eigen::Matrix3d::Zero();
  }

 private:
  Eigen::Matrix3d A_;
  double size_;
};

/// Shapes as large as the distances between bodies, so that about half of them overlap.
[[nodiscard]] inline Shape random_shape(Random& random, std::size_t i) {
  const double a = random.between(1.0, 3.0);
  const double b = random.between(1.0, 3.0);
  switch (i % 4) {
    case 0:
      return Cuboid{{a, b, random.between(1.0, 3.0)}};
    case 1:
      return Sphere{a};
    case 2:
      return Cylinder{a, b};
    default:
      return Capsule{a, b};
  }
}

/// Contacts of every surface, law and reaction among the bodies, the world as a plane among them.
inline void add_random_contacts(ModelBuilder& builder, int links, Random& random) {
  for (int i = 0; i < 4 * links; ++i) {
    Contact contact;
    contact.link = i % links;
    contact.other = (i * 5 + 3 + i / links) % links;
    if (contact.other == contact.link) {
      continue;
    }
    switch (i % 6) {
      case 0:
        contact.surface = Plane{random.vector3(), random.direction()};
        contact.other = i % 4 == 0 ? -1 : contact.other;
        break;
      case 1:
        contact.surface = OwnShape{.caps = false};
        break;
      case 2:
        contact.surface = std::make_shared<const QuadricField>(
            Eigen::Vector3d(1.0, 0.7, 1.4).asDiagonal(), random.between(1.0, 2.0));
        break;
      default:
        break;
    }
    contact.coefficients = {random.between(1.0, 5.0), random.between(0.1, 1.0),
                            random.between(0.05, 1.0), random.between(0.1, 1.0)};
    contact.normal_law = i % 7 == 0 ? NormalLaw::kLinear : NormalLaw::kDocument;
    contact.friction_law = i % 5 == 0 ? FrictionLaw::kSmooth : FrictionLaw::kDocument;
    contact.friction_width = 0.7;
    contact.adhesion = i % 4 != 1;
    contact.reaction = i % 3 == 0 ? Reaction::kSurface : Reaction::kPoint;
    builder.add_contact(contact);
  }
}

/// Tactile sensors of five points each on four bodies.
inline void add_random_sensors(ModelBuilder& builder, Random& random) {
  for (const int link : {13, 2, 5, 8}) {
    TactileSensor sensor;
    sensor.link = link;
    sensor.points = random.matrix(3, 5);
    sensor.axis0.resize(3, 5);
    sensor.axis1.resize(3, 5);
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d axis0 = random.direction();
      sensor.axis0.col(i) = axis0;
      sensor.axis1.col(i) = random.direction().cross(axis0).normalized();
    }
    sensor.coefficients = {random.between(1.0, 5.0), random.between(0.1, 1.0),
                           random.between(0.05, 1.0), random.between(0.1, 1.0)};
    builder.add_tactile_sensor(sensor);
  }
}

/// Two branching trees of every kind of joint and a second exponential, revolute and fixed one, in
/// an order that the seed shuffles; springs, dampers and limits; a motor of every kind; four end
/// effectors; a mask of its own on each link. Subtrees are not contiguous in coordinates.
///
/// @param contacts  whether bodies have shapes and contact points, touch each other and have
///                  sensors
[[nodiscard]] inline Model random_model(unsigned seed, bool contacts = false) {
  constexpr std::array<int, 14> kParents = {-1, 0, 1, 1, 3, 2, 0, 6, -1, 8, 7, 4, 9, 5};
  Random random(seed);
  std::vector<JointKind> kinds = every_joint(random);
  kinds.push_back(SphericalExpJoint{});
  kinds.push_back(RevoluteJoint{random.direction()});
  kinds.push_back(FixedJoint{});
  std::shuffle(kinds.begin(), kinds.end(), random.engine());
  ModelBuilder builder("random");
  builder.set_gravity(random.vector3(9.0));
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Joint joint;
    joint.name = concat("j", i);
    joint.kind = kinds[i];
    joint.X_PJ = random_pose(random);
    joint.damping = random.between(0.1, 1.0);
    joint.stiffness = random.between(0.1, 2.0);
    joint.rest = random.vector(joint_dof(kinds[i]));
    if (i % 2 == 0) {
      joint.limits = JointLimits{-0.5, 0.6, random.between(1.0, 5.0)};
    }
    Body body = random_body(random);
    body.name = concat("b", i);
    if (contacts) {
      body.shape = random_shape(random, i);
      body.contact_points = random.matrix(3, 6);
    }
    builder.add_link(kParents[i], joint, body, concat("l", i), static_cast<unsigned>(i * 5) % 64U);
  }
  int motors = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (joint_dof(kinds[i]) == 0 || i % 5 == 4) {
      continue;
    }
    Motor motor;
    motor.link = static_cast<int>(i);
    motor.kind = motors % 2 == 0 ? Motor::Kind::kPosition : Motor::Kind::kForce;
    motor.implicit = motors % 4 == 0;
    motor.P = random.between(1.0, 3.0);
    motor.D = random.between(0.1, 0.5);
    if (motors % 3 != 0) {
      motor.lower = -2.5;
      motor.upper = 3.0;
    }
    builder.add_motor(motor);
    ++motors;
  }
  for (const int link : {13, 11, 3, 12}) {
    builder.add_end_effector({.name = "", .link = link, .position = random.vector3()});
  }
  if (contacts) {
    add_random_contacts(builder, static_cast<int>(kinds.size()), random);
    add_random_sensors(builder, random);
  }
  return builder.build();
}

/// The same with contacts.
[[nodiscard]] inline Model random_contact_model(unsigned seed) { return random_model(seed, true); }

/// How many random states of a model each claim is tested at.
inline constexpr int kStates = 20;

/// A state and accelerations, all entries of order one.
struct State {
  Eigen::VectorXd q;     ///< [dof]
  Eigen::VectorXd qdot;  ///< [dof]
  Eigen::VectorXd a;     ///< [dof]
};

[[nodiscard]] inline State random_state(const Model& model, Random& random) {
  return {random.vector(model.dof(), 1.5), random.vector(model.dof(), 2.0),
          random.vector(model.dof(), 3.0)};
}

/// A point of a step of 0.05 at which nothing is zero.
[[nodiscard]] inline StagePoint<double> random_point(const Model& model, Random& random) {
  const State state = random_state(model, random);
  StagePoint<double> point(model);
  point.q = state.q;
  point.qdot = state.qdot;
  point.a = state.a;
  point.u = random.vector(model.control_count(), 1.2);
  point.start = {random.vector(model.dof(), 1.5), random.vector(model.dof(), 2.0)};
  point.rate = 20.0;
  return point;
}

/// The same point as constants for duals.
[[nodiscard]] inline StagePoint<Dual> as_dual(const Model& model, const StagePoint<double>& x) {
  StagePoint<Dual> point(model);
  point.q = x.q.cast<Dual>();
  point.qdot = x.qdot.cast<Dual>();
  point.a = x.a.cast<Dual>();
  point.u = x.u.cast<Dual>();
  point.start = {x.start.q.cast<Dual>(), x.start.qdot.cast<Dual>()};
  point.rate = x.rate;
  return point;
}

/// Values of a set's parameters away from the nominal ones, physical ones.             [set.size()]
[[nodiscard]] inline Eigen::VectorXd random_parameters(const ParameterSet& set, Random& random) {
  Eigen::VectorXd p = set.nominal();
  for (int i = 0; i < set.size(); ++i) {
    switch (set[i].kind) {
      case ParameterKind::kJointTransform:
      case ParameterKind::kBodyTransform:
        p[i] += random.between(-0.8, 0.8);
        break;
      case ParameterKind::kMass:
      case ParameterKind::kInertia:
      case ParameterKind::kSize:
        p[i] *= random.between(0.98, 1.02);
        break;
      default:
        p[i] += random.between(0.0, 0.5);
        break;
    }
  }
  return p;
}

/// ID(q, q̇, a) less what contact does.                                  [dof]
template <Scalar S>
[[nodiscard]] VectorX<S> inverse_dynamics_at(const Model& model, const Mechanism<S>& mechanism,
                                             const VectorX<S>& q, const VectorX<S>& qdot,
                                             const VectorX<S>& a) {
  Motion<S> motion(model.tree());
  ContactForces<S> contacts(model);
  Dynamics<S> dynamics(model);
  VectorX<S> tau = VectorX<S>::Zero(model.dof());
  compute_motion<S>(model.tree(), mechanism, q, qdot, a, motion);
  contacts.evaluate(mechanism, motion);
  inverse_dynamics<S>(model, mechanism, motion, dynamics, tau, contacts.wrenches());
  return tau;
}

/// M(q).                                                                     [dof x dof]
template <Scalar S>
[[nodiscard]] MatrixX<S> mass_matrix_at(const Model& model, const Mechanism<S>& mechanism,
                                        const VectorX<S>& q) {
  const VectorX<S> zero = VectorX<S>::Zero(model.dof());
  Motion<S> motion(model.tree());
  Dynamics<S> dynamics(model);
  VectorX<S> tau = zero;
  MatrixX<S> M = MatrixX<S>::Zero(model.dof(), model.dof());
  compute_motion<S>(model.tree(), mechanism, q, zero, zero, motion);
  subtree_dynamics<S>(model, mechanism, motion, dynamics, tau);
  mass_matrix<S>(model, motion, dynamics, M);
  return M;
}

}  // namespace hbar::testing
