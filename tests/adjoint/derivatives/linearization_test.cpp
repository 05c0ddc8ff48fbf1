#include "hbar/adjoint/derivatives/linearization.h"

#include <gtest/gtest.h>

#include <atomic>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/solvers/linear/klu.h"
#include "tests/support/message_of.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_problem;
using testing::spinning_problem;

class LinearizationOfEveryIntegrator : public ::testing::TestWithParam<std::string> {};

TEST_P(LinearizationOfEveryIntegrator, GivesTheAdjointGradientByItsMatricesAlone) {
  for (const bool spinning : {false, true}) {
    Problem problem = spinning ? spinning_problem(GetParam()) : small_problem(GetParam());
    const Horizon& horizon = problem.horizon;
    const Trajectory trajectory = simulate(horizon, problem.inputs).trajectory();
    // An objective of coordinates alone, so that ȳ is simply ∂Ψ/∂q̄.
    TrajectoryPartials partials(read_values(horizon, trajectory));
    partials.q.setRandom();
    const Gradient swept = AdjointSweep(horizon).pull_back(trajectory, partials);

    Linearizer linearizer(horizon);
    const Linearization& system = linearizer.linearize(trajectory);
    const int n = horizon.model().dof();
    Eigen::VectorXd y_bar = Eigen::VectorXd::Zero(system.H.matrix().rows());
    for (int k = 1; k <= trajectory.step_count(); ++k) {
      y_bar.segment((trajectory.timeline.step_end(k) - 1) * n, n) = partials.q.col(k);
    }
    const auto solver = solvers::make_klu();
    solver->analyze(system.H.matrix());
    solver->factorize(system.H.matrix());
    Eigen::MatrixXd z(y_bar.size(), 1);
    solver->solve_transposed(y_bar, z);

    const Eigen::VectorXd p = -(system.dg_dp.transpose() * z);
    const Eigen::VectorXd u = -(system.dg_du.transpose() * z);
    const Eigen::VectorXd q0 = partials.q.col(0) - system.dg_dq0.matrix().transpose() * z;
    const Eigen::VectorXd qdot0 = -(system.dg_dqdot0.matrix().transpose() * z);
    EXPECT_LT((p - swept.p).norm(), 1e-12 * system.dg_dp.norm() * z.norm());
    EXPECT_LE((u - swept.u.reshaped()).norm(),
              1e-12 * (system.dg_du.size() > 0 ? system.dg_du.norm() : 0.0) * z.norm());
    EXPECT_LT((q0 - swept.q0).norm(), 1e-12 * system.dg_dq0.matrix().norm() * z.norm());
    EXPECT_LT((qdot0 - swept.qdot0).norm(), 1e-12 * system.dg_dqdot0.matrix().norm() * z.norm());
  }
}

TEST_P(LinearizationOfEveryIntegrator, LaysItsPatternOutOnce) {
  Problem problem = small_problem(GetParam());
  Linearizer linearizer(problem.horizon);
  const double* values = nullptr;
  for (int i = 0; i < 5; ++i) {
    problem.inputs.q0[0] += 0.01;
    const auto& system =
        linearizer.linearize(simulate(problem.horizon, problem.inputs).trajectory());
    if (i > 0) {
      EXPECT_EQ(system.H.matrix().valuePtr(), values);
    }
    values = system.H.matrix().valuePtr();
  }
  EXPECT_EQ(linearizer.pattern_count(), 1);
}

TEST_P(LinearizationOfEveryIntegrator, IsBlockBandedAndLowerTriangular) {
  Problem problem = small_problem(GetParam());
  Linearizer linearizer(problem.horizon);
  const auto& system = linearizer.linearize(simulate(problem.horizon, problem.inputs).trajectory());
  const auto& H = system.H.matrix();
  const int n = problem.horizon.model().dof();
  int band = 0;
  for (int c = 0; c < H.cols(); ++c) {
    for (solvers::SparseMatrix::InnerIterator it(H, c); it; ++it) {
      ASSERT_GE(it.row() / n, c / n);
      band = std::max(band, static_cast<int>(it.row()) / n - c / n + 1);
    }
  }
  // BDF1 couples three steps, BDF2 five; SDIRK2 two steps of two stages.
  const int expected = GetParam() == "bdf1" ? 3 : 5;
  EXPECT_LE(band, expected);
}

TEST(Linearization, EndsWhenAskedAndContinuesAfterwards) {
  std::atomic<bool> stop = true;
  const Problem problem = testing::small_problem("bdf1");
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  SimulationOptions options = problem.horizon.options();
  options.stop = &stop;
  Linearizer linearizer(problem.horizon.with(options));
  EXPECT_EQ(testing::message_of<Interrupted>(
                [&] { static_cast<void>(linearizer.linearize(trajectory)); }),
            concat("linearisation interrupted at stage 1 of ", trajectory.timeline.last_stage()));
  stop = false;
  Linearizer other(problem.horizon);
  EXPECT_EQ((linearizer.linearize(trajectory).dg_dp - other.linearize(trajectory).dg_dp).norm(),
            0.0);
}

TEST(Linearization, KeepsParametersToTheRowsTheyOwn) {
  Problem problem = small_problem("bdf2");
  Linearizer linearizer(problem.horizon);
  const auto& system = linearizer.linearize(simulate(problem.horizon, problem.inputs).trajectory());
  const Model& model = problem.horizon.model();
  const int slider = model.coordinates_of_link(model.find_joint("slider")).begin;
  const int i = problem.horizon.parameters().find("joint.slider.stiffness");
  int entries = 0;
  for (solvers::SparseMatrix::InnerIterator it(system.dg_dp, i); it; ++it) {
    EXPECT_EQ(static_cast<int>(it.row()) % model.dof(), slider);
    ++entries;
  }
  EXPECT_EQ(entries, static_cast<int>(system.block_sizes.size()));
}

INSTANTIATE_TEST_SUITE_P(All, LinearizationOfEveryIntegrator,
                         ::testing::Values("bdf1", "sdirk2", "bdf2"));

}  // namespace
}  // namespace hbar
