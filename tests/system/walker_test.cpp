// The walker example: what its program solves, without the printing.

#include <gtest/gtest.h>

#include <numbers>

#include "examples/walker/gait.h"
#include "hbar/adjoint/design/check_design_map.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"
#include "hbar/solvers/nlp/hessian_check.h"

namespace hbar::walker {
namespace {

const char* const kScene = HBAR_SOURCE_DIR "/examples/scenes/walker.xml";

Model walker_model() { return scene::build_model(scene::read_scene(kScene)); }

Plan coarse_plan(int steps, double duration) {
  Plan plan;
  plan.scene = kScene;
  plan.steps = steps;
  plan.duration = duration;
  return plan;
}

TEST(Walker, MapsLengthsToBothLegs) {
  const Model model = walker_model();
  const ParameterSet set =
      ParameterSet::named(model, example::stretched_parameters(model, leg_lengths()));
  EXPECT_EQ(set.size(), 12);
  const DesignMapPointer map = example::stretch_map(model, set, set.nominal(), leg_lengths(), 0.25);
  EXPECT_EQ((map->parameters(map->variables().start) - set.nominal()).norm(), 0.0);
  EXPECT_EQ(map->variables().lower, Eigen::Vector2d::Constant(0.75 * 0.4));

  const Eigen::Vector2d d(0.47, 0.31);
  const DesignMapPointer held =
      example::stretch_map(model, set, set.nominal(), leg_lengths(), 0.0, d);
  EXPECT_EQ(held->variables().start, d);
  EXPECT_EQ(held->variables().lower, d);
  EXPECT_EQ(held->variables().upper, d);

  // The legs are those that a scene with these lengths would have: 1 kg per litre of each capsule,
  // joints at their ends, bodies in their middles.
  const Eigen::VectorXd p = map->parameters(d);
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  apply_parameters<double>(model, set, p, mechanism);
  const double radius[] = {0.05, 0.035};
  const std::vector<example::FreeLength> lengths = leg_lengths();
  for (std::size_t i = 0; i < 2; ++i) {
    for (const example::Segment& segment : lengths[i].segments) {
      const double length = d[static_cast<Eigen::Index>(i)];
      const double r = radius[i];
      const double volume = std::numbers::pi * r * r * (length + 4.0 / 3.0 * r);
      EXPECT_NEAR(mechanism.mass[model.find_body(segment.body)], 1000.0 * volume, 1e-12);
      EXPECT_NEAR(p[set.find("joint." + segment.next_joint + ".translation.y")], 0.4 - length,
                  1e-15);
      EXPECT_NEAR(p[set.find("body." + segment.body + ".translation.y")], 0.5 * (0.4 - length),
                  1e-15);
    }
  }
}

TEST(Walker, RepeatsItselfMirrored) {
  const Model model = walker_model();
  EXPECT_EQ(mirror(model), (std::vector<int>{0, 1, 2, 5, 6, 3, 4}));
  constexpr int kSteps = 3;
  TrajectoryValues values;
  values.q = Eigen::MatrixXd::Random(7, kSteps + 1);
  values.qdot = Eigen::MatrixXd::Random(7, kSteps + 1);
  const ConstraintPointer rows = mirrored_periodicity(model, kSteps, 0.4);
  ASSERT_EQ(rows->rows().size(), 14);
  EXPECT_EQ(rows->rows().lower, rows->rows().upper);
  const auto miss = [&] {
    Eigen::VectorXd c(14);
    rows->values(values, c);
    return (c - rows->rows().lower).cwiseAbs().maxCoeff();
  };
  EXPECT_GT(miss(), 0.1);
  for (Eigen::MatrixXd* x : {&values.q, &values.qdot}) {
    x->col(kSteps) << x->col(0).head<3>(), x->col(0).tail<2>(), x->col(0).segment<2>(3);
  }
  values.q(0, kSteps) += 0.4;
  EXPECT_LT(miss(), 1e-15);
  values.qdot(4, kSteps) += 0.01;
  EXPECT_NEAR(miss(), 0.01, 1e-15);
}

/// Of the whole program that Ipopt gets, contact included.
TEST(Walker, HasTheDerivativesThatDifferencesGive) {
  const Plan plan = coarse_plan(6, 0.3);
  TrajectoryProblem problem = walker_problem(plan, Aim::kCostOfTransport);
  // Differences go 1e-2 of these sizes: contacts neither begin nor end there.
  problem.q_scale = Eigen::VectorXd::Constant(7, 1e-2);
  problem.qdot_scale = Eigen::VectorXd::Constant(7, 0.1);
  TranscriptionOptions options{.formulation = Formulation::kAllAtOnce};
  options.q_guess = first_guess(plan, problem.horizon.model());
  const auto program = transcribe(problem, options);
  Eigen::VectorXd x = program->variables().start;
  const Eigen::Index first = program->input_variables().control_place(0);
  x.segment(first, 4 * plan.steps).setConstant(0.3);
  const solvers::GradientCheck gradients = solvers::check_gradients(*program, x);
  EXPECT_LT(gradients.gap, 1e-5) << gradients.gap_name;
  const solvers::HessianCheck hessian = solvers::check_hessian(*program, x);
  EXPECT_LT(hessian.gap, 1e-5) << hessian.gap_name;
  EXPECT_NEAR(hessian.slope, 3.0, 0.1) << hessian.slope_name;
}

/// The first stage, coarsely: a gait from a guess that obeys no dynamics.
TEST(Walker, FindsAGaitThatSimulationRepeats) {
  Plan plan = coarse_plan(20, 0.3);
  plan.speed = 0.8;
  const TrajectoryProblem problem = walker_problem(plan, Aim::kFollowGuess);
  TranscriptionOptions options{.formulation = Formulation::kAllAtOnce};
  options.q_guess = first_guess(plan, problem.horizon.model());
  const auto program = transcribe(problem, options);
  solvers::IpoptOptions ipopt = ipopt_options(Aim::kFollowGuess, nullptr);
  ipopt.tolerance = 1e-9;  // walking without balance multiplies what is left of the equations
  const solvers::IpoptResult result = solve_with_ipopt(*program, ipopt);
  ASSERT_TRUE(result.converged()) << result.message;
  const Gait gait =
      examine(plan, problem, program->trajectory_values(result.x), program->design(result.x));
  EXPECT_LT(gait.solution.q, 1e-6);
  EXPECT_LT(gait.half.q, 1e-6);
  EXPECT_LT(gait.whole.q, 1e-4);
  // Feet push, never pull, and take turns.
  EXPECT_GE(gait.load.minCoeff(), 0.0);
  EXPECT_GT(gait.load(0, 15), 0.5 * gait.weight);
  EXPECT_EQ(gait.load(1, 15), 0.0);
  EXPECT_GT(gait.load(1, 35), 0.5 * gait.weight);
  EXPECT_EQ(gait.load(0, 35), 0.0);
  EXPECT_LE(gait.friction_use, 0.8);
}

}  // namespace
}  // namespace hbar::walker
