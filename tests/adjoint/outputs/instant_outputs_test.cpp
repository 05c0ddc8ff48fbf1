#include "hbar/adjoint/outputs/instant_outputs.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::Random;

std::vector<Measurement> some_measurements() {
  return {PointVelocity{"speed", 13, {0.1, -0.2, 0.3}}, ContactForce{"push", 0},
          MotorPower{"power", 0}, CentreOfMass{"centre"}};
}

/// The rows one above the other.
template <Scalar S>
VectorX<S> all_rows(const OutputRows<S>& rows) {
  VectorX<S> out(rows.v.size() + rows.tactile.size() + rows.measured.size());
  out << rows.v, rows.tactile, rows.measured;
  return out;
}

class EveryModelsInstant : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Rows at x = (q, q̇, u, p).
  template <Scalar S>
  OutputRows<S> rows_at(const VectorX<S>& x) const {
    const Eigen::Index n = model.dof();
    auto mechanism = nominal_mechanism<S>(model);
    apply_parameters<S>(model, set, x.tail(set.size()), mechanism);
    InstantOutputs<S> outputs(model, some_measurements());
    OutputRows<S> out = outputs.zero_rows();
    outputs.read(mechanism, outputs.motion_at(mechanism, x.head(n), x.segment(n, n)), x.head(n),
                 x.segment(n, n), x.segment(2 * n, model.control_count()), out);
    return out;
  }
  /// Gradients of weights at x, added to `before`.
  template <Scalar S>
  VectorX<S> pulled_back_at(const VectorX<S>& x, const OutputRows<S>& y,
                            const VectorX<S>& before) const {
    const Eigen::Index n = model.dof();
    const VectorX<S> q = x.head(n);
    const VectorX<S> qdot = x.segment(n, n);
    const VectorX<S> u = x.segment(2 * n, model.control_count());
    const VectorX<S> p = x.tail(set.size());
    auto mechanism = nominal_mechanism<S>(model);
    apply_parameters<S>(model, set, p, mechanism);
    InstantOutputs<S> outputs(model, some_measurements());
    VectorX<S> out = before;
    outputs.pull_back(mechanism, set, p, outputs.motion_at(mechanism, q, qdot), q, qdot, u, y,
                      out.head(n), out.segment(n, n), out.segment(2 * n, u.size()),
                      out.tail(set.size()));
    return out;
  }
  OutputRows<double> random_weights() {
    return {random.vector(model.variable_count()), random.vector(model.tactile_count()),
            random.vector(all_measured)};
  }

  const Model model = testing::random_contact_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  const testing::State state = testing::random_state(model, random);
  const VectorXd p = testing::random_parameters(set, random);
  const int all_measured = Measurements<double>(model, some_measurements()).size();
  VectorXd x = [this] {
    VectorXd out(2 * model.dof() + model.control_count() + set.size());
    out << state.q, state.qdot, random.vector(model.control_count(), 0.9), p;
    return out;
  }();
};

TEST_P(EveryModelsInstant, ReadsWhatItsPartsRead) {
  const OutputRows<double> rows = rows_at<double>(x);
  auto mechanism = nominal_mechanism<double>(model);
  apply_parameters<double>(model, set, p, mechanism);
  Motion<double> motion(model.tree());
  compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
  VectorXd v(model.variable_count());
  VectorXd tactile(model.tactile_count());
  VectorXd measured(all_measured);
  EndEffectors<double>(model).positions(motion, v);
  TactileReadings<double>(model).readings(mechanism, motion, tactile);
  Measurements<double>(model, some_measurements())
      .readings(mechanism, motion, state.q, state.qdot,
                x.segment(2 * model.dof(), model.control_count()), measured);
  EXPECT_EQ(rows.v, v);
  EXPECT_EQ(rows.tactile, tactile);
  EXPECT_EQ(rows.measured, measured);
  EXPECT_GT(v.norm(), 0.0);
  EXPECT_GT(tactile.norm(), 0.0);
  EXPECT_GT(measured.norm(), 0.0);
}

TEST_P(EveryModelsInstant, IsPulledBackByTheTranspose) {
  for (int i = 0; i < 3; ++i) {
    const OutputRows<double> y = random_weights();
    const VectorXd d = random.vector(x.size());
    const VectorXd before = random.vector(x.size());
    const VectorXd gradient = pulled_back_at<double>(x, y, before) - before;
    const VectorXd moved = testing::slopes(all_rows(rows_at<Dual>(testing::with_slope(x, d))));
    const double scale = gradient.cwiseProduct(d).lpNorm<1>();
    EXPECT_NEAR(gradient.dot(d), moved.dot(all_rows(y)), 1e-12 * scale);
    EXPECT_GT(scale, 0.0);
  }
}

TEST_P(EveryModelsInstant, AddsNothingForRowsWithoutWeight) {
  const VectorXd before = random.vector(x.size());
  OutputRows<double> y{VectorXd::Zero(model.variable_count()),
                       VectorXd::Zero(model.tactile_count()), VectorXd::Zero(all_measured)};
  EXPECT_EQ(pulled_back_at<double>(x, y, before), before);
  y.measured[0] = 1.0;
  EXPECT_NE(pulled_back_at<double>(x, y, before), before);
}

/// Weights that are zero but move count: the rate of Jᵀ y is Jᵀ δy there.
TEST_P(EveryModelsInstant, TakesWeightsThatOnlyMove) {
  const OutputRows<double> y = random_weights();
  const auto only_moving = [](const VectorXd& weights) {
    return testing::with_slope(VectorXd(VectorXd::Zero(weights.size())), weights);
  };
  const VectorX<Dual> none = VectorX<Dual>::Constant(x.size(), Dual(0.0));
  const VectorX<Dual> product = pulled_back_at<Dual>(
      x.cast<Dual>(), {only_moving(y.v), only_moving(y.tactile), only_moving(y.measured)}, none);
  const VectorXd expected = pulled_back_at<double>(x, y, VectorXd::Zero(x.size()));
  EXPECT_LT(testing::relative_gap(testing::slopes(product), expected), 1e-14);
  EXPECT_EQ(testing::largest(testing::values(product)), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsInstant, ::testing::Values(1U, 2U));

TEST(InstantOutputs, AreNoneOfAModelWithNothingToRead) {
  ModelBuilder builder("bare");
  builder.add_link(-1, {.name = "j", .kind = RevoluteJoint{}}, solid_body("b", Sphere{1.0}, 1.0));
  const Model model = builder.build();
  const InstantOutputs<double> outputs(model, {});
  EXPECT_TRUE(outputs.empty());
  EXPECT_EQ(all_rows(outputs.zero_rows()).size(), 0);
  const InstantOutputs<double> measuring(model, {PointVelocity{"speed", 0}});
  EXPECT_FALSE(measuring.empty());
  EXPECT_EQ(measuring.measured_names(),
            (std::vector<std::string>{"speed.x", "speed.y", "speed.z"}));
  EXPECT_EQ(measuring.zero_rows().measured, Eigen::Vector3d::Zero());
  EXPECT_FALSE(InstantOutputs<double>(testing::random_model(1), {}).empty());
}

TEST(InstantOutputs, RefuseMeasurementsThatTheModelCannotHave) {
  const Model model = testing::random_model(1);
  EXPECT_THROW(InstantOutputs<double>(model, {PointVelocity{"tip", 99}}), InvalidInput);
}

}  // namespace
}  // namespace hbar
