// The Hessian of shooting against that of all-at-once, reduced, and side by side.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "hbar/adjoint/programs/shooting.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/dense_nlp.h"

namespace hbar {
namespace {

using solvers::HessianKind;

struct ReducedSubject {
  std::string name;
  TrajectoryProblem (*make)();
};

const std::vector<ReducedSubject>& reduced_subjects() {
  static const std::vector<ReducedSubject> all = {
      {"Bdf1", [] { return testing::small_transcription("bdf1", 6, false); }},
      {"Sdirk2Free", [] { return testing::small_transcription("sdirk2", 6, true); }},
      {"Bdf2Free", [] { return testing::small_transcription("bdf2", 6, true); }},
      {"ContactBdf2", [] { return testing::contact_transcription("bdf2", false); }}};
  return all;
}

class ReducedHessian : public ::testing::TestWithParam<ReducedSubject> {};

/// On the manifold ḡ = 0 the Lagrangian of all-at-once, with adjoint multipliers μ on ḡ, is that of
/// shooting, and its gradient across the manifold vanishes: d²L/dx² = Tᵀ (∂²L/∂w²) T with T =
/// dw/dx.
TEST_P(ReducedHessian, OfAllAtOnceIsThatOfShooting) {
  const TrajectoryProblem problem = GetParam().make();
  const auto shooting = transcribe(problem);
  const auto whole = transcribe(problem, {.formulation = Formulation::kAllAtOnce});
  const Eigen::VectorXd x = testing::near_start(*shooting, 1e-4, 5);
  const Eigen::Index n = x.size();
  Horizon horizon = problem.horizon;
  const Trajectory trajectory = simulate(horizon, shooting->inputs(x)).trajectory();
  const Eigen::Index states = whole->variables().start.size() - n;
  const Eigen::Index stages = trajectory.timeline.last_stage();
  ASSERT_EQ(trajectory.q.rows() * stages, states);
  Eigen::VectorXd w(n + states);
  w << x, trajectory.q.rightCols(stages).reshaped();

  const Eigen::Index own = shooting->constraint_limits().lower.size();
  const Eigen::VectorXd lambda = testing::Random(6).vector(own);
  const double sigma = 0.8;
  const Eigen::MatrixXd jacobian = testing::dense_jacobian(*whole, w);
  const Eigen::MatrixXd H_bar = jacobian.bottomRightCorner(states, states);
  Eigen::MatrixXd T(n + states, n);
  T.topRows(n).setIdentity();
  T.bottomRows(states) = -H_bar.partialPivLu().solve(jacobian.bottomLeftCorner(states, n));
  const Eigen::VectorXd by_states = sigma * testing::gradient_of(*whole, w).tail(states) +
                                    jacobian.topRightCorner(own, states).transpose() * lambda;
  Eigen::VectorXd multipliers(own + states);
  multipliers << lambda, -H_bar.transpose().partialPivLu().solve(by_states);
  const Eigen::MatrixXd reduced =
      T.transpose() * testing::dense_hessian(*whole, w, sigma, multipliers, HessianKind::kExact) *
      T;
  const Eigen::MatrixXd exact =
      testing::dense_hessian(*shooting, x, sigma, lambda, HessianKind::kExact);
  EXPECT_LT(testing::relative_gap(reduced, exact), 1e-9);
  // The same of Gauss-Newton matrices: what the values' second partials alone give.
  const Eigen::MatrixXd reduced_gauss_newton =
      T.transpose() *
      testing::dense_hessian(*whole, w, sigma, multipliers, HessianKind::kGaussNewton) * T;
  const Eigen::MatrixXd gauss_newton =
      testing::dense_hessian(*shooting, x, sigma, lambda, HessianKind::kGaussNewton);
  EXPECT_LT(testing::relative_gap(reduced_gauss_newton, gauss_newton), 1e-9);
  EXPECT_GT(testing::relative_gap(gauss_newton, exact), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, ReducedHessian, ::testing::ValuesIn(reduced_subjects()),
                         [](const auto& c) { return c.param.name; });

TEST(ShootingHessian, HasTheSameBitsWithAnyNumberOfThreads) {
  const TrajectoryProblem problem = testing::small_transcription("bdf2", 8, true);
  TranscriptionOptions options{.formulation = Formulation::kMultipleShooting, .segments = 4};
  options.threads = 1;
  Shooting one(problem, options);
  options.threads = 4;
  Shooting four(problem, options);
  const Eigen::VectorXd x = testing::near_start(one, 1e-3, 7);
  const Eigen::VectorXd lambda = testing::Random(8).vector(one.constraint_limits().lower.size());
  EXPECT_EQ(one.objective(x), four.objective(x));
  EXPECT_EQ(testing::gradient_of(one, x), testing::gradient_of(four, x));
  EXPECT_EQ(testing::dense_jacobian(one, x), testing::dense_jacobian(four, x));
  for (const HessianKind kind : {HessianKind::kExact, HessianKind::kGaussNewton}) {
    EXPECT_EQ(testing::dense_hessian(one, x, 0.9, lambda, kind),
              testing::dense_hessian(four, x, 0.9, lambda, kind));
  }
}

/// Variables of different segments meet in the terms alone, of which none spans two segments here.
TEST(ShootingHessian, IsFullWithinSegmentsAndEmptyAcross) {
  TrajectoryProblem problem = testing::small_transcription("bdf1", 6, false);
  problem.objective = Objective(squared_velocity(0.2));
  problem.constraints.clear();
  Shooting nlp(problem,
               {.formulation = Formulation::kMultipleShooting, .segments = 2, .threads = 1});
  const InputVariables& head = nlp.input_variables();
  const Eigen::Index n = nlp.variables().start.size();
  const Eigen::MatrixXd places = testing::places_of(nlp.hessian_pattern(HessianKind::kExact), n, n);
  const Eigen::Index designs = head.design_count();
  const Eigen::Index first = designs + head.control_count();  // of the first segment
  EXPECT_TRUE(places.topLeftCorner(first, first)
                  .isApprox(Eigen::MatrixXd(
                                Eigen::MatrixXd::Ones(first, first).triangularView<Eigen::Lower>()),
                            0.0));
  EXPECT_EQ(places.block(first, designs, n - first, first - designs).sum(), 0.0);
  EXPECT_EQ(places.block(first, 0, n - first, designs).sum(),
            static_cast<double>((n - first) * designs));
}

}  // namespace
}  // namespace hbar
