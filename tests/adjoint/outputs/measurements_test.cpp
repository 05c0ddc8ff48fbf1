#include "hbar/adjoint/outputs/measurements.h"

#include <gtest/gtest.h>

#include "hbar/core/base/rotation.h"
#include "hbar/core/dynamics/joint_forces.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::largest;
using testing::Random;
using testing::relative_gap;

/// Measurements of every kind on several links, contacts and motors.
std::vector<Measurement> every_measurement(const Model& model, Random& random) {
  std::vector<Measurement> out;
  for (const int link : {13, 4}) {
    out.emplace_back(PointVelocity{concat("velocity", link), link, random.vector3()});
    out.emplace_back(Orientation{concat("turn", link), link, random.rotation()});
  }
  const auto field = std::make_shared<const testing::QuadricField>(
      Eigen::Vector3d(1.0, 0.7, 1.4).asDiagonal(), 1.5);
  for (int other = 0; other < 4; ++other) {  // a body of every shape
    out.emplace_back(
        BodyDistance{concat("gap", other), 11 - other, random.vector3(), 0.1 * other, other});
  }
  out.emplace_back(BodyDistance{"height", 6, random.vector3(), 0.3, -1,
                                Plane{random.vector3(), random.direction()}});
  out.emplace_back(BodyDistance{"over plane", 6, random.vector3(), 0.0, 9,
                                Plane{random.vector3(), random.direction()}});
  out.emplace_back(BodyDistance{"field", 3, random.vector3(), 0.2, 10, field});
  for (int contact = 0; contact < model.contact_count(); contact += 3) {
    out.emplace_back(ContactForce{concat("push", contact), contact});
  }
  out.emplace_back(ContactForce{"push 0 again", 0});
  for (int motor = 0; motor < static_cast<int>(model.motors().size()); ++motor) {
    out.emplace_back(MotorTorque{concat("torque", motor), motor});
    out.emplace_back(MotorPower{concat("power", motor), motor});
  }
  out.emplace_back(CentreOfMass{"centre"});
  out.emplace_back(LinearMomentum{"momentum"});
  for (const Measurement& own : model_measurements(model)) {
    out.push_back(own);
  }
  return out;
}

class EveryModelsMeasurements : public ::testing::TestWithParam<unsigned> {
 protected:
  template <Scalar S>
  VectorX<S> readings_at(const VectorX<S>& q, const VectorX<S>& qdot, const VectorX<S>& controls,
                         const VectorX<S>& values) const {
    auto numbers = nominal_mechanism<S>(model);
    apply_parameters<S>(model, set, values, numbers);
    Measurements<S> measured(model, declared);
    InstantMotion<S> instants(model, measured.reads_contacts());
    const Applied<S> applied{numbers, set, values};
    const Instant<S> at = instants.at(applied, q, qdot, controls);
    measured.linearize(at);
    VectorX<S> out = VectorX<S>::Constant(measured.size(), S(7.0));
    measured.read(at, out);
    return out;
  }
  /// The readings here; also moves `mechanism` and `motion`.
  VectorXd readings() {
    apply_parameters<double>(model, set, p, mechanism);
    compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
    ContactForces<double> contacts(model);
    contacts.linearize(mechanism, motion);
    const Applied<double> applied{mechanism, set, p};
    const Instant<double> at{applied, motion, &contacts, state.q, state.qdot, u};
    measurements.linearize(at);
    VectorXd out = VectorXd::Zero(measurements.size());
    measurements.read(at, out);
    return out;
  }
  Eigen::Index row(const std::string& name) const {
    const auto& names = measurements.names();
    const auto found = std::find(names.begin(), names.end(), name);
    EXPECT_NE(found, names.end()) << name;
    return found - names.begin();
  }
  /// Everything the readings depend on, as one vector (q, q̇, u, p).
  VectorXd everything() const {
    VectorXd x(state.q.size() + state.qdot.size() + u.size() + p.size());
    x << state.q, state.qdot, u, p;
    return x;
  }
  template <Scalar S>
  VectorX<S> readings_at(const VectorX<S>& x) const {
    const Eigen::Index n = model.dof();
    return readings_at<S>(x.head(n), x.segment(n, n), x.segment(2 * n, u.size()),
                          x.tail(set.size()));
  }
  /// Gradients of weights y at x, in the order of everything().
  template <Scalar S>
  VectorX<S> pulled_back(const VectorX<S>& x, const VectorX<S>& y, const VectorX<S>& before) const {
    const Eigen::Index n = model.dof();
    const VectorX<S> q = x.head(n);
    const VectorX<S> qdot = x.segment(n, n);
    const VectorX<S> controls = x.segment(2 * n, u.size());
    const VectorX<S> values = x.tail(set.size());
    auto numbers = nominal_mechanism<S>(model);
    apply_parameters<S>(model, set, values, numbers);
    Measurements<S> measured(model, declared);
    InstantMotion<S> instants(model, measured.reads_contacts());
    const Applied<S> applied{numbers, set, values};
    const Instant<S> at = instants.at(applied, q, qdot, controls);
    VectorX<S> out = before;
    InstantGradient<S> by{out.head(n), out.segment(n, n), out.segment(2 * n, u.size()),
                          out.tail(set.size())};
    measured.linearize(at);
    measured.pull_back(at, y, by);
    return out;
  }
  void move() {
    state = testing::random_state(model, random);
    u = random.vector(model.control_count(), 1.2);
  }

  const Model model = testing::random_contact_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  const std::vector<Measurement> declared = every_measurement(model, random);
  testing::State state = testing::random_state(model, random);
  VectorXd u = random.vector(model.control_count(), 1.2);
  VectorXd p = testing::random_parameters(set, random);
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Motion<double> motion{model.tree()};
  Measurements<double> measurements{model, declared};
};

TEST_P(EveryModelsMeasurements, OfPointsAreTheRatesOfTheirPositions) {
  const VectorXd found = readings();
  for (const Measurement& measurement : declared) {
    const auto* m = std::get_if<PointVelocity>(&measurement);
    if (m == nullptr) {
      continue;
    }
    const auto position = [&](const VectorXd& e) -> VectorXd {
      // Rates of exponential coordinates are those of the coordinates themselves.
      compute_motion<double>(model.tree(), mechanism, state.q + e[0] * state.qdot, state.qdot,
                             state.a, motion);
      const RigidTransform<double> X = body_motion(model, mechanism, motion, m->link).X_WB;
      return X.R * m->point + X.p;
    };
    const MatrixXd expected = testing::differences(position, VectorXd::Zero(1));
    EXPECT_LT(relative_gap(found.segment<3>(row(m->name + ".x")), expected), 1e-9) << m->name;
  }
}

TEST_P(EveryModelsMeasurements, OfOrientationsAreTheRotationVectorsFromTheirTargets) {
  const VectorXd found = readings();
  for (const Measurement& measurement : declared) {
    if (const auto* m = std::get_if<Orientation>(&measurement)) {
      const Eigen::Matrix3d R = body_motion(model, mechanism, motion, m->link).X_WB.R;
      const Vector3d r = found.segment<3>(row(m->name + ".x"));
      EXPECT_LT(relative_gap(m->R_0T * exp_rotation(r), R), 1e-14) << m->name;
      EXPECT_LE(r.norm(), 3.1416);
    }
  }
}

TEST_P(EveryModelsMeasurements, OfDistancesMeetTheSurfaceWhereTheyAreZero) {
  const VectorXd found = readings();
  const auto body = [&](int link) { return body_motion(model, mechanism, motion, link).X_WB; };
  for (const Measurement& measurement : declared) {
    const auto* m = std::get_if<BodyDistance>(&measurement);
    if (m == nullptr || !std::holds_alternative<Plane>(m->surface)) {
      continue;
    }
    const auto& plane = std::get<Plane>(m->surface);
    const Vector3d x = body(m->link).R * m->point + body(m->link).p;
    const RigidTransform<double> X = body(m->other);
    const double expected = (X.R * plane.normal).dot(x - (X.R * plane.point + X.p)) - m->radius;
    EXPECT_NEAR(found[row(m->name)], expected, 1e-13) << m->name;
  }
  // Balls: the distance of their centres, whichever side the surface is of.
  for (const Measurement& measurement : declared) {
    const auto* m = std::get_if<BodyDistance>(&measurement);
    if (m != nullptr && m->other >= 0 && std::holds_alternative<OwnShape>(m->surface) &&
        std::holds_alternative<Sphere>(model.link(m->other).body.shape)) {
      const Vector3d x = body(m->link).R * m->point + body(m->link).p;
      const double expected =
          (x - body(m->other).p).norm() - mechanism.sizes(0, m->other) - m->radius;
      EXPECT_NEAR(found[row(m->name)], expected, 1e-13) << m->name;
    }
  }
}

TEST_P(EveryModelsMeasurements, OfContactsAreTheForcesThatActOnTheirBodies) {
  int touching = 0;
  for (int i = 0; i < 5; ++i) {
    move();
    const VectorXd found = readings();
    ContactForces<double> contacts(model);
    contacts.linearize(mechanism, motion);
    VectorXd expected = VectorXd::Zero(4 * model.contact_count());
    for (const ActivePair<double>& pair : contacts.active()) {
      expected[4 * pair.contact] = contacts.summary(pair.contact).normal_force;
      expected.segment<3>(4 * pair.contact + 1) = pair.wrenches.on_a.tail<3>();
    }
    for (const Measurement& measurement : declared) {
      if (const auto* m = std::get_if<ContactForce>(&measurement)) {
        const Eigen::Vector4d mine = expected.segment<4>(4 * m->contact);
        const Eigen::Vector4d theirs = found.segment<4>(row(m->name + ".normal"));
        EXPECT_LT(largest((mine - theirs).eval()), 1e-13 * (1.0 + largest(mine))) << m->name;
        touching += largest(mine) > 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(touching, 5);
}

TEST_P(EveryModelsMeasurements, OfMotorsAreTheirJointForcesAtThePresentState) {
  const VectorXd found = readings();
  // Joint forces less those of the same joints without controls and gains: what motors add.
  JointForces<double> forces(model);
  compute_joint_forces<double>(model, mechanism, state.q, state.qdot, u, {state.q, state.qdot},
                               forces);
  for (int m = 0; m < static_cast<int>(model.motors().size()); ++m) {
    const Motor& motor = model.motors()[static_cast<std::size_t>(m)];
    const Joint& joint = model.link(motor.link).joint;
    const CoordinateRange range = model.coordinates_of_link(motor.link);
    const std::vector<std::string> rows = row_names(model, MotorTorque{concat("torque", m), m});
    ASSERT_EQ(static_cast<int>(rows.size()), range.end - range.begin);
    double power = 0.0;
    for (int c = range.begin; c < range.end; ++c) {
      double passive =
          -mechanism.stiffness[motor.link] * (state.q[c] - joint.rest[c - range.begin]) -
          mechanism.damping[motor.link] * state.qdot[c];
      if (joint.limits && (state.q[c] < joint.limits->lower || state.q[c] > joint.limits->upper)) {
        const double limit =
            state.q[c] < joint.limits->lower ? joint.limits->lower : joint.limits->upper;
        passive += joint.limits->stiffness * (limit - state.q[c]);
      }
      const double torque = found[row(rows[static_cast<std::size_t>(c - range.begin)])];
      EXPECT_NEAR(torque, forces.tau[c] - passive, 1e-13 * (10.0 + std::abs(forces.tau[c])));
      power += torque * state.qdot[c];
    }
    EXPECT_NEAR(found[row(concat("power", m))], power, 1e-14 * (10.0 + std::abs(power)));
  }
}

TEST_P(EveryModelsMeasurements, OfTheWholeAreItsCentreOfMassAndWhatThatMovesWith) {
  const VectorXd found = readings();
  double mass = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (int link = 0; link < model.link_count(); ++link) {
    const NodeMotion<double>& joint = motion.at(model.node_of_link(link));
    const SpatialInertia<double>& I = mechanism.inertia[static_cast<std::size_t>(link)];
    mass += I.mass;
    moment += joint.R * I.first + I.mass * joint.p;
  }
  EXPECT_LT(relative_gap(found.segment<3>(row("centre.x")), moment / mass), 1e-13);
  const auto centre = [&](const VectorXd& e) -> VectorXd {
    const VectorXd moved = readings_at<double>(state.q + e[0] * state.qdot, state.qdot, u, p);
    return mass * moved.segment<3>(row("centre.x"));
  };
  const MatrixXd momentum = testing::differences(centre, VectorXd::Zero(1));
  EXPECT_LT(relative_gap(found.segment<3>(row("momentum.x")), momentum), 1e-9);
}

TEST_P(EveryModelsMeasurements, ArePulledBackByTheTransposeOfTheDualJacobian) {
  move();
  const VectorXd x = everything();
  const MatrixXd jacobian =
      testing::dual_jacobian([&](const VectorX<Dual>& at) { return readings_at<Dual>(at); }, x);
  for (int r = 0; r < measurements.size(); ++r) {
    const VectorXd unit = VectorXd::Unit(measurements.size(), r);
    const VectorXd gradient = pulled_back<double>(x, unit, VectorXd::Zero(x.size()));
    const VectorXd exact = jacobian.row(r).transpose();
    EXPECT_LE(largest((gradient - exact).eval()), 1e-12 * largest(exact))
        << measurements.names()[static_cast<std::size_t>(r)];
  }
  const VectorXd y = random.vector(measurements.size());
  const VectorXd before = random.vector(x.size());
  const VectorXd together = pulled_back<double>(x, y, before) - before;
  EXPECT_LT(relative_gap(together, jacobian.transpose() * y), 1e-12);
}

TEST_P(EveryModelsMeasurements, DependOnEveryParameterThatTheirFormulasHold) {
  for (int i = 0; i < 3; ++i) {
    move();
    const VectorXd gradient = pulled_back<double>(everything(), random.vector(measurements.size()),
                                                  VectorXd::Zero(everything().size()));
    for (const ParameterKindRow& kinds : parameter_kinds()) {
      const ParameterKind kind = kinds.kind;
      double found = 0.0;
      for (int k = 0; k < set.size(); ++k) {
        found =
            set[k].kind == kind ? std::max(found, std::abs(gradient.tail(set.size())[k])) : found;
      }
      const bool none = kind == ParameterKind::kInertia || kind == ParameterKind::kStiffness ||
                        kind == ParameterKind::kDamping || kind == ParameterKind::kGravity;
      EXPECT_EQ(found > 0.0, !none) << kind_name(kind);
    }
  }
}

TEST_P(EveryModelsMeasurements, HaveSecondDerivativesByDualNumbers) {
  // Along every direction the dual pull-back is the difference of pull-backs.
  const VectorXd x = everything();
  const VectorXd y = random.vector(measurements.size());
  const VectorXd none = VectorXd::Zero(x.size());
  const VectorXd d = random.vector(x.size(), 0.1);
  const VectorX<Dual> at = testing::with_slope(x, d);
  const VectorXd exact = testing::slopes(
      pulled_back<Dual>(at, y.cast<Dual>(), VectorX<Dual>::Constant(x.size(), Dual(0.0))));
  const MatrixXd expected = testing::differences(
      [&](const VectorXd& e) -> VectorXd { return pulled_back<double>(x + e[0] * d, y, none); },
      VectorXd::Zero(1), 1e-5);
  EXPECT_LT(relative_gap(exact, expected), 1e-7);
}

TEST_P(EveryModelsMeasurements, HaveARemainderOfSecondOrder) {
  const VectorXd x = everything();
  const VectorXd y = random.vector(measurements.size());
  const VectorXd d = random.vector(x.size(), 0.1);
  const double slope = pulled_back<double>(x, y, VectorXd::Zero(x.size())).dot(d);
  const auto along = [&](double e) { return y.dot(readings_at<double>(x + e * d)); };
  // Small enough that no point starts, ends or slips on the way.
  EXPECT_NEAR(testing::taylor_slope(along, slope, 3e-3), 2.0, 0.05);
}

TEST_P(EveryModelsMeasurements, AddNothingForRowsWithoutWeight) {
  const VectorXd x = everything();
  const VectorXd before = random.vector(x.size());
  VectorXd y = VectorXd::Zero(measurements.size());
  EXPECT_EQ(pulled_back<double>(x, y, before), before);
  y[0] = 1.0;
  EXPECT_NE(pulled_back<double>(x, y, before), before);
}

/// Weights that are zero but move count: the rate of Jᵀ y is Jᵀ δy there.
TEST_P(EveryModelsMeasurements, TakeWeightsThatOnlyMove) {
  const VectorXd x = everything();
  const VectorXd y = random.vector(measurements.size());
  const VectorX<Dual> moving = testing::with_slope(VectorXd(VectorXd::Zero(y.size())), y);
  const VectorX<Dual> none = VectorX<Dual>::Constant(x.size(), Dual(0.0));
  const VectorX<Dual> product = pulled_back<Dual>(x.cast<Dual>(), moving, none);
  const VectorXd expected = pulled_back<double>(x, y, VectorXd::Zero(x.size()));
  EXPECT_LT(relative_gap(testing::slopes(product), expected), 1e-14);
  EXPECT_EQ(largest(testing::values(product)), 0.0);
}

TEST_P(EveryModelsMeasurements, OfSensorsAreWhatTheirPointsRead) {
  const VectorXd found = readings();
  TactileReadings<double> tactile(model);
  tactile.linearize(mechanism, motion);
  for (int i = 0; i < static_cast<int>(model.tactile_sensors().size()); ++i) {
    const TactileSensor& sensor = model.tactile_sensors()[static_cast<std::size_t>(i)];
    VectorXd expected(3 * sensor.points.cols());
    tactile.read(i, expected);
    EXPECT_EQ(found.segment(row(sensor.name + ".0.shear0"), expected.size()), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsMeasurements, ::testing::Values(1U, 2U, 3U));

TEST(Measurements, AreNoneWhereNoneAreDeclared) {
  const Model model = testing::random_model(1);
  Measurements<double> measurements(model, {});
  EXPECT_EQ(measurements.size(), 0);
  EXPECT_TRUE(measurements.empty());
  EXPECT_TRUE(measurements.names().empty());
  EXPECT_FALSE(Measurements<double>(model, model_measurements(model)).empty());
}

}  // namespace
}  // namespace hbar
