#include "hbar/adjoint/programs/all_at_once.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/programs/shooting.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/dense_nlp.h"
#include "tests/support/message_of.h"

namespace hbar {
namespace {

using testing::message_of;
using testing::relative_gap;

const TranscriptionOptions kWhole{.formulation = Formulation::kAllAtOnce};

struct SimulatedSubject {
  std::string name;
  TrajectoryProblem (*make)();
};

/// The same problem with restarts.
TrajectoryProblem restarted_transcription() {
  TrajectoryProblem problem = testing::small_transcription("bdf2", 6, false);
  SimulationOptions options = problem.horizon.options();
  options.restarts = {2, 5};
  problem.horizon = Horizon(problem.horizon.model(), problem.horizon.parameters(), options);
  return problem;
}

const std::vector<SimulatedSubject>& simulated_subjects() {
  static const std::vector<SimulatedSubject> all = {
      {"Bdf1", [] { return testing::small_transcription("bdf1", 6, false); }},
      {"Sdirk2Free", [] { return testing::small_transcription("sdirk2", 6, true); }},
      {"Bdf2Free", [] { return testing::small_transcription("bdf2", 6, true); }},
      {"Bdf2Restarts", [] { return restarted_transcription(); }},
      {"ContactBdf2", [] { return testing::contact_transcription("bdf2", false); }}};
  return all;
}

class AllAtOnceOfASimulation : public ::testing::TestWithParam<SimulatedSubject> {};

TEST_P(AllAtOnceOfASimulation, HasNoResidualAndTheSimulationsNumbers) {
  const TrajectoryProblem problem = GetParam().make();
  AllAtOnce whole(problem, kWhole);
  Horizon horizon = problem.horizon;
  const Eigen::Index head = whole.input_variables().size();
  Eigen::VectorXd x = testing::near_start(whole, 1e-4, 3);
  const Trajectory trajectory = simulate(horizon, whole.inputs(x)).trajectory();
  ASSERT_EQ(x.size() - head, trajectory.q.rows() * trajectory.timeline.last_stage());
  x.tail(x.size() - head) = trajectory.q.rightCols(trajectory.timeline.last_stage()).reshaped();
  // Each row is divided by its largest entry of H̄: a step of Newton's, which ends at 1e-13.
  EXPECT_LT(whole.residual(x), 1e-11);
  const TrajectoryValues expected = read_values(horizon, trajectory);
  const TrajectoryValues& found = whole.trajectory_values(x);
  EXPECT_EQ(found.q, expected.q);
  EXPECT_LT(relative_gap(found.qdot, expected.qdot), 1e-12);
  EXPECT_LT(relative_gap(found.v(), expected.v()), 1e-12);
  EXPECT_LT(relative_gap(found.measured, expected.measured), 1e-10);
  EXPECT_EQ(found.u, expected.u);
  EXPECT_EQ(found.p, expected.p);
  const auto shooting = transcribe(problem);
  EXPECT_NEAR(whole.objective(x), shooting->objective(x.head(head)),
              1e-11 * std::abs(whole.objective(x)));
}

/// Rows of H̄ have a largest entry of 1 at the start, which is what was simulated.
TEST_P(AllAtOnceOfASimulation, ScalesRowsAtTheStart) {
  AllAtOnce whole(GetParam().make(), kWhole);
  const Eigen::VectorXd x = whole.variables().start;
  const Eigen::Index states = x.size() - whole.input_variables().size();
  const Eigen::MatrixXd H_bar = testing::dense_jacobian(whole, x).bottomRightCorner(states, states);
  const Eigen::VectorXd largest = H_bar.cwiseAbs().rowwise().maxCoeff();
  EXPECT_LT((largest.array() - 1.0).abs().maxCoeff(), 1e-14);
  if (GetParam().name == "Bdf1") {  // the others' inner stages are interpolated
    EXPECT_LT(whole.residual(x), 1e-11);
  }
}

INSTANTIATE_TEST_SUITE_P(All, AllAtOnceOfASimulation, ::testing::ValuesIn(simulated_subjects()),
                         [](const auto& c) { return c.param.name; });

/// A few steps of the small model.
TrajectoryProblem short_transcription(const std::string& integrator, int steps) {
  TrajectoryProblem problem = testing::small_transcription(integrator, 6, false);
  SimulationOptions options = problem.horizon.options();
  options.steps = steps;
  problem.horizon = Horizon(problem.horizon.model(), problem.horizon.parameters(), options);
  problem.objective = Objective(squared_velocity(0.2));
  problem.constraints.clear();
  problem.controls.start = problem.controls.start.leftCols(1).eval();
  return problem;
}

TEST(AllAtOnce, NamesItsCoordinatesAndEquations) {
  const AllAtOnce whole(short_transcription("sdirk2", 2), kWhole);
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::count(names.begin(), names.end(), name);
  };
  for (const char* name :
       {"hinge within step 0", "hinge at step 1", "hinge within step 1", "hinge at step 2"}) {
    EXPECT_EQ(has(whole.variables().names, name), 1) << name;
    EXPECT_EQ(has(whole.constraint_limits().names, concat("motion of ", name)), 1) << name;
  }
  EXPECT_EQ(whole.variables().names.back().find("slider at step 2"), 0U);
}

/// BDF2's first step is one of SDIRK2, whose inner stage lies on the line between the steps' ends.
TEST(AllAtOnce, BeginsAtAGuessOfTheMotion) {
  const TrajectoryProblem problem = short_transcription("bdf2", 3);
  const Eigen::Index dof = problem.q0.size();
  TranscriptionOptions options = kWhole;
  options.q_guess = 0.1 * testing::Random(4).matrix(dof, 4);
  options.q_guess.col(0) = problem.q0;
  const AllAtOnce whole(problem, options);
  const Timeline timeline = even_timeline(find_integrator("bdf2"), 0.02, 3);
  ASSERT_EQ(timeline.last_stage(), 4);
  const double share = timeline.stage(1).time / 0.02;
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.9);
  const Eigen::MatrixXd stages = whole.variables().start.tail(4 * dof).reshaped(dof, 4);
  EXPECT_LT(relative_gap(stages.col(0),
                         (1.0 - share) * options.q_guess.col(0) + share * options.q_guess.col(1)),
            1e-14);
  EXPECT_LT(relative_gap(stages.rightCols(3), options.q_guess.rightCols(3)), 1e-14);
}

TEST(AllAtOnce, BeginsAtRestWhereNothingCanBeSimulated) {
  TrajectoryProblem problem = short_transcription("bdf1", 3);
  SimulationOptions simulation = problem.horizon.options();
  simulation.newton.max_iter = 1;
  simulation.max_halvings = 0;
  problem.horizon = Horizon(problem.horizon.model(), problem.horizon.parameters(), simulation);
  AllAtOnce whole(problem, kWhole);
  const Eigen::Index dof = problem.q0.size();
  EXPECT_EQ(whole.variables().start.tail(3 * dof), problem.q0.replicate(3, 1));
  EXPECT_GT(whole.residual(whole.variables().start), 1e-6);  // no motion, but a point
}

TEST(AllAtOnce, RefusesGuessesAndPointsOfAnotherShape) {
  const TrajectoryProblem problem = short_transcription("bdf1", 3);
  TranscriptionOptions options = kWhole;
  options.q_guess = Eigen::MatrixXd::Zero(problem.q0.size(), 3);
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(AllAtOnce(problem, options)); }),
            concat("transcription: q_guess is ", problem.q0.size(), " x 3; it must be ",
                   problem.q0.size(), " x 4 and finite"));
  AllAtOnce whole(problem, kWhole);
  const Eigen::VectorXd x = whole.variables().start;
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(whole.objective(x.head(7))); }),
            concat("transcription: x has 7 entries; it must have ", x.size()));
}

TEST(AllAtOnce, FailsAPointThatCannotBeAndGoesOn) {
  AllAtOnce whole(short_transcription("bdf1", 3), kWhole);
  const Eigen::VectorXd start = whole.variables().start;
  const auto& names = whole.variables().names;
  const auto mass = std::find(names.begin(), names.end(), "body.hand.mass") - names.begin();
  Eigen::VectorXd x = start;
  x[mass] = -1.0;
  for (int i = 0; i < 2; ++i) {  // the second time from memory
    EXPECT_NE(message_of<solvers::EvaluationError>([&] {
                static_cast<void>(whole.objective(x));
              }).find("body.hand.mass"),
              std::string::npos);
  }
  EXPECT_THROW(static_cast<void>(testing::constraints_of(whole, x)), solvers::EvaluationError);
  EXPECT_THROW(static_cast<void>(testing::dense_jacobian(whole, x)), solvers::EvaluationError);
  EXPECT_NO_THROW(static_cast<void>(whole.objective(start)));
}

TEST(AllAtOnce, FailsAPointThatIsNoNumber) {
  AllAtOnce whole(short_transcription("bdf1", 3), kWhole);
  Eigen::VectorXd x = whole.variables().start;
  x.tail<1>()[0] = testing::kNan;
  EXPECT_THROW(static_cast<void>(whole.objective(x)), solvers::EvaluationError);
  EXPECT_THROW(static_cast<void>(testing::constraints_of(whole, x)), solvers::EvaluationError);
}

TEST(AllAtOnce, EvaluatesAPointOnce) {
  AllAtOnce whole(short_transcription("bdf1", 3), kWhole);
  const int before = whole.times().simulations;
  const Eigen::VectorXd x = testing::near_start(whole, 1e-3, 5);
  static_cast<void>(whole.objective(x));
  static_cast<void>(testing::constraints_of(whole, x));
  static_cast<void>(testing::gradient_of(whole, x));
  static_cast<void>(testing::dense_jacobian(whole, x));
  EXPECT_EQ(whole.times().simulations, before + 1);
  EXPECT_EQ(whole.times().gradients, 1);
  EXPECT_EQ(whole.times().jacobians, 1);
}

TEST(AllAtOnce, RefusesAFirstGuessThatChangesChart) {
  Problem problem = testing::spinning_problem("bdf1");
  const ParameterSet none;
  TrajectoryProblem spinning{
      .horizon = Horizon(problem.horizon.model(), none, problem.horizon.options()),
      .map = parameter_map(none),
      .objective = Objective(squared_velocity()),
      .constraints = {},
      .controls = {},
      .q0 = problem.inputs.q0,
      .qdot0 = problem.inputs.qdot0};
  const std::string message = testing::message_of<InvalidInput>(
      [&] { AllAtOnce(spinning, {.formulation = Formulation::kAllAtOnce}); });
  EXPECT_NE(message.find("change chart at t = "), std::string::npos) << message;
  EXPECT_NO_THROW(Shooting(spinning, {}));
}

}  // namespace
}  // namespace hbar
