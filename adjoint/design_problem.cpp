#include "hbar/adjoint/design_problem.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "hbar/core/error.h"

namespace hbar {
namespace {

using Field = PartialPlace::Field;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Adds the time until its end to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  ~Stopwatch() {
    sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  double& sum_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// `vector`, or `count` times `value` if it is empty.
Eigen::VectorXd filled(const Eigen::VectorXd& vector, Eigen::Index count, double value,
                       const char* name) {
  if (vector.size() == 0) {
    return Eigen::VectorXd::Constant(count, value);
  }
  if (vector.size() != count) {
    throw InvalidInput(
        concat("DesignProblem: ", name, " has ", vector.size(), " entries; it must have ", count));
  }
  return vector;
}

/// The tangent of one number of the trajectory along every direction.  [1 x count]
Eigen::RowVectorXd tangent_of(const PartialPlace& place, const Tangents& tangents,
                              const Directions& directions, const TrajectoryValues& values) {
  switch (place.field) {
    case Field::kQ:
      return tangents.q.row(place.step * values.q.rows() + place.index);
    case Field::kQdot:
      return tangents.qdot.row(place.step * values.qdot.rows() + place.index);
    case Field::kV:
      return tangents.v.row(place.step * values.v.rows() + place.index);
    case Field::kTactile:
      return tangents.tactile.row(place.step * values.tactile.rows() + place.index);
    case Field::kMeasured:
      return tangents.measured.row(place.step * values.measured.rows() + place.index);
    case Field::kU:
      return directions.u.row(place.step * values.u.rows() + place.index);
    case Field::kP:
      break;
  }
  return directions.p.row(place.index);
}

}  // namespace

DesignProblem::DesignProblem(DesignProblemParts parts)
    : parts_(std::move(parts)),
      adjoint_(parts_.simulator),
      tangent_(parts_.simulator),
      values_(TrajectoryValues{}) {
  check_parts();
  describe_variables();
  describe_constraints();
}

void DesignProblem::check_parts() {
  const Simulator& simulator = parts_.simulator;
  if (parts_.map == nullptr || parts_.map->parameter_count() != simulator.parameters().size()) {
    throw InvalidInput(concat("DesignProblem: the map has ",
                              parts_.map == nullptr ? 0 : parts_.map->parameter_count(),
                              " parameters; the simulator has ", simulator.parameters().size()));
  }
  if (parts_.controls.hold < 1) {
    throw InvalidInput(
        concat("DesignProblem: controls.hold is ", parts_.controls.hold, "; it must be ≥ 1"));
  }
  if (!(parts_.design_weight >= 0.0)) {
    throw InvalidInput(
        concat("DesignProblem: design_weight is ", parts_.design_weight, "; it must be ≥ 0"));
  }
  const int dof = simulator.model().dof();
  parts_.q0 = filled(parts_.q0, dof, 0.0, "q0");
  parts_.qdot0 = filled(parts_.qdot0, dof, 0.0, "qdot0");
  const int hold = parts_.controls.hold;
  blocks_ = (simulator.options().steps + hold - 1) / hold;
}

void DesignProblem::describe_variables() {
  const DesignVariables& design = parts_.map->variables();
  const Model& model = parts_.simulator.model();
  const Eigen::Index controls = control_count();
  const HeldControls& held = parts_.controls;
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(controls, blocks_);
  if (held.start.size() > 0) {
    if (held.start.rows() != controls || (held.start.cols() != blocks_ && held.start.cols() != 1)) {
      throw InvalidInput(concat("DesignProblem: controls.start is ", held.start.rows(), " x ",
                                held.start.cols(), "; it must be ", controls, " x ", blocks_,
                                " or ", controls, " x 1"));
    }
    start = held.start.cols() == blocks_ ? held.start : held.start.replicate(1, blocks_);
  }
  const auto joined = [&](const Eigen::VectorXd& d, const Eigen::VectorXd& u) {
    Eigen::VectorXd out(d.size() + u.size() * blocks_);
    out << d, u.replicate(blocks_, 1);
    return out;
  };
  variables_.lower = joined(design.lower, filled(held.lower, controls, -kInfinity, "lower"));
  variables_.upper = joined(design.upper, filled(held.upper, controls, kInfinity, "upper"));
  variables_.scale = joined(design.scale, filled(held.scale, controls, 1.0, "scale"));
  variables_.start.resize(variables_.lower.size());
  variables_.start << design.start, start.reshaped();
  variables_.names = design.names;
  for (int b = 0; b < blocks_; ++b) {
    for (int i = 0; i < controls; ++i) {
      variables_.names.push_back(
          concat("control.", model.control_name(i), " from step ", b * held.hold));
    }
  }
}

std::pair<int, int> DesignProblem::blocks_of(const PartialPlace& place) const {
  const int hold = parts_.controls.hold;
  switch (place.field) {
    case Field::kP:
      return {0, 0};
    case Field::kU:
      return {place.step / hold, place.step / hold + 1};
    case Field::kMeasured:  // at step 0 with the first control
      return {0, (std::max(place.step, 1) + hold - 1) / hold};
    default:
      return {0, (place.step + hold - 1) / hold};
  }
}

void DesignProblem::check_place(const ConstraintTerm& term, const PartialPlace& place) const {
  const Model& model = parts_.simulator.model();
  const int steps = parts_.simulator.options().steps;
  int size = model.dof();
  int columns = steps + 1;
  if (place.field == Field::kV) {
    size = model.variable_count();
  } else if (place.field == Field::kTactile) {
    size = model.tactile_count();
  } else if (place.field == Field::kMeasured) {
    size = parts_.simulator.measured_count();
  } else if (place.field == Field::kU) {
    size = model.control_count();
    columns = steps;
  } else if (place.field == Field::kP) {
    size = parts_.simulator.parameters().size();
    columns = std::numeric_limits<int>::max();
  }
  if (place.index >= size || place.step >= columns) {
    throw InvalidInput(concat(
        "constraint '", term.rows().names[static_cast<std::size_t>(place.row)], "' reads number ",
        place.index, " of ", size, " at step ", place.step, " of ", steps));
  }
}

void DesignProblem::describe_constraints() {
  Eigen::Index count = 0;
  for (const ConstraintPointer& term : parts_.constraints) {
    count += term->rows().size();
  }
  limits_.lower.resize(count);
  limits_.upper.resize(count);
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : parts_.constraints) {
    const ConstraintRows& rows = term->rows();
    limits_.lower.segment(first, rows.size()) = rows.lower;
    limits_.upper.segment(first, rows.size()) = rows.upper;
    limits_.names.insert(limits_.names.end(), rows.names.begin(), rows.names.end());
    const auto row_count = static_cast<std::size_t>(rows.size());
    std::vector<std::vector<bool>> reads(
        row_count, std::vector<bool>(static_cast<std::size_t>(blocks_), false));
    for (const PartialPlace& place : term->places()) {
      check_place(*term, place);
      const auto [begin, end] = blocks_of(place);
      for (int b = begin; b < end; ++b) {
        reads[static_cast<std::size_t>(place.row)][static_cast<std::size_t>(b)] = true;
      }
    }
    const auto add = [&](Eigen::Index row, Eigen::Index column) {
      pattern_.rows.push_back(static_cast<int>(row));
      pattern_.columns.push_back(static_cast<int>(column));
    };
    for (std::size_t r = 0; r < row_count; ++r) {
      const Eigen::Index row = first + static_cast<Eigen::Index>(r);
      for (Eigen::Index i = 0; i < design_count(); ++i) {
        add(row, i);
      }
      for (Eigen::Index j = 0; j < blocks_ * control_count(); ++j) {
        if (reads[r][static_cast<std::size_t>(j / control_count())]) {
          add(row, design_count() + j);
        }
      }
    }
    first += rows.size();
  }
}

Eigen::VectorXd DesignProblem::design(const Eigen::VectorXd& x) const {
  return x.head(design_count());
}

Inputs DesignProblem::inputs(const Eigen::VectorXd& x) const {
  if (x.size() != variables_.start.size()) {
    throw InvalidInput(concat("DesignProblem: x has ", x.size(), " entries; it must have ",
                              variables_.start.size()));
  }
  const int steps = parts_.simulator.options().steps;
  Inputs out{parts_.map->parameters(design(x)), Eigen::MatrixXd(control_count(), steps), parts_.q0,
             parts_.qdot0};
  for (int k = 0; k < steps; ++k) {
    const int block = k / parts_.controls.hold;
    out.u.col(k) = x.segment(design_count() + block * control_count(), control_count());
  }
  return out;
}

void DesignProblem::move_to(const Eigen::VectorXd& x) {
  if (x_.size() != x.size() || x_ != x) {
    const Inputs at = inputs(x);
    const Stopwatch stopwatch(times_.simulation);
    ++times_.simulations;
    x_ = x;
    failure_.clear();
    try {
      trajectory_ = parts_.simulator.rollout(at).trajectory();
      values_ = parts_.simulator.values(trajectory_);
    } catch (const NumericalFailure& error) {
      failure_ = error.what();
    } catch (const InvalidInput& error) {  // parameters that no body can have
      failure_ = error.what();
    } catch (...) {
      x_.resize(0);
      throw;
    }
  }
  if (!failure_.empty()) {
    throw solvers::EvaluationError(failure_);
  }
}

const TrajectoryValues& DesignProblem::trajectory_values(const Eigen::VectorXd& x) {
  move_to(x);
  return values_;
}

double DesignProblem::objective(const Eigen::VectorXd& x) {
  move_to(x);
  const DesignVariables& design_variables = parts_.map->variables();
  const double distance =
      (design(x) - design_variables.start).cwiseQuotient(design_variables.scale).squaredNorm();
  return parts_.objective.value(values_) + 0.5 * parts_.design_weight * distance;
}

void DesignProblem::objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) {
  move_to(x);
  const Stopwatch stopwatch(times_.gradient);
  ++times_.gradients;
  Gradient gradient;
  try {
    gradient = adjoint_.gradient(trajectory_, parts_.objective);
  } catch (const NumericalFailure& error) {
    throw solvers::EvaluationError(error.what());
  }
  const DesignVariables& design_variables = parts_.map->variables();
  g.setZero(x.size());
  g.head(design_count()) =
      parts_.map->jacobian(design(x)).transpose() * gradient.p +
      parts_.design_weight *
          (design(x) - design_variables.start).cwiseQuotient(design_variables.scale.cwiseAbs2());
  for (int k = 0; k < gradient.u.cols(); ++k) {
    const int block = k / parts_.controls.hold;
    g.segment(design_count() + block * control_count(), control_count()) += gradient.u.col(k);
  }
}

void DesignProblem::constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) {
  move_to(x);
  c.resize(limits_.lower.size());
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : parts_.constraints) {
    term->values(values_, c.segment(first, term->rows().size()));
    first += term->rows().size();
  }
}

Directions DesignProblem::directions(const Eigen::VectorXd& x) const {
  Directions out = Directions::zero(parts_.simulator, x.size());
  out.p.leftCols(design_count()) = parts_.map->jacobian(design(x));
  const Eigen::Index controls = control_count();
  for (int k = 0; k < parts_.simulator.options().steps; ++k) {
    const int block = k / parts_.controls.hold;
    out.u.block(k * controls, design_count() + block * controls, controls, controls).setIdentity();
  }
  return out;
}

void DesignProblem::constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) {
  move_to(x);
  const Stopwatch stopwatch(times_.jacobian);
  ++times_.jacobians;
  const Directions along = directions(x);
  Tangents tangents;
  try {
    tangents = tangent_.push_forward(trajectory_, along);
  } catch (const NumericalFailure& error) {
    throw solvers::EvaluationError(error.what());
  }
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(limits_.lower.size(), x.size());
  Eigen::Index first = 0;
  for (const ConstraintPointer& term : parts_.constraints) {
    const std::vector<PartialPlace>& places = term->places();
    Eigen::VectorXd partials(static_cast<Eigen::Index>(places.size()));
    term->partials(values_, partials);
    for (std::size_t i = 0; i < places.size(); ++i) {
      dense.row(first + places[i].row) +=
          partials[static_cast<Eigen::Index>(i)] * tangent_of(places[i], tangents, along, values_);
    }
    first += term->rows().size();
  }
  values.resize(static_cast<Eigen::Index>(pattern_.rows.size()));
  for (std::size_t i = 0; i < pattern_.rows.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = dense(pattern_.rows[i], pattern_.columns[i]);
  }
}

}  // namespace hbar
