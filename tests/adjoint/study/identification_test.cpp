#include "hbar/adjoint/study/identification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model_builder.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar::study {
namespace {

using hbar::testing::Random;
using hbar::testing::small_problem;

constexpr double kStep = 0.05;
constexpr int kSteps = 20;

/// A body of 2 kg on a slider along x, which gravity pulls along it. By BDF1 its rate follows from
/// the one before as (q̇ + h g) / (1 + h c / m).
class Slider {
 public:
  Slider(double damping, const std::vector<std::string>& names)
      : horizon_(make_model(damping), ParameterSet(), {}) {
    const Model model = horizon_.model();
    horizon_ = Horizon(model, ParameterSet::named(model, names),
                       {.integrator = "bdf1",
                        .h = kStep,
                        .steps = kSteps,
                        .measurements = {PointVelocity{.name = "speed", .link = 0}}});
  }
  Trajectory roll(const Eigen::VectorXd& p) {
    Inputs inputs = horizon_.nominal_inputs();
    inputs.p = p;
    return simulate(horizon_, inputs).trajectory();
  }
  /// Positions at every step but the first, as they are at p.
  TrajectoryData positions(const Eigen::VectorXd& p) {
    TrajectoryData data;
    data.names = {"slider"};
    const Trajectory trajectory = roll(p);
    data.data.resize(kSteps);
    for (int k = 1; k <= kSteps; ++k) {
      data.places.push_back({.field = ValueField::kQ, .step = k, .index = 0});
      data.column.push_back(0);
      data.data[k - 1] = trajectory.q_at_step(k)[0];
    }
    return data;
  }
  const Horizon& horizon() { return horizon_; }

 private:
  static Model make_model(double damping) {
    ModelBuilder builder("slider");
    builder.set_gravity({3.0, 0.0, 0.0});
    builder.add_link(
        -1, {.name = "slider", .kind = PrismaticJoint{{1.0, 0.0, 0.0}}, .damping = damping},
        solid_body("block", Cuboid{{0.1, 0.1, 0.1}}, 2000.0));
    return builder.build();
  }
  Horizon horizon_;
};

TEST(Identification, OfGravityAndInitialStateIsTheClosedForm) {
  Slider slider(0.0, {"gravity.x"});
  const Eigen::VectorXd d = Eigen::VectorXd::Constant(1, 3.0);
  const TrajectoryData data = slider.positions(d);
  const DesignMapPointer pointer = parameter_map(slider.horizon().parameters());
  const DesignMap& map = *pointer;
  const double sigma = 0.02;
  const Information out =
      fisher_information(slider.horizon(), slider.roll(d), map, d, data,
                         Eigen::VectorXd::Constant(1, sigma), {.initial_state = true});
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  for (int k = 1; k <= kSteps; ++k) {  // q_k = q_0 + k h q̇_0 + h² g k (k + 1) / 2
    const Eigen::Vector3d row(0.5 * kStep * kStep * k * (k + 1), 1.0, k * kStep);
    expected += row * row.transpose() / (sigma * sigma);
  }
  EXPECT_EQ(out.names,
            (std::vector<std::string>{"gravity.x", "initial slider", "initial rate.slider"}));
  EXPECT_LT(testing::relative_gap(out.fisher, expected), 1e-12);
  EXPECT_LT(testing::relative_gap(out.covariance, Eigen::Matrix3d(expected.inverse())), 1e-9);
  EXPECT_LT(out.chi_square, 1e-20);
}

TEST(Identification, CannotTellMassFromDampingByMotionAlone) {
  Slider slider(0.6, {"body.block.mass", "joint.slider.damping"});
  const Eigen::VectorXd d = slider.horizon().parameters().nominal();
  const TrajectoryData data = slider.positions(d);
  const DesignMapPointer pointer = parameter_map(slider.horizon().parameters());
  const DesignMap& map = *pointer;
  const Information out =
      fisher_information(slider.horizon(), slider.roll(d), map, d, data, Eigen::VectorXd::Ones(1));
  ASSERT_EQ(out.silent.cols(), 1);
  // q depends on c / m: it does not answer where both grow by the same share.
  const Eigen::Vector2d silent = out.silent.col(0).cwiseProduct(map.variables().scale);
  EXPECT_NEAR(silent[0] / silent[1], d[0] / d[1], 1e-7 * d[0] / d[1]);
  EXPECT_NE(out.message.find("body.block.mass"), std::string::npos);
  EXPECT_NE(out.message.find("joint.slider.damping"), std::string::npos);
  EXPECT_EQ(out.covariance.size(), 0);
}

TEST(Identification, ReadsMeasurementsAsItReadsRates) {
  Slider slider(0.6, {"gravity.x", "joint.slider.damping"});
  const Eigen::VectorXd d = slider.horizon().parameters().nominal();
  const DesignMapPointer pointer = parameter_map(slider.horizon().parameters());
  const DesignMap& map = *pointer;
  TrajectoryData data;
  data.places = {{ValueField::kMeasured, 7, 0}, {ValueField::kQdot, 7, 0}};
  data.column = {0, 1};
  data.data = Eigen::Vector2d::Zero();
  const Eigen::MatrixXd rows =
      data_sensitivity(slider.horizon(), slider.roll(d), map, d, data, true);
  EXPECT_GT(rows.row(1).norm(), 0.1);
  EXPECT_LT((rows.row(0) - rows.row(1)).norm(), 1e-12 * rows.row(1).norm());
}

TEST(Identification, ForeseesHowFitsOfDampingScatter) {
  constexpr int kFits = 200;
  const double sigma = 0.01;
  Slider slider(1.5, {"joint.slider.damping"});
  const Eigen::VectorXd truth = Eigen::VectorXd::Constant(1, 1.5);
  TrajectoryData data = slider.positions(truth);
  const Eigen::VectorXd exact = data.data;
  const DesignMapPointer pointer = parameter_map(slider.horizon().parameters());
  const DesignMap& map = *pointer;
  const Information foreseen = fisher_information(slider.horizon(), slider.roll(truth), map, truth,
                                                  data, Eigen::VectorXd::Constant(1, sigma));
  ASSERT_TRUE(foreseen.complete());
  Random random(3);
  double mean = 0.0;
  double square = 0.0;
  for (int fit = 0; fit < kFits; ++fit) {
    for (Eigen::Index i = 0; i < exact.size(); ++i) {
      const double radius = std::sqrt(-2.0 * std::log(random.between(1e-12, 1.0)));
      data.data[i] =
          exact[i] + sigma * radius * std::cos(random.between(0.0, 2.0 * std::numbers::pi));
    }
    Eigen::VectorXd d = truth;
    for (int iteration = 0; iteration < 2; ++iteration) {  // of Gauss and Newton
      const Trajectory trajectory = slider.roll(d);
      const Eigen::VectorXd J = data_sensitivity(slider.horizon(), trajectory, map, d, data);
      const Eigen::VectorXd residual = trajectory.q.rightCols(kSteps).transpose() - data.data;
      d[0] -= J.dot(residual) / J.squaredNorm();
    }
    const double relative = (d[0] - truth[0]) / foreseen.standard_deviations[0];
    mean += relative / kFits;
    square += relative * relative / kFits;
  }
  // Four standard deviations of a mean and of a variance; the curvature adds less.
  EXPECT_NEAR(mean, 0.0, 4.0 / std::sqrt(kFits));
  EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / kFits));
}

class IdentificationOfSmallProblem : public ::testing::Test {
 protected:
  IdentificationOfSmallProblem() {
    data_.data.resize(6);
    data_.data << 0.1, -0.2, 0.3, 0.4, 0.5, 0.1;
    data_.places = {{ValueField::kQ, 3, 1},        {ValueField::kQdot, 5, 2},
                    {ValueField::kMeasured, 4, 1}, {ValueField::kU, 2, 0},
                    {ValueField::kP, 0, 3},        {ValueField::kQ, 3, 1}};
    data_.column.assign(6, 0);
    data_.names = {"all"};
  }
  /// The numbers at the data's places, from parameters, initial coordinates and rates.
  Eigen::VectorXd numbers(const Eigen::VectorXd& x) {
    const Eigen::Index dof = problem_.inputs.q0.size();
    Inputs inputs = problem_.inputs;
    inputs.p = x.head(x.size() - 2 * dof);
    inputs.q0 = x.segment(inputs.p.size(), dof);
    inputs.qdot0 = x.tail(dof);
    return measured(read_values(problem_.horizon, simulate(problem_.horizon, inputs).trajectory()));
  }
  [[nodiscard]] static Eigen::VectorXd measured(const TrajectoryValues& values) {
    return (Eigen::VectorXd(6) << values.q(1, 3), values.qdot(2, 5), values.v()(1, 4),
            values.u(0, 2), values.p[3], values.q(1, 3))
        .finished();
  }
  Problem problem_ = small_problem("bdf2");
  TrajectoryData data_;
};

TEST_F(IdentificationOfSmallProblem, HasSensitivitiesThatAreDerivatives) {
  const DesignMapPointer pointer = parameter_map(problem_.horizon.parameters());
  const DesignMap& map = *pointer;
  const Trajectory trajectory = simulate(problem_.horizon, problem_.inputs).trajectory();
  const Eigen::MatrixXd ours =
      data_sensitivity(problem_.horizon, trajectory, map, problem_.inputs.p, data_, true);
  Eigen::VectorXd x(ours.cols());
  x << problem_.inputs.p, problem_.inputs.q0, problem_.inputs.qdot0;
  const Eigen::Index p = problem_.inputs.p.size();
  for (const Eigen::Index i : {Eigen::Index{0}, Eigen::Index{3}, p / 2, p - 1, p + 2, p + 11}) {
    const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
      return numbers(x + e[0] * Eigen::VectorXd::Unit(x.size(), i));
    };
    const Eigen::MatrixXd expected = testing::differences(along, Eigen::VectorXd::Zero(1), 1e-4);
    EXPECT_LT((ours.col(i) - expected).norm(), 1e-7 * (1.0 + expected.norm())) << i;
  }
}

TEST_F(IdentificationOfSmallProblem, HasATermWithExactDerivatives) {
  const Eigen::VectorXd sigma = Eigen::VectorXd::LinSpaced(6, 0.5, 2.0);
  const auto term = measured_data_term(data_, sigma, 3.0);
  TrajectoryValues values =
      read_values(problem_.horizon, simulate(problem_.horizon, problem_.inputs).trajectory());
  const Eigen::VectorXd gap = (measured(values) - data_.data).cwiseQuotient(sigma);
  EXPECT_NEAR(term->value(values), 1.5 * gap.squaredNorm(), 1e-14 * gap.squaredNorm());

  TrajectoryPartials partials(values);
  term->add_partials(values, partials);
  EXPECT_NEAR(partials.q(1, 3), 3.0 * (gap[0] / sigma[0] + gap[5] / sigma[5]), 1e-13);
  EXPECT_NEAR(partials.v()(1, 4), 3.0 * gap[2] / sigma[2], 1e-13);
  EXPECT_NEAR(partials.p[3], 3.0 * gap[4] / sigma[4], 1e-13);
  EXPECT_EQ((partials.q.array() != 0.0).count(), 1);

  const std::vector<SecondPlace> places = term->second_places(values);
  ASSERT_EQ(places.size(), 5U);  // one place was measured twice
  Eigen::VectorXd second(5);
  term->second_partials(values, second);
  EXPECT_NEAR(second[0], 3.0 / (sigma[0] * sigma[0]) + 3.0 / (sigma[5] * sigma[5]), 1e-13);
  EXPECT_NEAR(second[1], 3.0 / (sigma[1] * sigma[1]), 1e-13);
  for (const SecondPlace& place : places) {
    EXPECT_EQ(place.a, place.b);
  }
}

TEST_F(IdentificationOfSmallProblem, RefusesWhatDoesNotFit) {
  const auto one = Eigen::VectorXd::Ones(1);
  EXPECT_THROW((void)measured_data_term(data_, Eigen::VectorXd::Ones(2)), InvalidInput);
  EXPECT_THROW((void)measured_data_term(data_, -one), InvalidInput);
  EXPECT_THROW((void)measured_data_term(data_, one, testing::kNan), InvalidInput);
  const DesignMapPointer pointer = parameter_map(problem_.horizon.parameters());
  const DesignMap& map = *pointer;
  const Trajectory trajectory = simulate(problem_.horizon, problem_.inputs).trajectory();
  const auto refusal = [&](const Eigen::VectorXd& d) {
    return testing::message_of<InvalidInput>(
        [&] { (void)data_sensitivity(problem_.horizon, trajectory, map, d, data_); });
  };
  EXPECT_EQ(refusal(1.01 * problem_.inputs.p),
            "data_sensitivity: the trajectory was not computed with map.parameters(d)");
  EXPECT_NE(refusal(Eigen::VectorXd::Ones(1)), "");
  data_.places[0].step = 1000;
  EXPECT_NE(refusal(problem_.inputs.p).find("q 1 at step 1000"), std::string::npos);
  data_.data[1] = testing::kNan;
  EXPECT_THROW((void)measured_data_term(data_, one), InvalidInput);
}

}  // namespace
}  // namespace hbar::study
