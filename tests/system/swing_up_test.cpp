// The swing-up, shortened: all-at-once with exact second derivatives, from a straight line.

#include "examples/swing_up/swing_up.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "examples/swing_up/measure.h"
#include "hbar/adjoint/study/solution_file.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/nlp/hessian_check.h"
#include "hbar/solvers/nlp/ipopt_derivatives.h"

namespace hbar::swing_up {
namespace {

constexpr const char* kScene = HBAR_SOURCE_DIR "/examples/scenes/swing_up.xml";
constexpr int kSteps = 60;  // of 50 ms

std::unique_ptr<Transcription> short_swing_up(int steps) {
  TranscriptionOptions options;
  options.formulation = Formulation::kAllAtOnce;
  return transcribe_swing_up(make_swing_up(kScene, steps), options);
}

solvers::IpoptOptions exact_options() {
  solvers::IpoptOptions options = ipopt_options();
  options.hessian = solvers::HessianKind::kExact;
  return options;
}

TEST(SwingUp, EndsUprightAtRestWithinTrackAndForce) {
  const auto program = short_swing_up(kSteps);
  const solvers::IpoptResult result = solve_with_ipopt(*program, exact_options());
  ASSERT_EQ(result.status, solvers::IpoptStatus::kOptimal) << result.message;
  const TrajectoryValues& values = program->trajectory_values(result.x);
  EXPECT_LT(upright_error(values), 1e-7);
  EXPECT_LT(values.q.row(0).cwiseAbs().maxCoeff(), 0.75 + 1e-7);
  EXPECT_LT(values.u.cwiseAbs().maxCoeff(), 1.0 + 1e-7);
  // The motion is one: simulating the controls gives it again, to what chaos makes of 1e-8.
  Inputs inputs = program->inputs(result.x);
  Horizon horizon = program->problem().horizon;
  const Rollout rollout = simulate(horizon, inputs);
  ASSERT_TRUE(rollout.converged());
  EXPECT_LT((read_values(horizon, rollout.trajectory()).q - values.q).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(SwingUp, NeedsFewerIterationsWithTheExactHessianThanWithLimitedMemory) {
  const auto program = short_swing_up(kSteps);
  const solvers::IpoptResult exact = solve_with_ipopt(*program, exact_options());
  ASSERT_TRUE(exact.converged()) << exact.message;
  solvers::IpoptOptions options = ipopt_options();
  options.max_iterations = exact.iterations;
  const solvers::IpoptResult other = solve_with_ipopt(*program, options);
  EXPECT_EQ(other.status, solvers::IpoptStatus::kIterationLimit) << other.message;
}

TEST(SwingUp, ConvergesQuadraticallyAtAFixedBarrier) {
  const auto program = short_swing_up(kSteps);
  std::vector<solvers::IterationInfo> iterations;
  solvers::IpoptOptions options = fixed_barrier_options(1e-2);
  options.hessian = solvers::HessianKind::kExact;
  options.on_iteration = [&](const solvers::IterationInfo& info) {
    iterations.push_back(info);
    return true;
  };
  const solvers::IpoptResult result = solve_with_ipopt(*program, options);
  ASSERT_EQ(result.status, solvers::IpoptStatus::kOptimal) << result.message;
  const std::vector<TailStep> tail = convergence_tail(iterations);
  ASSERT_GE(tail.size(), 3U);
  EXPECT_LT(tail.back().step_norm, 1e-5);
  // 1 would be linear, 1.6 a secant method's; the order is 2 only in the limit.
  EXPECT_NEAR(tail.back().order, 2.0, 0.3);
}

TEST(SwingUp, HasDerivativesThatIpoptsCheckerAndDifferencesConfirm) {
  const auto program = short_swing_up(12);
  const solvers::IpoptDerivativeTest test =
      solvers::test_derivatives_with_ipopt(*program, solvers::HessianKind::kExact);
  EXPECT_TRUE(test.passed()) << test.text;
  // The start is a straight line without controls; a bent one with controls says more.
  Eigen::VectorXd x = program->variables().start;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] += 0.1 * std::sin(static_cast<double>(3 * i + 1));
  }
  const solvers::HessianCheck check = solvers::check_hessian(*program, x);
  EXPECT_LT(check.gap, 1e-6) << check.gap_name;
  EXPECT_GT(check.slope, 2.9) << check.slope_name;
}

TEST(SwingUp, ResumesFromItsSolutionInAFile) {
  const auto program = short_swing_up(kSteps);
  std::string folder = (std::filesystem::temp_directory_path() / "hbar_swing_up.XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const std::filesystem::path file = std::filesystem::path(folder) / "solution.csv";
  const solvers::IpoptResult first = study::solve_and_save(*program, exact_options(), file);
  ASSERT_TRUE(first.converged()) << first.message;
  solvers::IpoptOptions options = exact_options();
  const auto again = short_swing_up(kSteps);
  options.warm_start = study::load_solution(file, *again);
  const solvers::IpoptResult second = solve_with_ipopt(*again, options);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(second.status, solvers::IpoptStatus::kOptimal) << second.message;
  EXPECT_LE(second.iterations, 3);
  EXPECT_NEAR(second.objective, first.objective, 1e-8);
}

TEST(SwingUp, RefusesScenesThatAreNoCart) {
  EXPECT_THROW(
      static_cast<void>(make_swing_up(HBAR_SOURCE_DIR "/examples/scenes/finger.xml", kSteps)),
      InvalidInput);
}

TEST(SwingUp, MeasuresTheCostOfAnIteration) {
  const std::vector<IterationCost> costs = measure_scaling(kScene, {10, 20});
  ASSERT_EQ(costs.size(), 2U);
  for (const IterationCost& cost : costs) {
    EXPECT_GT(cost.hessian, 0.0);
    EXPECT_GT(cost.total, cost.values + cost.first + cost.hessian);
  }
  // A table of made-up times that grow as steps^1 and steps^2 says so.
  std::vector<IterationCost> made = {{10, 1.0, 1.0, 0.1, 0.1, 0.1, 0.7},
                                     {100, 1.0, 73.0, 1.0, 1.0, 1.0, 70.0}};
  const std::string text = scaling_table(made);
  EXPECT_NE(text.find("of hbar's part 1.00, of Ipopt's 2.00"), std::string::npos) << text;
}

}  // namespace
}  // namespace hbar::swing_up
