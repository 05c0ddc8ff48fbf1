#include "hbar/adjoint/systems/trajectory_system.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/systems/optimality_matrix.h"
#include "hbar/adjoint/systems/periodic_matrix.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "tests/support/periodic_problems.h"

namespace hbar {
namespace {

using testing::driven_pendulum;

constexpr std::array<SystemKind, 4> kKinds = {SystemKind::kAdjoint, SystemKind::kPeriodic,
                                              SystemKind::kGaussNewton, SystemKind::kKkt};

TEST(TrajectorySystem, KindsAreFoundByTheirNames) {
  for (const SystemKind kind : kKinds) {
    EXPECT_EQ(find_system_kind(name_of(kind)), kind);
  }
  try {
    (void)find_system_kind("kkkt");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("adjoint periodic gauss_newton kkt"),
              std::string::npos);
  }
}

TEST(TrajectorySystem, IsWhatItsPartsSay) {
  Problem problem = driven_pendulum("bdf2", 6);
  const Horizon& horizon = problem.horizon;
  const Trajectory trajectory = simulate(horizon, problem.inputs).trajectory();
  Linearizer linearizer(horizon);
  const Linearization& parts = linearizer.linearize(trajectory);
  const auto gap = [](const solvers::SparseMatrix& a, const solvers::SparseMatrix& b) {
    return (Eigen::MatrixXd(a) - Eigen::MatrixXd(b)).norm();
  };
  const Eigen::VectorXd push =
      -(parts.dg_dqdot0.matrix() * Eigen::VectorXd::Ones(horizon.model().dof()));

  const TrajectorySystem adjoint = assemble_system(SystemKind::kAdjoint, horizon, trajectory);
  EXPECT_EQ(gap(adjoint.A, parts.H.matrix()), 0.0);
  EXPECT_EQ(adjoint.b, push);
  EXPECT_EQ(adjoint.options.structure, solvers::Structure::kBlockTriangular);
  EXPECT_EQ(adjoint.options.block_sizes, parts.block_sizes);
  EXPECT_EQ(adjoint.name_of_unknown(1).find("stage 1 (t = "), 0U);

  const TrajectorySystem periodic = assemble_system(SystemKind::kPeriodic, horizon, trajectory);
  EXPECT_EQ(gap(periodic.A, periodic_matrix(horizon.model(), trajectory, parts)), 0.0);
  EXPECT_EQ(periodic.b, push);

  TrajectorySystem expected;
  fill_gauss_newton(horizon, trajectory, parts, {}, expected);
  const TrajectorySystem normal = assemble_system(SystemKind::kGaussNewton, horizon, trajectory);
  EXPECT_EQ(gap(normal.A, expected.A), 0.0);
  EXPECT_EQ(normal.b, expected.b);

  fill_kkt(horizon, trajectory, parts, {}, expected);
  const TrajectorySystem kkt = assemble_system(SystemKind::kKkt, horizon, trajectory);
  EXPECT_EQ(gap(kkt.A, expected.A), 0.0);
  EXPECT_EQ(kkt.kind, SystemKind::kKkt);
}

TEST(TrajectorySystem, RefusesWeightsThatAreNotAllowed) {
  Problem problem = driven_pendulum("bdf1", 3);
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const auto expect_refused = [&](const SystemOptions& options, const std::string& name) {
    try {
      (void)assemble_system(SystemKind::kKkt, problem.horizon, trajectory, options);
      FAIL() << name;
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).find("system: " + name + " is "), 0U) << error.what();
    }
  };
  expect_refused({.tracking = -1.0}, "tracking");
  expect_refused({.forces = std::numeric_limits<double>::infinity()}, "forces");
  expect_refused({.effort = std::numeric_limits<double>::quiet_NaN()}, "effort");
  expect_refused({.damping = 0.0}, "damping");
  expect_refused({.slack = 0.0}, "slack");
}

}  // namespace
}  // namespace hbar
