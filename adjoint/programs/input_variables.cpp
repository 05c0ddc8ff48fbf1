#include "hbar/adjoint/programs/input_variables.h"

#include <limits>

#include "hbar/adjoint/programs/state_variables.h"
#include "hbar/adjoint/terms/value_access.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/nlp/scaled_nlp.h"

namespace hbar {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Appends entries to a list of variables.
void append(solvers::NlpVariables& all, const Eigen::VectorXd& start, const Eigen::VectorXd& lower,
            const Eigen::VectorXd& upper, const Eigen::VectorXd& scale) {
  const Eigen::Index size = all.start.size();
  const Eigen::Index more = start.size();
  for (Eigen::VectorXd* vector : {&all.start, &all.lower, &all.upper, &all.scale}) {
    vector->conservativeResize(size + more);
  }
  all.start.tail(more) = start;
  all.lower.tail(more) = lower;
  all.upper.tail(more) = upper;
  all.scale.tail(more) = scale;
}

void require_map(const TrajectoryProblem& problem) {
  require_given("TrajectoryProblem", "map from designs to parameters", problem.map);
  const Eigen::Index count = problem.map->parameter_count();
  if (count != problem.horizon.parameters().size()) {
    throw InvalidInput(concat("TrajectoryProblem: the map has ", count,
                              " parameters; the horizon has ",
                              problem.horizon.parameters().size()));
  }
  const std::vector<std::string> names = problem.map->parameter_names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& own = problem.horizon.parameters()[static_cast<int>(k)].name;
    if (names[k] != own) {
      throw InvalidInput(
          concat("TrajectoryProblem: the map is of another parameter set: parameter ", k, " is ",
                 names[k], " there and ", own, " in the horizon"));
    }
  }
  for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
    require_given("TrajectoryProblem", concat("constraint ", i), problem.constraints[i]);
  }
}

}  // namespace

InputVariables::InputVariables(const TrajectoryProblem& problem) : problem_(problem) {
  require_map(problem);
  if (problem.controls.hold < 1) {
    throw InvalidInput(
        concat("TrajectoryProblem: controls.hold is ", problem.controls.hold, "; it must be ≥ 1"));
  }
  if (!(problem.design_weight >= 0.0)) {
    throw InvalidInput(
        concat("TrajectoryProblem: design_weight is ", problem.design_weight, "; it must be ≥ 0"));
  }
  const int hold = problem.controls.hold;
  blocks_ = (problem.horizon.options().steps + hold - 1) / hold;
  control_count_ = problem.horizon.model().control_count();
  design_count_ = problem.map->variables().size();
  describe_design_and_controls();
  describe_state();
}

void InputVariables::describe_design_and_controls() {
  const DesignVariables& design = problem_.map->variables();
  const HeldControls& held = problem_.controls;
  append(variables_, design.start, design.lower, design.upper, design.scale);
  designs_of_.resize(static_cast<std::size_t>(problem_.map->parameter_count()));
  for (std::size_t p = 0; p < designs_of_.size(); ++p) {
    for (Eigen::Index i = 0; i < design_count_; ++i) {
      if (problem_.map->depends(static_cast<Eigen::Index>(p), i)) {
        designs_of_[p].push_back(i);
      }
    }
  }
  variables_.names = design.names;
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(control_count_, blocks_);
  if (held.start.size() > 0) {
    if (held.start.rows() != control_count_ ||
        (held.start.cols() != blocks_ && held.start.cols() != 1)) {
      throw InvalidInput(concat("TrajectoryProblem: controls.start is ", held.start.rows(), " x ",
                                held.start.cols(), "; it must be ", control_count_, " x ", blocks_,
                                " or ", control_count_, " x 1"));
    }
    start = held.start.cols() == blocks_ ? held.start : held.start.replicate(1, blocks_);
  }
  const auto repeated = [&](const Eigen::VectorXd& vector, double value, const char* name) {
    return vector.size() == start.size()
               ? vector
               : Eigen::VectorXd(filled(vector, control_count_, value, name).replicate(blocks_, 1));
  };
  const Eigen::VectorXd lower = repeated(held.lower, -kUnbounded, "controls.lower");
  const Eigen::VectorXd upper = repeated(held.upper, kUnbounded, "controls.upper");
  const Eigen::VectorXd flat = start.reshaped();
  append(variables_, flat, lower, upper,
         held.scale.size() == 0 ? solvers::scale_from_bounds(lower, upper, flat)
                                : repeated(held.scale, 1.0, "controls.scale"));
  for (int b = 0; b < blocks_; ++b) {
    for (int i = 0; i < control_count_; ++i) {
      variables_.names.push_back(concat("control.", problem_.horizon.model().control_name(i),
                                        " from step ", b * held.hold));
    }
  }
}

void InputVariables::describe_state() {
  const Model& model = problem_.horizon.model();
  const Eigen::VectorXd q0 = filled(problem_.q0, model.dof(), 0.0, "q0");
  const Eigen::VectorXd qdot0 = filled(problem_.qdot0, model.dof(), 0.0, "qdot0");
  const Eigen::VectorXd q_scale = filled(problem_.q_scale, model.dof(), 1.0, "q_scale");
  const Eigen::VectorXd qdot_scale = filled(problem_.qdot_scale, model.dof(), 1.0, "qdot_scale");
  if (!state_is_free()) {
    return;
  }
  const InitialStateBounds& bounds = *problem_.initial;
  const auto bound = [&](const Eigen::VectorXd& vector, double value, const char* name) {
    return filled(vector, model.dof(), value, name);
  };
  append(variables_, q0, bound(bounds.q_lower, -kUnbounded, "initial.q_lower"),
         bound(bounds.q_upper, kUnbounded, "initial.q_upper"), q_scale);
  append(variables_, qdot0, bound(bounds.qdot_lower, -kUnbounded, "initial.qdot_lower"),
         bound(bounds.qdot_upper, kUnbounded, "initial.qdot_upper"), qdot_scale);
  for (const std::string& name : state_names(model)) {
    variables_.names.push_back("initial " + name);
  }
}

Inputs InputVariables::inputs(const Eigen::VectorXd& x) const {
  if (x.size() < size()) {
    throw InvalidInput(
        concat("TrajectoryProblem: x has ", x.size(), " entries; it must have ", size()));
  }
  const int dof = problem_.horizon.model().dof();
  const int steps = problem_.horizon.options().steps;
  Inputs out{problem_.map->parameters(design(x)), Eigen::MatrixXd(control_count_, steps),
             filled(problem_.q0, dof, 0.0, "q0"), filled(problem_.qdot0, dof, 0.0, "qdot0")};
  for (int k = 0; k < steps; ++k) {
    out.u.col(k) = x.segment(control_place(block_of_step(k)), control_count_);
  }
  if (state_is_free()) {
    out.q0 = x.segment(state_place(), dof);
    out.qdot0 = x.segment(state_place() + dof, dof);
  }
  round_into_range(problem_.horizon.parameters(), out.p);
  return out;
}

void InputVariables::add_pull_back(const Gradient& gradient, const Eigen::MatrixXd& map_jacobian,
                                   Eigen::Ref<Eigen::VectorXd> out) const {
  out.head(design_count_) += map_jacobian.transpose() * gradient.p;
  for (int k = 0; k < gradient.u.cols(); ++k) {
    out.segment(control_place(block_of_step(k)), control_count_) += gradient.u.col(k);
  }
  if (state_is_free()) {
    const Eigen::Index dof = gradient.q0.size();
    out.segment(state_place(), dof) += gradient.q0;
    out.segment(state_place() + dof, dof) += gradient.qdot0;
  }
}

double InputVariables::design_cost(const Eigen::VectorXd& x) const {
  const DesignVariables& d = problem_.map->variables();
  return 0.5 * problem_.design_weight * (design(x) - d.start).cwiseQuotient(d.scale).squaredNorm();
}

void InputVariables::add_design_cost_gradient(const Eigen::VectorXd& x,
                                              Eigen::Ref<Eigen::VectorXd> out) const {
  const DesignVariables& d = problem_.map->variables();
  out.head(design_count_) +=
      problem_.design_weight * (design(x) - d.start).cwiseQuotient(d.scale.cwiseAbs2());
}

double InputVariables::design_cost_curvature(Eigen::Index i) const {
  const double scale = problem_.map->variables().scale[i];
  return problem_.design_weight / (scale * scale);
}

void InputVariables::require_places(const ConstraintTerm& term) const {
  const TrajectoryValues shape = value_shape(problem_.horizon);
  for (const PartialPlace& place : term.places()) {
    const bool timeless = place.field == ValueField::kP;
    if (place.index >= field_rows(shape, place.field) ||
        (!timeless && place.step >= field_columns(shape, place.field))) {
      throw InvalidInput(
          concat("constraint '", term.rows().names[static_cast<std::size_t>(place.row)], "' reads ",
                 place_name(place.place()), "; there are ", field_rows(shape, place.field), " x ",
                 field_columns(shape, place.field), " of ", field_name(place.field)));
    }
  }
}

}  // namespace hbar
