// The main example, shortened: the whole way from a scene file to an optimum.

#include <gtest/gtest.h>

#include <algorithm>

#include "examples/common/progress.h"
#include "examples/finger_reach/reach.h"
#include "examples/finger_reach/report.h"
#include "examples/finger_reach/studies.h"
#include "hbar/adjoint/study/trajectory_csv.h"
#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"
#include "hbar/solvers/nlp/gradient_check.h"
#include "hbar/solvers/nlp/ipopt_derivatives.h"
#include "hbar/solvers/nlp/sensitivity.h"

namespace hbar::finger_reach {
namespace {

constexpr const char* kScene = HBAR_SOURCE_DIR "/examples/scenes/finger.xml";
constexpr int kSteps = 60;  // of 50 ms

TEST(FingerReach, MapsItsNominalSizesToTheScenesFinger) {
  const Model model = scene::build_model(scene::read_scene(kScene));
  const ParameterSet set = finger_parameters(model);
  const DesignMapPointer map = finger_map(phalanges(model), set);
  EXPECT_EQ(set.size(), 18);
  EXPECT_LT((map->parameters(map->variables().start) - set.nominal()).norm(), 1e-15);
}

TEST(FingerReach, TakesATipThatIsGiven) {
  const Model model = scene::build_model(scene::read_scene(kScene));
  const ParameterSet set = finger_parameters(model, true);
  const DesignMapPointer map = finger_map(phalanges(model), set, 0.25);
  ASSERT_EQ(map->variables().size(), 7);
  EXPECT_EQ(map->variables().lower[6], 0.25);
  EXPECT_EQ(map->variables().upper[6], 0.25);
  Eigen::VectorXd p = set.nominal();
  p[set.find("body.tip.mass")] += 0.25;
  EXPECT_LT((map->parameters(map->variables().start) - p).norm(), 1e-15);
}

TEST(FingerReach, HasASlendernessWithExactPartials) {
  const Model model = scene::build_model(scene::read_scene(kScene));
  const ParameterSet set = finger_parameters(model);
  const DesignMapPointer map = finger_map(phalanges(model), set);
  Eigen::VectorXd d = map->variables().start;
  d.head<3>() *= 1.1;
  TrajectoryValues values;
  values.p = map->parameters(d);
  const ConstraintPointer term = slenderness(phalanges(model), set, 4.0);
  Eigen::VectorXd c(3);
  term->values(values, c);
  EXPECT_LT((c - 4.0 * d.tail<3>().cwiseQuotient(d.head<3>())).norm(), 1e-14);
  const TermCheck check = check_constraint_term(*term, values);
  EXPECT_TRUE(check.has_second);
  EXPECT_TRUE(check.passed()) << check.gap_name << ' ' << check.second_gap_name;
}

TEST(FingerReach, HasRightGradientsAndJacobians) {
  const Reach reach = make_reach(kScene, {.steps = kSteps});
  solvers::GradientCheckOptions options;
  options.coordinates = false;
  const solvers::GradientCheck check =
      solvers::check_gradients(*reach.problem, reach.problem->variables().start, options);
  EXPECT_LT(check.gap, 1e-6) << check.gap_name;
  EXPECT_GT(check.slope, 1.9) << check.slope_name;
}

TEST(FingerReach, ReachesItsTargetsWithTheLeastEffort) {
  const Reach reach = make_reach(kScene, {.steps = kSteps});
  Transcription& problem = *reach.problem;
  Outcome outcome;
  outcome.start = problem.variables().start;
  outcome.start_objective = problem.objective(outcome.start);
  solvers::IpoptOptions options = ipopt_options(150);
  options.on_iteration = [&](const solvers::IterationInfo& info) {
    outcome.optimised.iterations.push_back(info);
    return true;
  };
  outcome.optimised.result = solvers::solve_with_ipopt(problem, options);
  outcome.optimised.times = problem.times();
  outcome.values = problem.trajectory_values(outcome.optimised.result.x);
  EXPECT_TRUE(outcome.optimised.result.converged()) << outcome.optimised.result.message;
  EXPECT_LT(outcome.optimised.result.iterations, 100);
  EXPECT_LE(outcome.optimised.result.violation.amount, 1e-6)
      << outcome.optimised.result.violation.name;
  EXPECT_LT(tip_errors(reach, outcome.values).maxCoeff(),
            0.01 * finger_length(reach, outcome.optimised.result.x));
  EXPECT_LT(outcome.optimised.result.objective, outcome.start_objective);
  EXPECT_LE(outcome.values.u.cwiseAbs().maxCoeff(), 1.0 + 1e-6);
  const Model& model = problem.problem().horizon.model();
  for (int i = 0; i < 4; ++i) {  // at every step, between the samples too
    const JointLimits& limits = model.link(i).joint.limits.value();
    EXPECT_GE(outcome.values.q.row(i).minCoeff(), limits.lower) << i;
    EXPECT_LE(outcome.values.q.row(i).maxCoeff(), limits.upper) << i;
  }

  const std::string json = result_json(reach, outcome);
  EXPECT_NE(json.find("\"converged\": true"), std::string::npos);
  EXPECT_NE(summary(reach, outcome).find("target 4"), std::string::npos);
  const std::string csv =
      study::trajectory_csv(study::trajectory_names(problem.problem().horizon), outcome.values);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), kSteps + 2);
  const std::string rows = example::iterations_csv(outcome.optimised.iterations);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), outcome.optimised.result.iterations + 2);
}

/// All-at-once with the exact Hessian finds what shooting with L-BFGS finds.
TEST(FingerReach, HasTheSameOptimumAllAtOnce) {
  std::vector<Eigen::VectorXd> found;
  for (const auto& [formulation, hessian] :
       {std::pair{Formulation::kShooting, solvers::HessianKind::kLimitedMemory},
        std::pair{Formulation::kAllAtOnce, solvers::HessianKind::kExact}}) {
    const Reach reach =
        make_reach(kScene, {.steps = kSteps, .transcription = {.formulation = formulation}});
    solvers::IpoptOptions options = ipopt_options();
    options.tolerance = 1e-8;
    options.hessian = hessian;
    const solvers::IpoptResult result = solvers::solve_with_ipopt(*reach.problem, options);
    ASSERT_TRUE(result.converged()) << name_of(formulation) << ": " << result.message;
    found.emplace_back(result.x.head(reach.problem->input_variables().size()));
  }
  EXPECT_LT((found[1] - found[0]).head<6>().lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT((found[1] - found[0]).lpNorm<Eigen::Infinity>(), 1e-4);
}

TEST(FingerReach, PassesIpoptsDerivativeChecker) {
  const Reach reach = make_reach(kScene, {.steps = 12, .blocks = 3});
  const solvers::IpoptDerivativeTest test =
      solvers::test_derivatives_with_ipopt(*reach.problem, solvers::HessianKind::kExact);
  EXPECT_TRUE(test.passed()) << test.text;
}

/// The answer to a payload is the slope between the optima of a finger with more and with less.
TEST(FingerReach, AnswersAPayloadAsItsSensitivitySays) {
  const auto reach_of = [](double payload) {
    return make_reach(kScene, {.steps = kSteps,
                               .transcription = {.formulation = Formulation::kAllAtOnce},
                               .payload = payload});
  };
  const auto solve = [](const Reach& reach) {
    solvers::IpoptOptions options = ipopt_options();
    options.tolerance = 1e-9;
    options.hessian = solvers::HessianKind::kExact;
    return solvers::solve_with_ipopt(*reach.problem, options);
  };
  const Reach reach = reach_of(0.0);
  const solvers::IpoptResult optimum = solve(reach);
  ASSERT_TRUE(optimum.converged()) << optimum.message;
  const solvers::Sensitivity answer =
      solvers::sensitivity_of_optimum(*reach.problem, optimum.point(), {6});
  constexpr double kPayload = 1e-4;
  const solvers::IpoptResult more = solve(reach_of(kPayload));
  const solvers::IpoptResult less = solve(reach_of(-kPayload));
  ASSERT_TRUE(more.converged() && less.converged());
  const double slope = (more.objective - less.objective) / (2.0 * kPayload);
  EXPECT_GT(slope, 0.0);
  EXPECT_NEAR(answer.df_dtheta[0] / slope, 1.0, 1e-3);
  const Eigen::VectorXd moved = (more.x - less.x).head<6>() / (2.0 * kPayload);
  EXPECT_LT((answer.dx_dtheta.col(0).head<6>() - moved).norm(), 1e-2 * moved.norm());
  EXPECT_NE(sensitivity_table(reach, optimum).find("payload"), std::string::npos);
}

TEST(FingerReach, RefusesAnotherScene) {
  EXPECT_THROW(static_cast<void>(make_reach(kScene, {.steps = 61})), InvalidInput);
  EXPECT_THROW(static_cast<void>(
                   make_reach(HBAR_SOURCE_DIR "/examples/scenes/pendulum.xml", {.steps = kSteps})),
               InvalidInput);
}

}  // namespace
}  // namespace hbar::finger_reach
