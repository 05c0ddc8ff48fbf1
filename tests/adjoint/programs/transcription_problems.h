#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/programs/trajectory_problem.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/generic_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "tests/support/numerics.h"
#include "tests/support/small_problems.h"

namespace hbar::testing {

/// A problem of a simulation with parameters of every kind but few scalars, whose terms read every
/// field, with and without second partials, in one step and across steps, and whose initial state
/// is optimised if `free_state`.
[[nodiscard]] inline TrajectoryProblem every_field_problem(Problem problem,
                                                           const std::vector<std::string>& names,
                                                           std::vector<Measurement> measurements,
                                                           bool free_state) {
  const Model model = problem.horizon.model();
  ParameterSet set = ParameterSet::named(model, names);
  SimulationOptions options = problem.horizon.options();
  options.measurements = std::move(measurements);
  const int steps = options.steps;
  TrajectoryProblem out{.horizon = Horizon(model, set, options),
                        .map = inertia_chart(set),
                        .objective = problem.objective,
                        .constraints = {},
                        .controls = {},
                        .q0 = problem.inputs.q0,
                        .qdot0 = problem.inputs.qdot0,
                        .design_weight = 0.3};
  out.controls.hold = 3;
  const int blocks = (steps + 2) / 3;
  out.controls.start = problem.inputs.u.leftCols(blocks);
  out.objective.add(control_smoothness(0.1)).add(squared_measured(0.02));
  out.objective.add(generic_term("gait",
                                 {{ValueField::kQ, steps, 6},
                                  {ValueField::kMeasured, steps - 1, 1},
                                  {ValueField::kQdot, 2, 6}},
                                 [](const auto& x) { return x[0] * x[1] * x[2]; }));
  out.constraints = {
      variable_limits(model, model.end_effectors()[0].name, {0, 3, steps},
                      Eigen::Vector3d::Constant(-3.0), Eigen::Vector3d::Constant(3.0)),
      rate_limits(model, 6, step_range(1, steps, 3), -5.0, 5.0), periodicity(model, steps, {6}),
      coordinate_limits(model, 7, {0, steps}, -3.0, 3.0)};
  const MeasuredRows& own = out.horizon.measured_rows();
  for (int row = static_cast<int>(own.variables + own.tactile); row < out.horizon.measured_count();
       ++row) {
    out.constraints.push_back(
        value_limits(concat("measured ", row), ValueField::kMeasured, row, {0, 4}, -90.0, 90.0));
  }
  const GenericRow power{
      "power",
      -9.0,
      9.0,
      {{ValueField::kU, 4, 0}, {ValueField::kQdot, 5, 6}, {ValueField::kP, 0, 0}},
      [](const auto& x) { return x[0] * x[1] * (1.0 + x[2]); }};
  out.constraints.push_back(generic_constraint({power}));
  if (free_state) {
    out.initial = InitialStateBounds{};
    out.initial->q_lower = out.q0.array() - 1.0;
    out.initial->q_upper = out.q0.array() + 1.0;
  }
  return out;
}

/// The small model: no contact, motors of every kind.
[[nodiscard]] inline TrajectoryProblem small_transcription(const std::string& integrator, int steps,
                                                           bool free_state) {
  Problem problem = make_problem(small_model(), integrator, 0.02, steps);
  const int hand = problem.horizon.model().find_link("hand");
  return every_field_problem(
      std::move(problem),
      {"joint.hinge.translation", "body.arm.inertia", "body.hand.mass", "joint.ball.damping"},
      {PointVelocity{"speed", hand, {0.1, 0.0, 0.05}}, MotorPower{"drive", 0},
       MotorPower{"servo", 1}},
      free_state);
}

/// The contact model pressed together: sticking and sliding points, a field's surface.
[[nodiscard]] inline TrajectoryProblem contact_transcription(const std::string& integrator,
                                                             bool free_state) {
  Problem problem = contact_problem(integrator, 0.002, 9);
  TrajectoryProblem out = every_field_problem(
      std::move(problem), {"joint.shoulder.translation", "body.upper.mass", "joint.elbow.damping"},
      {ContactForce{"grip", 0}, CentreOfMass{"com"}}, free_state);
  // Checks step by shares of these: none makes a point begin to touch or to slide.
  const Eigen::Index dof = out.q0.size();
  out.q_scale = Eigen::VectorXd::Constant(dof, 1e-4);
  out.qdot_scale = Eigen::VectorXd::Constant(dof, 1e-2);
  return out;
}

}  // namespace hbar::testing
