#include "hbar/adjoint/programs/stage_layout.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using Eigen::VectorXd;

/// q, q̇, q̈ and step start of every stage are the runs' weighted sums of x, whatever x is.
TEST(StageLayout, GivesWhatTheIntegratorMakesOfAnyCoordinates) {
  for (const char* integrator : {"bdf1", "sdirk2", "bdf2"}) {
    for (const bool free_state : {false, true}) {
      const TrajectoryProblem problem = testing::small_transcription(integrator, 5, free_state);
      const Model& model = problem.horizon.model();
      const Eigen::Index n = model.dof();
      const InputVariables head(problem);
      Trajectory trajectory;
      trajectory.timeline = even_timeline(problem.horizon.integrator(), 0.1, 5);
      const StageLayout layout(head, trajectory.timeline, model.dof());
      const int stages = trajectory.timeline.stage_count();
      ASSERT_EQ(layout.stage_count(), stages);
      EXPECT_EQ(layout.place(1), head.size());
      EXPECT_EQ(layout.place(0), free_state ? head.state_place() : -1);
      EXPECT_EQ(layout.step_ended_by(0), 0);
      EXPECT_EQ(layout.step_ended_by(stages - 1), 5);
      EXPECT_EQ(layout.stage_of_step(5), stages - 1);
      EXPECT_EQ(layout.step_of(stages - 1), 4);

      testing::Random random(3);
      VectorXd x = random.vector(head.size() + n * (stages - 1));
      trajectory.inputs = problem.horizon.nominal_inputs();
      trajectory.q = Eigen::MatrixXd::Zero(n, stages);
      trajectory.qdot = Eigen::MatrixXd::Zero(n, stages);
      if (free_state) {
        trajectory.q.col(0) = x.segment(layout.place(0), n);
        trajectory.qdot.col(0) = x.segment(layout.place(0) + n, n);
      }
      StagePoint<double> point(model);
      History history(model);
      for (int s = 1; s < stages; ++s) {
        trajectory.q.col(s) = x.segment(layout.place(s), n);
        history.set_point(trajectory, s, point);
        trajectory.qdot.col(s) = point.qdot;
        StagePoint<double> sum(model);
        for (const StageRun& run : layout.runs(s)) {
          const auto part = x.segment(run.place, n);
          sum.q += run.q * part;
          sum.qdot += run.qdot * part;
          sum.a += run.a * part;
          sum.start.q += run.start_q * part;
          sum.start.qdot += run.start_qdot * part;
        }
        EXPECT_LT(testing::relative_gap(sum.q, point.q), 1e-13);
        EXPECT_LT(testing::relative_gap(sum.qdot, point.qdot), 1e-13);
        EXPECT_LT(testing::relative_gap(sum.a, point.a), 1e-12);
        EXPECT_LT((sum.start.q - point.start.q).norm(), 1e-13);
        EXPECT_LT((sum.start.qdot - point.start.qdot).norm(), 1e-11);
      }
    }
  }
}

}  // namespace
}  // namespace hbar
