// The same problem by shooting, multiple shooting and all-at-once, with every Hessian.
#include <gtest/gtest.h>

#include <cmath>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/model/model_builder.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "hbar/solvers/nlp/ipopt_derivatives.h"

namespace hbar {
namespace {

using solvers::HessianKind;
using solvers::IpoptResult;

/// Two links with a motor each; the lower one's place on the upper one may be chosen.
Model two_links() {
  ModelBuilder builder("two links");
  const Joint shoulder{.name = "shoulder", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}, .damping = 0.02};
  const int upper = builder.add_link(-1, shoulder,
                                     solid_body("upper", Cuboid{{0.4, 0.05, 0.05}}, 400.0,
                                                {Eigen::Matrix3d::Identity(), {0.2, 0.0, 0.0}}));
  const Joint elbow{.name = "elbow",
                    .kind = RevoluteJoint{{0.0, 1.0, 0.0}},
                    .X_PJ = {Eigen::Matrix3d::Identity(), {0.4, 0.0, 0.0}},
                    .damping = 0.02};
  const int lower = builder.add_link(upper, elbow,
                                     solid_body("lower", Cuboid{{0.4, 0.05, 0.05}}, 400.0,
                                                {Eigen::Matrix3d::Identity(), {0.2, 0.0, 0.0}}));
  builder.add_motor({.link = upper, .kind = Motor::Kind::kForce});
  builder.add_motor({.link = lower, .kind = Motor::Kind::kForce});
  builder.add_end_effector({.name = "tip", .link = lower, .position = {0.2, 0.0, 0.0}});
  return builder.build();
}

constexpr int kReachSteps = 24;
constexpr int kReachSegments = 4;

/// To a point in space and to rest there, with little effort, power limited; the forearm may be
/// shifted, and the first posture is free within bounds.
TrajectoryProblem reach_problem() {
  const Model model = two_links();
  const ParameterSet set =
      ParameterSet::named(model, {"joint.elbow.translation.x", "body.lower.mass"});
  SimulationOptions options;
  options.integrator = "bdf2";
  options.h = 0.03;
  options.steps = kReachSteps;
  options.newton.rtol = 1e-13;
  options.restarts = segment_starts(kReachSteps, kReachSegments);
  options.measurements = {MotorPower{"shoulder power", 0}};
  TrajectoryProblem out{.horizon = Horizon(model, set, options),
                        .map = parameter_map(set),
                        .objective = Objective(effort(0.1)),
                        .constraints = {},
                        .controls = {},
                        .q0 = Eigen::Vector2d(0.9, 0.4),
                        .qdot0 = Eigen::Vector2d::Zero(),
                        .design_weight = 0.05};
  out.objective.add(squared_velocity(0.05)).add(control_smoothness(1e-4));
  out.controls.hold = 2;
  out.controls.scale = Eigen::Vector2d::Ones();  // one-sided differences want small steps
  out.controls.lower = Eigen::Vector2d::Constant(-25.0);
  out.controls.upper = Eigen::Vector2d::Constant(25.0);
  out.constraints = {variable_at_step(model, "tip", kReachSteps, {0.45, 0.0, 0.35}),
                     rate_limits(model, 0, {kReachSteps}, 0.0, 0.0),
                     rate_limits(model, 1, {kReachSteps}, 0.0, 0.0),
                     value_limits("shoulder power", ValueField::kMeasured,
                                  out.horizon.measured_index("shoulder power"),
                                  step_range(1, kReachSteps, 3), -20.0, 20.0)};
  out.initial = InitialStateBounds{Eigen::Vector2d(0.7, 0.2), Eigen::Vector2d(1.1, 0.6),
                                   Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  return out;
}

TranscriptionOptions options_of(Formulation formulation) {
  return {.formulation = formulation, .segments = kReachSegments, .threads = 2};
}

IpoptResult solve(Transcription& nlp, HessianKind hessian) {
  solvers::IpoptOptions options;
  options.hessian = hessian;
  options.tolerance = 1e-10;
  options.constraint_tolerance = 1e-10;
  options.max_iterations = 400;
  options.number_options["bound_relax_factor"] = 0.0;
  return solvers::solve_with_ipopt(nlp, options);
}

struct Way {
  Formulation formulation = Formulation::kShooting;
  HessianKind hessian = HessianKind::kExact;
};

class EveryFormulation : public ::testing::TestWithParam<Way> {};

TEST_P(EveryFormulation, ReachesTheSameOptimum) {
  const TrajectoryProblem problem = reach_problem();
  const auto reference = transcribe(problem, options_of(Formulation::kShooting));
  const IpoptResult expected = solve(*reference, HessianKind::kExact);
  ASSERT_TRUE(expected.converged()) << expected.message;
  const auto nlp = transcribe(problem, options_of(GetParam().formulation));
  const IpoptResult result = solve(*nlp, GetParam().hessian);
  ASSERT_TRUE(result.converged()) << result.message;
  const Eigen::Index head = nlp->input_variables().size();
  EXPECT_NEAR(result.objective, expected.objective, 1e-8 * std::abs(expected.objective));
  EXPECT_LT((result.x.head(head) - expected.x).lpNorm<Eigen::Infinity>(),
            1e-6 * expected.x.lpNorm<Eigen::Infinity>());
  EXPECT_LT((nlp->trajectory_values(result.x).q - reference->trajectory_values(expected.x).q)
                .lpNorm<Eigen::Infinity>(),
            1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryFormulation,
    ::testing::Values(Way{Formulation::kShooting, HessianKind::kLimitedMemory},
                      Way{Formulation::kShooting, HessianKind::kGaussNewton},
                      Way{Formulation::kMultipleShooting, HessianKind::kExact},
                      Way{Formulation::kMultipleShooting, HessianKind::kGaussNewton},
                      Way{Formulation::kAllAtOnce, HessianKind::kExact},
                      Way{Formulation::kAllAtOnce, HessianKind::kGaussNewton}));

TEST(EveryFormulation, PassesIpoptsOwnDerivativeChecker) {
  for (const Formulation formulation :
       {Formulation::kShooting, Formulation::kMultipleShooting, Formulation::kAllAtOnce}) {
    const auto nlp = transcribe(reach_problem(), options_of(formulation));
    const solvers::IpoptDerivativeTest test =
        solvers::test_derivatives_with_ipopt(*nlp, HessianKind::kExact, 1e-4, 1e-6);
    EXPECT_EQ(test.errors, 0) << name_of(formulation) << '\n' << test.text;
  }
}

}  // namespace
}  // namespace hbar
