#include "hbar/adjoint/programs/value_dependence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "hbar/adjoint/programs/all_at_once.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/dense_nlp.h"

namespace hbar {
namespace {

const TranscriptionOptions kDeclaring{.formulation = Formulation::kAllAtOnce};

constexpr std::array<const char*, 3> kBaseShifts = {"base.x", "base.y", "base.z"};

struct DeclaringSubject {
  std::string name;
  TrajectoryProblem (*make)();
};

/// A row for every number of the trajectory, some of measurements of every kind.
TrajectoryProblem reading_everything(TrajectoryProblem problem, std::vector<Measurement> more) {
  SimulationOptions options = problem.horizon.options();
  options.steps = 4;
  options.measurements = std::move(more);
  problem.horizon = Horizon(problem.horizon.model(), problem.horizon.parameters(), options);
  problem.objective = Objective(squared_velocity(0.1));
  problem.constraints = {testing::every_number(problem.horizon)};
  problem.controls.start = problem.controls.start.leftCols(2).eval();
  return problem;
}

TrajectoryProblem reading_small_model(const std::string& integrator, bool free_state) {
  TrajectoryProblem problem = testing::small_transcription(integrator, 4, free_state);
  const Model model = problem.horizon.model();
  const int hand = model.find_link("hand");
  const int weight = model.find_link("weight");
  const Plane floor{{0.0, 0.0, -1.0}, Eigen::Vector3d(0.1, 0.2, 0.9).normalized()};
  return reading_everything(
      std::move(problem),
      {PointVelocity{"speed", model.find_link("arm"), {0.1, 0.0, 0.05}}, Orientation{"turn", hand},
       BodyDistance{"gap", hand, {0.0, 0.1, 0.0}, 0.1, weight},
       BodyDistance{"height", weight, {0.0, 0.1, 0.0}, 0.1, -1, floor}, MotorTorque{"drive", 0},
       MotorTorque{"ball torque", 1}, MotorPower{"slider power", 2}, CentreOfMass{"centre"},
       LinearMomentum{"momentum"}});
}

TrajectoryProblem reading_contact_model() {
  TrajectoryProblem problem = testing::contact_transcription("bdf2", true);
  return reading_everything(std::move(problem), {ContactForce{"grip", 0}, ContactForce{"press", 2},
                                                 MotorPower{"shoulder", 0}});
}

const std::vector<DeclaringSubject>& declaring_subjects() {
  static const std::vector<DeclaringSubject> all = {
      {"Bdf1", [] { return reading_small_model("bdf1", false); }},
      {"Sdirk2Free", [] { return reading_small_model("sdirk2", true); }},
      {"Bdf2Free", [] { return reading_small_model("bdf2", true); }},
      {"ContactBdf2", [] { return reading_contact_model(); }}};
  return all;
}

bool is_base_shift(const std::string& variable) {
  return std::any_of(kBaseShifts.begin(), kBaseShifts.end(),
                     [&](const char* name) { return variable.find(name) != std::string::npos; });
}

class DeclaredDependence : public ::testing::TestWithParam<DeclaringSubject> {};

/// Beside the pattern nothing moves but by rounding, however far a variable does.
TEST_P(DeclaredDependence, LeavesNothingOut) {
  AllAtOnce whole(GetParam().make(), kDeclaring);
  const Eigen::VectorXd x = testing::near_start(whole, 1e-3, 11);
  const Eigen::VectorXd c = testing::constraints_of(whole, x);
  const Eigen::MatrixXd places = testing::places_of(whole.jacobian_pattern(), c.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    Eigen::VectorXd moved = x;
    moved[j] += 0.01 * std::min(whole.variables().scale[j], 1.0);
    const Eigen::VectorXd there = testing::constraints_of(whole, moved);
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      if (places(i, j) == 0.0) {
        EXPECT_NEAR(there[i], c[i], 1e-13 * (1.0 + std::abs(c[i])))
            << whole.constraint_limits().names[static_cast<std::size_t>(i)] << " by "
            << whole.variables().names[static_cast<std::size_t>(j)];
      }
    }
  }
}

/// Every entry but those by design variables is non-zero somewhere near the start: rows declare the
/// controls, coordinates and rates that they read. (Shifting the base changes no velocity and turns
/// nothing; patterns know coordinates, not what sort they are.)
TEST_P(DeclaredDependence, DeclaresNoCoordinateOrControlInVain) {
  AllAtOnce whole(GetParam().make(), kDeclaring);
  if (whole.problem().horizon.model().contact_count() > 0) {
    EXPECT_GT(whole.problem().horizon.measured_count(), 9);  // points that touch nothing read 0
    return;
  }
  const std::vector<std::string>& rows = whole.constraint_limits().names;
  const std::vector<std::string>& variables = whole.variables().names;
  const Eigen::Index own = whole.problem().constraints[0]->rows().size();
  const Eigen::Index designs = whole.input_variables().design_count();
  const auto n = static_cast<Eigen::Index>(variables.size());
  const Eigen::MatrixXd places =
      testing::places_of(whole.jacobian_pattern(), whole.constraint_limits().lower.size(), n);
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(places.rows(), places.cols());
  for (unsigned seed = 1; seed < 4; ++seed) {
    Eigen::VectorXd x = whole.variables().start;
    x.tail(n - designs) = testing::near_start(whole, 0.3, seed).tail(n - designs);
    found = found.cwiseMax(testing::dense_jacobian(whole, x).cwiseAbs());
  }
  for (Eigen::Index i = 0; i < own; ++i) {
    const std::string& row = rows[static_cast<std::size_t>(i)];
    for (Eigen::Index j = designs; j < n; ++j) {
      const std::string& variable = variables[static_cast<std::size_t>(j)];
      const bool shifts_base = row.starts_with("measured") && is_base_shift(variable);
      if (places(i, j) != 0.0 && !shifts_base) {
        EXPECT_GT(found(i, j), 0.0) << row << " by " << variable;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, DeclaredDependence, ::testing::ValuesIn(declaring_subjects()),
                         [](const auto& c) { return c.param.name; });

/// Rows that are asked for one by one, in any order and again, are those of one instant.
TEST(ValueDependence, GivesARowTheSameDerivativesHoweverItIsAskedFor) {
  const TrajectoryProblem problem = reading_contact_model();
  const Horizon& horizon = problem.horizon;
  const InputVariables head(problem);
  const Trajectory trajectory = simulate(horizon, horizon.nominal_inputs()).trajectory();
  const StageLayout layout(head, trajectory.timeline, horizon.model().dof());
  const Eigen::MatrixXd map_jacobian = problem.map->jacobian(problem.map->variables().start);
  const auto derivatives = [&](ValueDependence& at, int row) {
    std::vector<double> out;
    at.derivatives_of({ValueField::kMeasured, 2, row}, out);
    EXPECT_EQ(out.size(), at.columns_of({ValueField::kMeasured, 2, row}).size());
    return out;
  };
  ValueDependence together(horizon, head, layout);
  together.move_to(trajectory, map_jacobian);
  for (int row = 0; row < horizon.measured_count(); ++row) {
    static_cast<void>(derivatives(together, row));
  }
  for (int row = horizon.measured_count(); row-- > 0;) {
    ValueDependence alone(horizon, head, layout);
    alone.move_to(trajectory, map_jacobian);
    EXPECT_EQ(derivatives(together, row), derivatives(alone, row)) << row;
  }
}

}  // namespace
}  // namespace hbar
