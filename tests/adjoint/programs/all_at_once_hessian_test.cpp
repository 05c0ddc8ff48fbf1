// The pattern of the Hessian of AllAtOnce, and its Gauss-Newton part.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <string>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/programs/all_at_once.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/dense_nlp.h"

namespace hbar {
namespace {

using solvers::HessianKind;

const TranscriptionOptions kBending{.formulation = Formulation::kAllAtOnce};

struct BendingSubject {
  std::string name;
  TrajectoryProblem (*make)();
};

/// Few steps, rows of every sort of number that bends, and a motor's gain among the parameters.
TrajectoryProblem bending_problem(const std::string& integrator, bool free_state, int steps = 3) {
  TrajectoryProblem problem = testing::small_transcription(integrator, 6, free_state);
  const Model model = problem.horizon.model();
  const ParameterSet set =
      ParameterSet::named(model, {"joint.hinge.translation.x", "body.hand.mass", "motor.ball.P"});
  SimulationOptions options = problem.horizon.options();
  options.steps = steps;
  options.measurements = {
      PointVelocity{"speed", model.find_link("arm"), {0.1, 0.0, 0.05}},
      BodyDistance{"gap", model.find_link("hand"), {0.0, 0.1, 0.0}, 0.1, model.find_link("weight")},
      MotorTorque{"torque", 1},
      MotorPower{"power", 0},
      MotorPower{"power again", 0},
      CentreOfMass{"centre"}};
  problem.horizon = Horizon(model, set, options);
  problem.map = parameter_map(set);
  problem.objective = Objective(squared_variables(0.1));
  problem.objective.add(effort(0.2)).add(squared_velocity(0.3));
  problem.constraints = {testing::every_number(problem.horizon)};
  problem.controls.hold = 2;
  problem.controls.start = problem.controls.start.leftCols(1).eval();
  return problem;
}

const std::vector<BendingSubject>& bending_subjects() {
  static const std::vector<BendingSubject> all = {
      {"Bdf1", [] { return bending_problem("bdf1", false); }},
      {"Sdirk2Free", [] { return bending_problem("sdirk2", true); }},
      {"Bdf2Free", [] { return bending_problem("bdf2", true); }}};
  return all;
}

/// ∂L/∂x.                                                                       [n]
Eigen::VectorXd lagrangian_gradient(AllAtOnce& whole, const Eigen::VectorXd& x,
                                    const Eigen::VectorXd& lambda) {
  return testing::gradient_of(whole, x) + testing::dense_jacobian(whole, x).transpose() * lambda;
}

class BendingPattern : public ::testing::TestWithParam<BendingSubject> {};

/// A variable moves no entry of the Lagrangian's gradient that the pattern does not name, and the
/// others as the Hessian says.
TEST_P(BendingPattern, LeavesNothingOut) {
  AllAtOnce whole(GetParam().make(), kBending);
  const Eigen::VectorXd x = testing::near_start(whole, 0.05, 12);
  const Eigen::Index n = x.size();
  const Eigen::VectorXd lambda = testing::Random(13).vector(whole.constraint_limits().lower.size());
  const Eigen::MatrixXd lower =
      testing::places_of(whole.hessian_pattern(HessianKind::kExact), n, n);
  const Eigen::VectorXd gradient = lagrangian_gradient(whole, x, lambda);
  const Eigen::MatrixXd H = testing::dense_hessian(whole, x, 1.0, lambda, HessianKind::kExact);
  const Eigen::VectorXd d = testing::Random(17).vector(n, 0.1);
  const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    return lagrangian_gradient(whole, x + e[0] * d, lambda);
  };
  EXPECT_LT(testing::relative_gap(H * d, testing::differences(along, Eigen::VectorXd::Zero(1))),
            1e-7);
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::VectorXd moved = x;
    moved[j] += 0.01 * std::min(whole.variables().scale[j], 1.0);
    const Eigen::VectorXd there = lagrangian_gradient(whole, moved, lambda);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (lower(std::max(i, j), std::min(i, j)) == 0.0) {
        EXPECT_NEAR(there[i], gradient[i], 1e-13 * testing::largest(gradient))
            << whole.variables().names[static_cast<std::size_t>(i)] << " and "
            << whole.variables().names[static_cast<std::size_t>(j)];
      }
    }
  }
}

/// Whether a variable is a translation: no second derivative by two of them is left but rounding,
/// which may be none, as a displacement of everything changes no force.
bool is_translation(const std::string& name) {
  return name.starts_with("slider at ") || name.starts_with("base.x at ") ||
         name.starts_with("base.y at ") || name.starts_with("base.z at ");
}

/// Every entry but those by design variables and the initial state, and between translations, is
/// non-zero at some of a few points. (The SDIRK2 inner stages, at which nothing is measured, have
/// the pattern of the others.)
TEST_P(BendingPattern, NamesNoPairInVain) {
  AllAtOnce whole(GetParam().make(), kBending);
  const Eigen::Index n = whole.variables().start.size();
  const Eigen::Index designs = whole.input_variables().design_count();
  const solvers::SparsityPattern& pattern = whole.hessian_pattern(HessianKind::kExact);
  Eigen::VectorXd values(static_cast<Eigen::Index>(pattern.rows.size()));
  Eigen::VectorXd found = Eigen::VectorXd::Zero(values.size());
  for (unsigned seed = 1; seed < 4; ++seed) {
    const Eigen::VectorXd lambda =
        testing::Random(seed).vector(whole.constraint_limits().lower.size());
    whole.lagrangian_hessian(testing::near_start(whole, 0.3, seed), 0.8, lambda,
                             HessianKind::kExact, values);
    found = found.cwiseMax(values.cwiseAbs());
  }
  ASSERT_GT(n, designs);
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::string& column =
        whole.variables().names[static_cast<std::size_t>(pattern.columns[at])];
    const std::string& row = whole.variables().names[static_cast<std::size_t>(pattern.rows[at])];
    const bool within = column.find(" within ") != std::string::npos;
    if (pattern.columns[at] >= designs && !column.starts_with("initial") && !within &&
        !(is_translation(row) && is_translation(column))) {
      EXPECT_GT(found[i], 0.0) << row << " and " << column;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BendingPattern, ::testing::ValuesIn(bending_subjects()),
                         [](const auto& c) { return c.param.name; });

TEST(AllAtOnceHessian, GrowsAsTheStepsDo) {
  const auto entries = [](int steps) {
    AllAtOnce whole(bending_problem("bdf2", true, steps), kBending);
    return whole.hessian_pattern(HessianKind::kExact).rows.size();
  };
  const std::size_t six = entries(6);
  const std::size_t ten = entries(10);
  EXPECT_GT(ten, six);
  EXPECT_EQ(entries(14) - ten, ten - six);
}

/// Squares of linear numbers leave nothing to curvature where multipliers are zero.
TEST(AllAtOnceHessian, IsGaussNewtonsOfSquaresOfLinearNumbers) {
  TrajectoryProblem problem = bending_problem("sdirk2", true);
  problem.objective = Objective(effort(0.2));
  problem.objective.add(squared_velocity(0.3)).add(squared_final_position(0.4));
  AllAtOnce whole(problem, kBending);
  const Eigen::VectorXd x = testing::near_start(whole, 0.1, 14);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(whole.constraint_limits().lower.size());
  const Eigen::MatrixXd exact = testing::dense_hessian(whole, x, 0.7, none, HessianKind::kExact);
  EXPECT_LT(testing::relative_gap(
                testing::dense_hessian(whole, x, 0.7, none, HessianKind::kGaussNewton), exact),
            1e-14);
  EXPECT_GT(testing::largest(exact), 0.0);
}

TEST(AllAtOnceHessian, OfGaussNewtonIsSemidefiniteWhereTheExactOneIsNot) {
  AllAtOnce whole(bending_problem("bdf2", true), kBending);
  const Eigen::VectorXd x = testing::near_start(whole, 0.1, 15);
  const Eigen::VectorXd lambda = testing::Random(16).vector(whole.constraint_limits().lower.size());
  const auto eigenvalues = [&](HessianKind kind) -> Eigen::VectorXd {
    const Eigen::MatrixXd H = testing::dense_hessian(whole, x, 0.7, lambda, kind);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(H, Eigen::EigenvaluesOnly).eigenvalues();
  };
  const Eigen::VectorXd gauss_newton = eigenvalues(HessianKind::kGaussNewton);
  EXPECT_GT(gauss_newton.minCoeff(), -1e-13 * gauss_newton.maxCoeff());
  const Eigen::VectorXd exact = eigenvalues(HessianKind::kExact);
  EXPECT_LT(exact.minCoeff(), -1e-6 * exact.maxCoeff());
}

}  // namespace
}  // namespace hbar
