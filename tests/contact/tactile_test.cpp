#include "hbar/contact/tactile.h"

#include <gtest/gtest.h>

#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::largest;
using testing::Random;
using testing::relative_gap;

/// Calls f(sensor, its first reading, their number).
template <typename F>
void for_each_sensor(const Model& model, const F& f) {
  Eigen::Index first = 0;
  for (int i = 0; i < static_cast<int>(model.tactile_sensors().size()); ++i) {
    const Eigen::Index count =
        3 * model.tactile_sensors()[static_cast<std::size_t>(i)].points.cols();
    f(i, first, count);
    first += count;
  }
}

template <Scalar S>
VectorX<S> readings_at(const Model& model, const Mechanism<S>& mechanism, const VectorX<S>& q,
                       const VectorX<S>& qdot) {
  Motion<S> motion(model.tree());
  compute_motion<S>(model.tree(), mechanism, q, qdot, VectorX<S>::Zero(model.dof()), motion);
  TactileReadings<S> tactile(model);
  tactile.linearize(mechanism, motion);
  VectorX<S> out = VectorX<S>::Constant(model.tactile_count(), S(7.0));
  for_each_sensor(model, [&](int sensor, Eigen::Index first, Eigen::Index count) {
    tactile.read(sensor, out.segment(first, count));
  });
  return out;
}

VectorXd readings_at(const Model& model, const VectorXd& q, const VectorXd& qdot) {
  return readings_at<double>(model, nominal_mechanism<double>(model), q, qdot);
}

constexpr ContactCoefficients kSkin = {.kn = 100.0, .kt = 2.0, .mu = 0.5, .damping = 5.0};

/// Two points of a finger that faces down (axis0 × axis1 = −z), the second out of reach of all
/// else.
TactileSensor pad(int link) {
  TactileSensor sensor;
  sensor.link = link;
  sensor.points = Matrix3Xd::Zero(3, 2);
  sensor.points.col(1) = Vector3d(0.0, 0.0, 9.0);
  sensor.axis0 = Vector3d::UnitY().replicate(1, 2);
  sensor.axis1 = Vector3d::UnitX().replicate(1, 2);
  sensor.coefficients = kSkin;
  return sensor;
}

Body object_body(const Shape& shape) {
  Body body = solid_body("object", shape, 1.0);
  body.contact_points = Matrix3Xd::Constant(3, 1, 5.0);
  return body;
}

/// A finger and an object, both free to translate. Contacts as a test wants them.
ModelBuilder finger_and(const Shape& object) {
  ModelBuilder builder("touch");
  Body finger = solid_body("finger", Cuboid{{0.1, 0.1, 0.1}}, 1.0);
  finger.contact_points = Matrix3Xd::Constant(3, 1, 5.0);
  builder.add_link(-1, {.name = "j0", .kind = TranslationalJoint{}}, finger);
  builder.add_link(-1, {.name = "j1", .kind = TranslationalJoint{}}, object_body(object));
  return builder;
}

VectorXd six(double x, double y, double z) {
  VectorXd out = VectorXd::Zero(6);
  out.head<3>() << x, y, z;
  return out;
}

TEST(TactileReadings, HoldTheContactForceAlongTheirAxes) {
  ModelBuilder builder = finger_and(Cuboid{{4.0, 4.0, 2.0}});
  // The contact's own coefficients, zero, are not the skin's.
  builder.add_contact({.link = 0, .other = 1});
  builder.add_tactile_sensor(pad(0));
  const Model model = builder.build();
  ASSERT_EQ(model.tactile_count(), 6);
  // At z = 0.9 the point is 0.1 deep, pressed at 2: f_n = 10 + 5·2·0.1 = 11 up, friction −2 ṫ.
  const VectorXd found = readings_at(model, six(0.2, 0.3, 0.9), six(0.3, 0.4, -2.0));
  VectorXd expected = VectorXd::Zero(6);
  // Shear along y and x; the normal reading is −f along −z.
  expected.head<3>() << -0.8, -0.6, 11.0;
  EXPECT_LT(relative_gap(found, expected), 1e-14);
  EXPECT_EQ(readings_at(model, six(0.2, 0.3, 1.1), six(0.3, 0.4, -2.0)), VectorXd::Zero(6));
}

TEST(TactileReadings, TurnWithTheirBody) {
  ModelBuilder builder = finger_and(Cuboid{{4.0, 4.0, 2.0}});
  builder.add_contact({.link = 0, .other = 1});
  builder.add_link(
      -1, {.name = "j2", .kind = RevoluteJoint{Vector3d::UnitZ()}, .X_PJ = {.p = {0.0, 0.0, 0.9}}},
      solid_body("turning", Sphere{0.1}, 1.0));
  builder.add_tactile_sensor(pad(2));
  TactileSensor again = pad(0);
  builder.add_tactile_sensor(again);
  const Model model = builder.build();
  VectorXd q = VectorXd::Zero(7);
  VectorXd qdot = VectorXd::Zero(7);
  // The object slides at (0.3, 0.4) under the body that is turned by 90°.
  q[6] = std::asin(1.0);
  q[2] = 3.0;
  qdot[3] = 0.3;
  qdot[4] = 0.4;
  const VectorXd found = readings_at(model, q, qdot);
  // Friction (0.6, 0.8) on the point; its axis0 is −x now, and axis1 is y.
  EXPECT_LT(relative_gap(found.head<3>(), Vector3d(-0.6, 0.8, 10.0)), 1e-14);
  EXPECT_EQ(found.tail<9>(), VectorXd::Zero(9));
}

TEST(TactileReadings, FeelEveryBodyOnceThatAContactHasAsItsDistanceButTheirOwn) {
  const VectorXd q = six(0.2, 0.3, 0.9);
  const VectorXd rest = VectorXd::Zero(6);
  const auto reading = [&](const std::vector<Contact>& contacts) {
    ModelBuilder builder = finger_and(Cylinder{3.0, 2.0});
    for (const Contact& contact : contacts) {
      builder.add_contact(contact);
    }
    builder.add_tactile_sensor(pad(0));
    return Vector3d(readings_at(builder.build(), q, rest).head<3>());
  };
  const Vector3d once(0.0, 0.0, 10.0);
  const Contact onto = {.link = 0, .other = 1};
  EXPECT_LT(relative_gap(reading({onto}), once), 1e-14);
  EXPECT_LT(relative_gap(reading({onto, onto}), once), 1e-14);
  EXPECT_EQ(reading({}), Vector3d::Zero());
  // The world's plane has no readings, nor has the body's own distance.
  const Contact ground = {.link = 0, .surface = Plane{Vector3d(0.0, 0.0, 5.0)}};
  EXPECT_EQ(reading({ground}), Vector3d::Zero());
  const Contact own = {.link = 1, .other = 0};
  EXPECT_EQ(reading({own}), Vector3d::Zero());
  // Of contacts that differ by their caps alone the first counts: the side pushes outwards.
  Contact endless = onto;
  endless.surface = OwnShape{.caps = false};
  EXPECT_LT(relative_gap(reading({onto, endless}), once), 1e-14);
  EXPECT_EQ(reading({endless, onto}), reading({endless}));
  EXPECT_NEAR(reading({endless})[2], 0.0, 1e-13);
  EXPECT_GT(reading({endless}).norm(), 200.0);
}

TEST(TactileReadings, ReactWhereTheContactDoes) {
  // The object spins under the point: at its surface it moves faster than at the point's depth.
  for (const Reaction reaction : {Reaction::kPoint, Reaction::kSurface}) {
    ModelBuilder builder("spin");
    Body finger = solid_body("finger", Sphere{0.1}, 1.0);
    finger.contact_points = Matrix3Xd::Constant(3, 1, 5.0);
    builder.add_link(-1, {.name = "j0", .kind = TranslationalJoint{}}, finger);
    builder.add_link(-1, {.name = "j1", .kind = RevoluteJoint{Vector3d::UnitY()}},
                     solid_body("wheel", Sphere{1.0}, 1.0));
    builder.add_contact({.link = 0, .other = 1, .reaction = reaction});
    builder.add_tactile_sensor(pad(0));
    const Model model = builder.build();
    const double arm = reaction == Reaction::kPoint ? 0.9 : 1.0;
    const VectorXd found = readings_at(model, Eigen::Vector4d(0.0, 0.0, 0.9, 0.0),
                                       Eigen::Vector4d(0.0, 0.0, 0.0, 0.5));
    EXPECT_LT(relative_gap(found.head<3>(), Vector3d(0.0, 2.0 * arm * 0.5, 10.0)), 1e-14);
  }
}

class EveryModelsReadings : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Moves to a random state and gives the gradients that weights y have there.
  void pull_back(const VectorXd& y) {
    apply_parameters<double>(model, set, p, mechanism);
    compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
    by_q = VectorXd::Zero(model.dof());
    by_qdot = VectorXd::Zero(model.dof());
    by_p = VectorXd::Zero(set.size());
    tactile.linearize(mechanism, motion);
    add_gradients(y, by_q, by_qdot, by_p);
  }
  /// Adds the gradients that weights y have where the readings were linearised.
  void add_gradients(const VectorXd& y, VectorXd& q, VectorXd& qdot, VectorXd& grad_p) const {
    const Applied<double> applied{mechanism, set, p};
    LinkPullback<double> links(model);
    for_each_sensor(model, [&](int sensor, Eigen::Index first, Eigen::Index count) {
      tactile.pull_back(sensor, y.segment(first, count), applied, links, grad_p);
    });
    links.sum();
    links.add_coordinates(motion, q);
    links.add_rates(motion, qdot);
    links.add_frames(applied, motion, grad_p);
  }
  MatrixXd duals_by_state(bool rates) const {
    auto dual = nominal_mechanism<Dual>(model);
    const VectorX<Dual> values = p.cast<Dual>();
    apply_parameters<Dual>(model, set, values, dual);
    return testing::dual_jacobian(
        [&](const VectorX<Dual>& x) -> VectorX<Dual> {
          const VectorX<Dual> q = state.q.cast<Dual>();
          const VectorX<Dual> qdot = state.qdot.cast<Dual>();
          return readings_at<Dual>(model, dual, rates ? q : x, rates ? x : qdot);
        },
        rates ? state.qdot : state.q);
  }
  MatrixXd duals_by_parameters() const {
    auto dual = nominal_mechanism<Dual>(model);
    return testing::dual_jacobian(
        [&](const VectorX<Dual>& values) -> VectorX<Dual> {
          apply_parameters<Dual>(model, set, values, dual);
          return readings_at<Dual>(model, dual, state.q.cast<Dual>(), state.qdot.cast<Dual>());
        },
        p);
  }

  const Model model = testing::random_contact_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  testing::State state = testing::random_state(model, random);
  VectorXd p = testing::random_parameters(set, random);
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Motion<double> motion{model.tree()};
  TactileReadings<double> tactile{model};
  VectorXd by_q;
  VectorXd by_qdot;
  VectorXd by_p;
};

TEST_P(EveryModelsReadings, ArePulledBackToTheStateByTheTransposeOfTheDualJacobian) {
  for (int i = 0; i < 5; ++i) {
    state = testing::random_state(model, random);
    const VectorXd y = random.vector(model.tactile_count());
    pull_back(y);
    const VectorXd q_exact = duals_by_state(false).transpose() * y;
    const VectorXd qdot_exact = duals_by_state(true).transpose() * y;
    EXPECT_GT(largest(q_exact), 0.0);
    EXPECT_GT(largest(qdot_exact), 0.0);
    EXPECT_LT(relative_gap(by_q, q_exact), 1e-12);
    EXPECT_LT(relative_gap(by_qdot, qdot_exact), 1e-12);
  }
}

TEST_P(EveryModelsReadings, ArePulledBackToParametersByTheTransposeOfTheDualJacobian) {
  for (int i = 0; i < 3; ++i) {
    state = testing::random_state(model, random);
    const VectorXd y = random.vector(model.tactile_count());
    pull_back(y);
    const VectorXd exact = duals_by_parameters().transpose() * y;
    for (const ParameterKindRow& row : parameter_kinds()) {
      const ParameterKind kind = row.kind;
      std::vector<int> mine;
      for (int k = 0; k < set.size(); ++k) {
        if (set[k].kind == kind) {
          mine.push_back(k);
        }
      }
      const bool matters = kind == ParameterKind::kJointTransform ||
                           kind == ParameterKind::kBodyTransform ||
                           kind == ParameterKind::kContactScale || kind == ParameterKind::kSize;
      const VectorXd part = exact(mine);
      EXPECT_EQ(largest(part) > 0.0, matters) << kind_name(kind);
      EXPECT_LT(relative_gap(by_p(mine), part), 1e-12) << kind_name(kind);
    }
  }
}

TEST_P(EveryModelsReadings, AddTheirGradientsToWhatIsThere) {
  const VectorXd y = random.vector(model.tactile_count());
  pull_back(y);
  const VectorXd q_before = random.vector(model.dof());
  const VectorXd qdot_before = random.vector(model.dof());
  const VectorXd p_before = random.vector(set.size());
  VectorXd q_after = q_before;
  VectorXd qdot_after = qdot_before;
  VectorXd p_after = p_before;
  add_gradients(y, q_after, qdot_after, p_after);
  EXPECT_LT(largest((q_after - q_before - by_q).eval()), 1e-14 * (1.0 + largest(by_q)));
  EXPECT_LT(largest((qdot_after - qdot_before - by_qdot).eval()), 1e-14 * (1.0 + largest(by_qdot)));
  EXPECT_LT(largest((p_after - p_before - by_p).eval()), 1e-14 * (1.0 + largest(by_p)));
}

TEST_P(EveryModelsReadings, HaveARemainderOfSecondOrder) {
  random = Random(GetParam() + 20);
  state = testing::random_state(model, random);
  const VectorXd y = random.vector(model.tactile_count());
  pull_back(y);
  const VectorXd dq = random.vector(model.dof(), 0.1);
  const VectorXd dqdot = random.vector(model.dof(), 0.1);
  const auto along = [&](double e) {
    return y.dot(readings_at<double>(model, mechanism, state.q + e * dq, state.qdot + e * dqdot));
  };
  // Small enough that no point starts, ends or slips on the way.
  EXPECT_NEAR(testing::taylor_slope(along, by_q.dot(dq) + by_qdot.dot(dqdot), 1e-2), 2.0, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsReadings, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
