#include "hbar/adjoint/derivatives/backward_sweep.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <atomic>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

/// Solves a stage's block with an LU of its own.
template <Scalar S>
void solve_anew(int, const VectorX<S>& y, StageResidual<S>& stage, VectorX<S>& z) {
  MatrixX<S> block(y.size(), y.size());
  stage.newton_matrix(block);
  z = Eigen::PartialPivLU<MatrixX<S>>(block).transpose().solve(y);
  stage.pull_back(z);
}

template <Scalar S>
MatrixX<S> as(const Eigen::MatrixXd& numbers) {
  return numbers.cast<S>();
}

template <Scalar S>
Gradient swept(const Problem& problem, const Trajectory& trajectory,
               const TrajectoryPartials& weights) {
  auto mechanism = nominal_mechanism<S>(problem.horizon.model());
  const VectorX<S> p = trajectory.inputs.p.cast<S>();
  apply_parameters<S>(problem.horizon.model(), problem.horizon.parameters(), p, mechanism);
  const Applied<S> applied{mechanism, problem.horizon.parameters(), p};
  const MatrixX<S> q = as<S>(trajectory.q);
  const MatrixX<S> qdot = as<S>(trajectory.qdot);
  const MatrixX<S> u = as<S>(trajectory.inputs.u);
  BackwardSweep<S> sweep(problem.horizon);
  sweep.run({trajectory, applied, q, qdot, u},
            {as<S>(weights.q), as<S>(weights.qdot), as<S>(weights.measured), as<S>(weights.u),
             weights.p.cast<S>()},
            solve_anew<S>);
  const auto values = [](const auto& x) {
    return x.unaryExpr([](const S& entry) { return value_of(entry); }).eval();
  };
  return {0.0, values(sweep.by_p()), values(sweep.by_u()), values(sweep.by_q0()),
          values(sweep.by_qdot0())};
}

/// With any way to solve a block, and with numbers that carry slopes, it is the adjoint's gradient.
TEST(BackwardSweep, IsTheGradientWhoeverSolvesTheBlocks) {
  for (const char* integrator : {"bdf1", "sdirk2", "bdf2"}) {
    const Problem problem = testing::contact_problem(integrator, 0.01, 12);
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    TrajectoryPartials weights(read_values(problem.horizon, trajectory));
    testing::Random random(5);
    for (Eigen::MatrixXd* part : {&weights.q, &weights.qdot, &weights.measured, &weights.u}) {
      *part = random.matrix(part->rows(), part->cols());
    }
    weights.p = random.vector(weights.p.size());
    const Gradient expected = AdjointSweep(problem.horizon).pull_back(trajectory, weights);
    for (const Gradient& found :
         {swept<double>(problem, trajectory, weights), swept<Dual>(problem, trajectory, weights)}) {
      EXPECT_LT(testing::relative_gap(found.p, expected.p), 1e-11) << integrator;
      EXPECT_LT(testing::relative_gap(found.u, expected.u), 1e-11) << integrator;
      EXPECT_LT(testing::relative_gap(found.q0, expected.q0), 1e-11) << integrator;
      EXPECT_LT(testing::relative_gap(found.qdot0, expected.qdot0), 1e-11) << integrator;
    }
  }
}

TEST(BackwardSweep, EndsBeforeTheStageAtWhichItsFlagIsSet) {
  std::atomic<bool> stop = false;
  const Problem problem = testing::small_problem("sdirk2");
  SimulationOptions options = problem.horizon.options();
  options.stop = &stop;
  const Horizon horizon = problem.horizon.with(options);
  const Trajectory trajectory = simulate(horizon, problem.inputs).trajectory();
  const TrajectoryPartials weights = problem.objective.partials(read_values(horizon, trajectory));
  const Applied<double> applied{*trajectory.mechanism, horizon.parameters(), trajectory.inputs.p};
  BackwardSweep<double> sweep(horizon);
  const int last = trajectory.timeline.last_stage();
  int solved = 0;
  const auto run = [&](int before_stop) {
    solved = 0;
    sweep.run(
        {trajectory, applied, trajectory.q, trajectory.qdot, trajectory.inputs.u},
        {weights.q, weights.qdot, weights.measured, weights.u, weights.p},
        [&](int s, const Eigen::VectorXd& y, StageResidual<double>& stage, Eigen::VectorXd& z) {
          solve_anew<double>(s, y, stage, z);
          stop = ++solved == before_stop;
        });
  };
  EXPECT_EQ(testing::message_of<Interrupted>([&] { run(3); }),
            concat("backward sweep interrupted at stage ", last - 3, " of ", last));
  EXPECT_EQ(solved, 3);
  stop = false;
  run(0);
  EXPECT_EQ(solved, last);
  EXPECT_EQ(sweep.by_p(), swept<double>(problem, trajectory, weights).p)
      << "a flag that is not set changes nothing, nor does a sweep that was ended";
}

}  // namespace
}  // namespace hbar
