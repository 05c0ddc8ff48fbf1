#include "hbar/solvers/nlp/ipopt_run.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kHs071Objective;
using testing::kHs071Optimum;
using testing::message_of;
using testing::Rosenbrock;

TEST(Ipopt, FindsTheMinimumOfRosenbrock) {
  Rosenbrock program;
  const IpoptResult result = solve_with_ipopt(program);
  EXPECT_EQ(result.status, IpoptStatus::kOptimal) << result.message;
  EXPECT_TRUE(result.converged());
  EXPECT_LT((result.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-6);
  EXPECT_LT(result.objective, 1e-12);
  EXPECT_EQ(result.message.find("ipopt: optimal after "), 0U) << result.message;
  EXPECT_GT(result.elapsed, 0.0);
}

TEST(Ipopt, FindsTheOptimumAndMultipliersOfHs071) {
  Hs071 program;
  const IpoptResult result = solve_with_ipopt(program);
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_LT((result.x - kHs071Optimum).lpNorm<Eigen::Infinity>(), 1e-7);
  EXPECT_NEAR(result.objective, kHs071Objective, 1e-7);
  EXPECT_TRUE(result.feasible);
  EXPECT_LE(result.violation.amount, 1e-6);
  EXPECT_NEAR(result.c[1], 40.0, 1e-6);
  Eigen::VectorXd g(4);
  Eigen::VectorXd jacobian(8);
  program.objective_gradient(result.x, g);
  program.constraint_jacobian(result.x, jacobian);
  const Eigen::VectorXd stationarity = g + jacobian.head(4) * result.constraint_multipliers[0] +
                                       jacobian.tail(4) * result.constraint_multipliers[1] -
                                       result.lower_multipliers + result.upper_multipliers;
  EXPECT_LT(stationarity.lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_NEAR(result.lower_multipliers[0], 1.0878712, 1e-5);
}

TEST(Ipopt, GivesResultsInTheProgramsUnitsWhateverTheScale) {
  Hs071 program;
  program.variables_.scale = Eigen::Vector4d(0.1, 3.0, 1.0, 20.0);
  const IpoptResult result = solve_with_ipopt(program);
  ASSERT_TRUE(result.converged()) << result.message;
  EXPECT_LT((result.x - kHs071Optimum).lpNorm<Eigen::Infinity>(), 1e-7);
  EXPECT_NEAR(result.lower_multipliers[0], 1.0878712, 1e-5);
}

TEST(Ipopt, EvaluatesEachFunctionOncePerPointAndCounts) {
  Rosenbrock program;
  const IpoptResult result = solve_with_ipopt(program);
  int calls = 0;
  for (const auto& [point, count] : program.visits) {
    EXPECT_EQ(count, 1) << "at " << point.first << ", " << point.second;
    calls += count;
  }
  EXPECT_EQ(result.evaluations.objective, calls);
  EXPECT_LE(result.evaluations.gradient, result.evaluations.objective + 1);
  EXPECT_EQ(result.evaluations.constraints, 0);
  EXPECT_EQ(result.evaluations.failures, 0);
}

TEST(Ipopt, ShortensTheStepWhereAPointCannotBeEvaluated) {
  Rosenbrock program;
  int failures = 0;
  program.on_objective = [&](const Eigen::VectorXd& x) {
    if (x[1] >= -0.05 && x[0] <= 1.05) {
      return;
    }
    ++failures;
    throw EvaluationError("the simulation failed");
  };
  const IpoptResult result = solve_with_ipopt(program);
  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_LT((result.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-5);
  EXPECT_GT(failures, 0);
  EXPECT_EQ(result.evaluations.failures, failures);
}

TEST(Ipopt, SaysWhyNoPointCouldBeEvaluated) {
  Rosenbrock program;
  program.on_objective = [](const Eigen::VectorXd&) { throw EvaluationError("no step fits"); };
  const IpoptResult result = solve_with_ipopt(program);
  EXPECT_EQ(result.status, IpoptStatus::kEvaluationFailed);
  EXPECT_FALSE(result.feasible);
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.x, program.variables_.start);
  EXPECT_TRUE(std::isnan(result.objective));
  EXPECT_NE(
      result.message.find("evaluation failed after 0 iterations: no point could be evaluated"),
      std::string::npos)
      << result.message;
  EXPECT_NE(result.message.find("the last with: no step fits; start where"), std::string::npos)
      << result.message;
}

TEST(Ipopt, SaysWhichConstraintIsInfeasible) {
  Hs071 program;
  program.limits_.lower[1] = 200.0;
  program.limits_.upper[1] = 200.0;
  const IpoptResult result = solve_with_ipopt(program);
  EXPECT_FALSE(result.converged()) << result.message;
  EXPECT_TRUE(result.status == IpoptStatus::kInfeasible ||
              result.status == IpoptStatus::kRestorationFailed)
      << result.message;
  EXPECT_FALSE(result.feasible);
  EXPECT_EQ(result.violation.name, "sphere");
  EXPECT_NEAR(result.violation.amount, 100.0, 1e-3);
  EXPECT_NE(result.message.find("(sphere)"), std::string::npos) << result.message;
}

TEST(Ipopt, RethrowsWhatTheProgramThrows) {
  Rosenbrock program;
  int calls = 0;
  program.on_objective = [&](const Eigen::VectorXd&) {
    if (++calls == 5) {
      throw std::out_of_range("a bug");
    }
  };
  EXPECT_EQ(message_of<std::out_of_range>([&] { (void)solve_with_ipopt(program); }), "a bug");
  EXPECT_EQ(calls, 5) << "nothing may be evaluated after an exception";
}

TEST(Ipopt, RethrowsWhatTheCallbackThrows) {
  Rosenbrock program;
  IpoptOptions options;
  options.on_iteration = [](const IterationInfo& info) -> bool {
    if (info.iteration == 2) {
      throw std::runtime_error("disk full");
    }
    return true;
  };
  EXPECT_EQ(message_of<std::runtime_error>([&] { (void)solve_with_ipopt(program, options); }),
            "disk full");
}

TEST(Ipopt, ReportsEveryIteration) {
  Rosenbrock program;
  IpoptOptions options;
  std::vector<IterationInfo> log;
  options.on_iteration = [&](const IterationInfo& info) {
    log.push_back(info);
    return true;
  };
  const IpoptResult result = solve_with_ipopt(program, options);
  ASSERT_EQ(log.size(), static_cast<std::size_t>(result.iterations) + 1);
  EXPECT_EQ(log.front().iteration, 0);
  EXPECT_NEAR(log.front().objective, 24.2, 1e-12);
  EXPECT_GT(log.front().dual_infeasibility, 1.0);
  EXPECT_GT(log[1].alpha_primal, 0.0);
  EXPECT_GT(log[1].step_norm, 0.0);
  EXPECT_GE(log[1].line_search_trials, 1);
  EXPECT_GE(log.back().elapsed, log.front().elapsed);
}

TEST(Ipopt, KeepsTheBestFeasiblePointWhenStopped) {
  std::atomic<bool> stop = false;
  for (const bool by_flag : {true, false}) {
    Hs071 program;
    IpoptOptions options;
    options.stop = &stop;
    stop = false;
    options.on_iteration = [&](const IterationInfo& info) {
      // Late enough for feasible points, before convergence.
      if (info.primal_infeasibility > 1e-7 || info.iteration < 3) {
        return true;
      }
      if (by_flag) {
        stop = true;
      }
      return by_flag;
    };
    const IpoptResult result = solve_with_ipopt(program, options);
    EXPECT_EQ(result.status, by_flag ? IpoptStatus::kInterrupted : IpoptStatus::kStopped);
    EXPECT_FALSE(result.converged());
    EXPECT_TRUE(result.feasible) << result.message;
    EXPECT_LE(result.violation.amount, 1e-6);
    EXPECT_NEAR(result.objective, program.objective(result.x), 1e-12);
    EXPECT_NE(result.message.find("start again from this point"), std::string::npos);
  }
}

TEST(Ipopt, StopsAtItsLimits) {
  Hs071 program;
  IpoptOptions options;
  options.max_iterations = 3;
  IpoptResult result = solve_with_ipopt(program, options);
  EXPECT_EQ(result.status, IpoptStatus::kIterationLimit);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_EQ(result.message.find("ipopt: iteration limit after 3 iterations: "), 0U)
      << result.message;
  EXPECT_NE(result.message.find("; raise max_iterations"), std::string::npos);
  EXPECT_EQ(result.x.size(), 4);

  options = {};
  options.max_wall_time = 1e-9;
  result = solve_with_ipopt(program, options);
  EXPECT_EQ(result.status, IpoptStatus::kTimeLimit) << result.message;
  EXPECT_GE(result.evaluations.objective, 1);
  EXPECT_FALSE(result.converged());
}

/// One unknown, two equations: x = 1 and 2x = 3.
class TwoEquations : public testing::Program {
 public:
  TwoEquations() : Program(Eigen::VectorXd::Zero(1), 2) {
    limits_.lower << 1.0, 3.0;
    limits_.upper = limits_.lower;
  }
  double objective(const Eigen::VectorXd& x) override { return x[0]; }
  void objective_gradient(const Eigen::VectorXd&, Eigen::VectorXd& g) override { g << 1.0; }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override { c << x[0], 2.0 * x[0]; }
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd& values) override {
    values << 1.0, 2.0;
  }
};

TEST(Ipopt, SaysWhenThereAreTooManyEquations) {
  TwoEquations program;
  const IpoptResult result = solve_with_ipopt(program);
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.status, IpoptStatus::kTooFewVariables) << result.message;
  EXPECT_EQ(result.x.size(), 1);
  EXPECT_NE(result.message.find("remove equations or free variables"), std::string::npos)
      << result.message;
}

TEST(Ipopt, RunsOneOptimisationAtATimeForSeveralThreads) {
  const auto work = [](double& objective) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      Hs071 program;
      objective = solve_with_ipopt(program).objective;
    }
  };
  double first = 0.0;
  double second = 0.0;
  std::thread other(work, std::ref(first));
  work(second);
  other.join();
  EXPECT_NEAR(first, kHs071Objective, 1e-7);
  EXPECT_EQ(first, second);
}

TEST(Ipopt, RefusesToBeCalledFromInsideItself) {
  Rosenbrock program;
  program.on_objective = [](const Eigen::VectorXd&) {
    Rosenbrock inner;
    (void)solve_with_ipopt(inner);
  };
  EXPECT_EQ(message_of<InvalidInput>([&] { (void)solve_with_ipopt(program); }),
            "ipopt: solve_with_ipopt was called from inside an optimisation");
}

TEST(Ipopt, PrintsNothing) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Rosenbrock program;
  (void)solve_with_ipopt(program);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace hbar::solvers
