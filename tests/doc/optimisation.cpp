// The snippets of doc/optimisation.md, run on the arm and the box of examples/scenes.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "hbar/hbar.h"
#include "hbar/ipopt.h"
#include "tests/doc/example_model.h"

namespace hbar {
namespace {

/// The arm's hand is to be at a point after 0.4 s, with little effort. The first variable is the
/// mass of the payload, which is held.
std::unique_ptr<Transcription> reach_program(double payload) {
  constexpr int kSteps = 20;
  const Model model = testing::example_model("arm.xml");
  const auto parameters = ParameterSet::named(model, {"body.payload.mass"});
  TrajectoryProblem problem{
      .horizon = Horizon(model, parameters, {.integrator = "bdf2", .h = 0.02, .steps = kSteps}),
      .map = affine_map(design_variables({{.name = "payload",
                                           .unit = "kg",
                                           .start = payload,
                                           .lower = payload,
                                           .upper = payload}}),
                        Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Identity(1, 1)),
      .objective = Objective(effort()),
      .constraints = {variable_at_step(model, "hand", kSteps, {0.5, 0.12, 0.05})}};
  problem.controls.hold = 2;
  problem.controls.lower = Eigen::VectorXd::Constant(model.control_count(), -1.0);
  problem.controls.upper = Eigen::VectorXd::Constant(model.control_count(), 1.0);
  return transcribe(problem, {.formulation = Formulation::kAllAtOnce});
}

constexpr double kPayload = 0.9;  // kg

TEST(OptimisationPage, PassesOptionsToIpopt) {
  const auto program = reach_program(kPayload);

  solvers::IpoptOptions options;
  options.hessian = solvers::HessianKind::kExact;
  options.number_options["mu_init"] = 1e-2;
  options.string_options["mu_strategy"] = "adaptive";
  options.integer_options["max_soc"] = 0;
  const auto result = solvers::solve_with_ipopt(*program, options);

  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_LT(result.violation.relative, 1e-6);
  EXPECT_GT(result.evaluations.hessian, 0);
}

TEST(OptimisationPage, MeasuresWhatTheStateDoesNotSay) {
  const Model model = testing::example_model("rotate_box.xml");

  const Horizon horizon(
      model, {},
      {.integrator = "bdf1",
       .h = 0.005,
       .steps = 40,
       .measurements = {
           PointVelocity{.name = "tip velocity", .link = model.find_link("tip")},
           ContactForce{.name = "floor", .contact = model.find_contact("box-ground")}}});
  const ValuePlace load = place::measured(horizon, "floor.normal", 40);

  EXPECT_EQ(load.field, ValueField::kMeasured);
  EXPECT_EQ(load.index, horizon.measured_index("floor.normal"));
  const Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();
  const TrajectoryValues values = read_values(horizon, trajectory);
  const double weight = model.link(model.find_link("box")).body.mass * 9.81;
  EXPECT_NEAR(values.measured(load.index, load.step), weight, 1e-3 * weight);
}

TEST(OptimisationPage, StartsWarm) {
  const auto program = reach_program(kPayload);
  solvers::IpoptOptions options;
  options.hessian = solvers::HessianKind::kExact;
  const auto earlier = solvers::solve_with_ipopt(*program, options);
  ASSERT_TRUE(earlier.converged()) << earlier.message;

  options.warm_start = earlier.point();  // x, λ, z_L, z_U, mu

  const auto result = solvers::solve_with_ipopt(*program, options);
  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_LE(result.iterations, 3);
  EXPECT_GT(earlier.iterations, 3);
}

/// Solves to the last digits, for differences.
solvers::IpoptResult solve_exactly(Transcription& program) {
  return solvers::solve_with_ipopt(program,
                                   {.tolerance = 1e-11, .hessian = solvers::HessianKind::kExact});
}

TEST(OptimisationPage, KnowsHowAnOptimumMoves) {
  const auto program = reach_program(kPayload);
  const auto result = solve_exactly(*program);
  ASSERT_TRUE(result.converged()) << result.message;

  constexpr int kPayloadIndex = 0;  // in x, which begins with the design variables
  const auto by_payload =
      solvers::sensitivity_of_optimum(*program, result.point(), {kPayloadIndex});
  const double effort_per_kg = by_payload.df_dtheta[0];  // dx_dtheta, dlambda_dtheta likewise

  const double step = 1e-2 * kPayload;
  const auto above = solve_exactly(*reach_program(kPayload + step));
  const auto below = solve_exactly(*reach_program(kPayload - step));
  ASSERT_TRUE(above.converged() && below.converged());
  const double df = (above.objective - below.objective) / (2.0 * step);
  EXPECT_NEAR(effort_per_kg, df, 1e-3 * std::abs(df));
  const Eigen::VectorXd dx = (above.x - below.x) / (2.0 * step);
  EXPECT_LT((by_payload.dx_dtheta.col(0) - dx).norm(), 1e-2 * dx.norm());
}

}  // namespace
}  // namespace hbar
