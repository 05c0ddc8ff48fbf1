#include "hbar/adjoint/programs/shooting.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <thread>
#include <utility>

#include "hbar/adjoint/outputs/measured_reads.h"
#include "hbar/adjoint/programs/state_guess.h"
#include "hbar/adjoint/programs/state_variables.h"
#include "hbar/adjoint/programs/stopwatch.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// Rows of tangents that belong to a field at a local step; null for fields that are inputs.
const Eigen::MatrixXd* tangents_of(const Tangents& tangents, ValueField field) {
  switch (field) {
    case ValueField::kQ:
      return &tangents.q;
    case ValueField::kQdot:
      return &tangents.qdot;
    case ValueField::kMeasured:
      return &tangents.measured;
    default:
      return nullptr;
  }
}

/// Runs f(0) … f(count − 1) on some threads; rethrows the first exception.
void run_side_by_side(int count, int threads, const std::function<void(int)>& f) {
  std::atomic<int> next = 0;
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        f(i);
      } catch (...) {
        failures[static_cast<std::size_t>(i)] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < std::min(threads, count); ++i) {
      others.emplace_back(work);
    }
    work();
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure != nullptr) {
      std::rethrow_exception(failure);
    }
  }
}

}  // namespace

Shooting::Shooting(const TrajectoryProblem& problem, const TranscriptionOptions& options)
    : Transcription(problem) {
  if (options.threads < 0) {
    throw InvalidInput(concat("transcription: threads is ", options.threads, "; it must be ≥ 0"));
  }
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  threads_ = options.threads > 0 ? options.threads : std::max(1, cores);
  for (const Measurement& measurement : problem_.horizon.measurements()) {
    for (const MeasuredReads& reads : measured_reads(problem_.horizon.model(), measurement)) {
      reads_controls_.push_back(reads.controls.empty() ? 0 : 1);
    }
  }
  lay_out_segments(options);
  lay_out_jacobian();
}

void Shooting::lay_out_segments(const TranscriptionOptions& options) {
  const Horizon& horizon = problem_.horizon;
  const int steps = horizon.options().steps;
  const Eigen::Index dof = horizon.model().dof();
  std::vector<int> starts = {0};
  if (options.formulation == Formulation::kMultipleShooting) {
    const std::vector<int> more = segment_starts(steps, options.segments);
    starts.insert(starts.end(), more.begin(), more.end());
  }
  const std::size_t count = starts.size();
  starts.push_back(steps);
  std::vector<std::string> equations;
  const Eigen::MatrixXd states =
      count > 1 ? guess_states(problem_, head_, options.q_guess) : Eigen::MatrixXd();
  const std::vector<std::string> names = state_names(horizon.model());
  for (std::size_t i = 0; i < count; ++i) {
    const int first = starts[i];
    const int last = starts[i + 1];
    SegmentColumns columns;
    columns.design = head_.design_count();
    columns.first_control = head_.control_place(head_.block_of_step(first));
    columns.controls =
        head_.control_place(head_.block_of_step(last - 1) + 1) - columns.first_control;
    if (i > 0) {
      columns.first_state = variables_.start.size();
      columns.state = 2 * dof;
      solvers::NlpVariables state{
          Eigen::VectorXd::Constant(2 * dof, -std::numeric_limits<double>::infinity()),
          Eigen::VectorXd::Constant(2 * dof, std::numeric_limits<double>::infinity()),
          states.col(first),
          {},
          state_scale(problem_)};
      for (const std::string& name : names) {
        state.names.push_back(concat(name, " at step ", first));
        equations.push_back(concat("continuity of ", name, " at step ", first));
      }
      add_variables(state);
    } else if (head_.state_is_free()) {
      columns.first_state = head_.state_place();
      columns.state = 2 * dof;
    }
    segments_.push_back(std::make_unique<ShootingSegment>(horizon, first, last - first,
                                                          problem_.controls.hold, columns));
  }
  add_equations(equations);
}

ShootingSegment& Shooting::segment_of(int step) const {
  for (const auto& segment : segments_) {
    if (step <= segment->first_step() + segment->step_count()) {
      return *segment;
    }
  }
  return *segments_.back();
}

std::vector<Eigen::Index> Shooting::columns_of(const ValuePlace& place) const {
  std::vector<Eigen::Index> out;
  const auto add_run = [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i) {
      out.push_back(first + i);
    }
  };
  if (place.field == ValueField::kU) {
    add_run(head_.control_place(head_.block_of_step(place.step)) + place.index, 1);
  } else if (place.field == ValueField::kP) {
    out = head_.designs_of(place.index);
  } else {
    const SegmentColumns& columns = segment_of(place.step).columns();
    const bool is_state = place.field == ValueField::kQ || place.field == ValueField::kQdot;
    if (place.step == 0 && is_state) {
      const Eigen::Index half = place.field == ValueField::kQ ? 0 : columns.state / 2;
      add_run(columns.first_state + half + place.index, columns.state > 0 ? 1 : 0);
    } else {
      add_run(0, columns.design);
      if (place.step > 0) {
        const Eigen::Index end = head_.control_place(head_.block_of_step(place.step - 1) + 1);
        add_run(columns.first_control, end - columns.first_control);
      } else if (place.field == ValueField::kMeasured &&
                 reads_controls_[static_cast<std::size_t>(place.index)] != 0) {
        add_run(columns.first_control, head_.control_count());
      }
      add_run(columns.first_state, columns.state);
    }
  }
  return out;
}

/// A number's derivatives with respect to all variables of its segment.
Eigen::RowVectorXd Shooting::tangent_of(const ValuePlace& place) const {
  const ShootingSegment& segment = segment_of(place.step);
  const Eigen::MatrixXd& all = *tangents_of(segment.tangents(), place.field);
  const Eigen::Index rows = all.rows() / (segment.step_count() + 1);
  return all.row((place.step - segment.first_step()) * rows + place.index);
}

void Shooting::derivatives_of(const ValuePlace& place, std::vector<double>& out) {
  const std::vector<Eigen::Index> places = columns_of(place);
  out.assign(places.size(), 1.0);
  if (place.field == ValueField::kU) {
    return;
  }
  if (place.field == ValueField::kP) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      out[i] = map_jacobian_(place.index, places[i]);
    }
    return;
  }
  const Eigen::RowVectorXd all = tangent_of(place);
  const SegmentColumns& columns = segment_of(place.step).columns();
  for (std::size_t i = 0; i < places.size(); ++i) {
    out[i] = all[columns.variable(places[i])];
  }
}

void Shooting::lay_out_jacobian() {
  add_own_rows(jacobian_);
  Eigen::Index first = own_rows();
  for (std::size_t i = 0; i + 1 < segments_.size(); ++i) {
    const SegmentColumns& columns = segments_[i]->columns();
    const SegmentColumns& next = segments_[i + 1]->columns();
    for (Eigen::Index r = 0; r < next.state; ++r, ++first) {
      for (Eigen::Index j = 0; j < columns.size(); ++j) {
        jacobian_.add(first, columns.place(j));
      }
      jacobian_.add(first, next.first_state + r);
    }
  }
  jacobian_.finish();
  pattern_ = jacobian_.pattern();
}

Inputs Shooting::inputs_of(const ShootingSegment& segment, const Eigen::VectorXd& x,
                           const Inputs& whole) const {
  Inputs out{whole.p, whole.u.middleCols(segment.first_step(), segment.step_count()), whole.q0,
             whole.qdot0};
  if (segment.first_step() > 0) {
    const Eigen::Index dof = whole.q0.size();
    out.q0 = x.segment(segment.columns().first_state, dof);
    out.qdot0 = x.segment(segment.columns().first_state + dof, dof);
  }
  return out;
}

void Shooting::for_each_segment(const std::function<void(std::size_t)>& f) {
  run_side_by_side(segment_count(), threads_, [&](int i) { f(static_cast<std::size_t>(i)); });
}

void Shooting::move_to(const Eigen::VectorXd& x) {
  require_size(x);
  if (x_.size() != x.size() || x_ != x) {
    const Stopwatch stopwatch(times_.simulation);
    ++times_.simulations;
    const Inputs whole = inputs(x);
    x_.resize(0);  // until all have been simulated
    for_each_segment(
        [&](std::size_t i) { segments_[i]->simulate(inputs_of(*segments_[i], x, whole)); });
    x_ = x;
    differentiated_ = false;
    gather_values(whole);
  }
  for (const auto& segment : segments_) {
    if (!segment->failure().empty()) {
      throw solvers::EvaluationError(segment->failure());
    }
    if (segments_.size() > 1 && segment->changes_chart()) {
      throw solvers::EvaluationError(
          "multiple shooting: exponential coordinates change chart within a segment; use shooting, "
          "or Euler angles");
    }
  }
}

void Shooting::gather_values(const Inputs& whole) {
  for (const auto& segment : segments_) {
    if (!segment->failure().empty()) {
      return;
    }
  }
  const int steps = problem_.horizon.options().steps;
  values_.h = problem_.horizon.options().h;
  values_.u = whole.u;
  values_.p = whole.p;
  values_.measured_rows = segments_[0]->values().measured_rows;
  using Member = Eigen::MatrixXd TrajectoryValues::*;
  for (const Member field : {Member{&TrajectoryValues::q}, Member{&TrajectoryValues::qdot},
                             Member{&TrajectoryValues::measured}}) {
    Eigen::MatrixXd& all = values_.*field;
    all.resize((segments_[0]->values().*field).rows(), steps + 1);
    for (const auto& segment : segments_) {
      const int skipped = segment->first_step() > 0 ? 1 : 0;
      all.middleCols(segment->first_step() + skipped, segment->step_count() + 1 - skipped) =
          (segment->values().*field).rightCols(segment->step_count() + 1 - skipped);
    }
  }
}

const TrajectoryValues& Shooting::trajectory_values(const Eigen::VectorXd& x) {
  move_to(x);
  return values_;
}

double Shooting::objective(const Eigen::VectorXd& x) {
  move_to(x);
  return problem_.objective.value(values_) + head_.design_cost(x);
}

TrajectoryPartials Shooting::share_of(const ShootingSegment& segment,
                                      const TrajectoryPartials& partials) const {
  TrajectoryPartials out(segment.values());
  const int first = segment.first_step();
  const int steps = segment.step_count();
  const auto take = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
    to = from.middleCols(first, steps + 1);
    if (first > 0) {
      to.col(0).setZero();  // it belongs to the previous segment
    }
  };
  take(partials.q, out.q);
  take(partials.qdot, out.qdot);
  take(partials.measured, out.measured);
  out.u = partials.u.middleCols(first, steps);
  if (first == 0) {
    out.p = partials.p;
  }
  return out;
}

void Shooting::objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) {
  move_to(x);
  const Stopwatch stopwatch(times_.gradient);
  ++times_.gradients;
  const TrajectoryPartials partials = problem_.objective.partials(values_);
  std::vector<Gradient> gradients(segments_.size());
  try {
    for_each_segment([&](std::size_t i) {
      gradients[i] = segments_[i]->pull_back(share_of(*segments_[i], partials));
    });
  } catch (const NumericalFailure& error) {
    throw solvers::EvaluationError(error.what());
  }
  g.setZero(x.size());
  Gradient whole = gradients[0];
  whole.u.resize(whole.u.rows(), partials.u.cols());
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const ShootingSegment& segment = *segments_[i];
    whole.u.middleCols(segment.first_step(), segment.step_count()) = gradients[i].u;
    if (i > 0) {
      whole.p += gradients[i].p;
      g.segment(segment.columns().first_state, segment.columns().state) << gradients[i].q0,
          gradients[i].qdot0;
    }
  }
  head_.add_pull_back(whole, problem_.map->jacobian(design(x)), g);
  head_.add_design_cost_gradient(x, g);
}

void Shooting::constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) {
  move_to(x);
  c.resize(limits_.lower.size());
  own_constraints(values_, c);
  Eigen::Index first = own_rows();
  for (std::size_t i = 0; i + 1 < segments_.size(); ++i) {
    const TrajectoryValues& end = segments_[i]->values();
    const SegmentColumns& next = segments_[i + 1]->columns();
    c.segment(first, next.state) << end.q.rightCols<1>(), end.qdot.rightCols<1>();
    c.segment(first, next.state) -= x.segment(next.first_state, next.state);
    first += next.state;
  }
}

void Shooting::differentiate(const Eigen::VectorXd& x) {
  move_to(x);
  if (differentiated_) {
    return;
  }
  map_jacobian_ = problem_.map->jacobian(design(x));
  try {
    for_each_segment(
        [&](std::size_t i) { static_cast<void>(segments_[i]->differentiate(map_jacobian_)); });
  } catch (const NumericalFailure& error) {
    throw solvers::EvaluationError(error.what());
  }
  differentiated_ = true;
}

void Shooting::constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) {
  const Stopwatch stopwatch(times_.jacobian);
  ++times_.jacobians;
  differentiate(x);
  jacobian_.begin(values);
  put_own_rows(values_, jacobian_);
  for (std::size_t i = 0; i + 1 < segments_.size(); ++i) {
    const Tangents& tangents = segments_[i]->tangents();
    const Eigen::Index state = segments_[i + 1]->columns().state;
    for (Eigen::Index r = 0; r < state; ++r) {
      const Eigen::MatrixXd& all = r < state / 2 ? tangents.q : tangents.qdot;
      const Eigen::Index row = all.rows() - state / 2 + r % (state / 2);
      for (Eigen::Index j = 0; j < all.cols(); ++j) {
        jacobian_.put(all(row, j));
      }
      jacobian_.put(-1.0);
    }
  }
}

}  // namespace hbar
