#include "hbar/adjoint/programs/all_at_once.h"

#include <algorithm>
#include <limits>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/stage_weights.h"
#include "hbar/adjoint/programs/state_variables.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace

AllAtOnce::AllAtOnce(const TrajectoryProblem& problem, const TranscriptionOptions& options)
    : Transcription(problem),
      residual_(problem_.horizon),
      linearizer_(problem_.horizon),
      hessian_(problem_.horizon, head_.design_count()),
      reader_(problem_.horizon),
      outputs_(problem_.horizon.model(), problem_.horizon.options().measurements) {
  const SimulationOptions& simulation = problem_.horizon.options();
  trajectory_.timeline = even_timeline(find_integrator(simulation.integrator), simulation.h,
                                       simulation.steps, simulation.restarts);
  guess(options.q_guess);
  lay_out_stages();
  lay_out_outputs();
  row_scale_.setOnes(problem_.horizon.model().dof() * trajectory_.timeline.last_stage());
  differentiate(variables_.start);
  const Linearization& system = linearizer_.linearize(trajectory_);
  scale_rows(system);
  lay_out_jacobian(system);
}

Eigen::Index AllAtOnce::stage_place(int stage) const {
  if (stage == 0) {
    return head_.state_is_free() ? head_.state_place() : -1;
  }
  return head_.size() + (stage - 1) * problem_.horizon.model().dof();
}

int AllAtOnce::step_ended_by(int stage) const {
  const Timeline& timeline = trajectory_.timeline;
  const int step = stage == 0 ? -1 : timeline.stage(stage).step;
  return timeline.step_end(step + 1) == stage ? step + 1 : -1;
}

/// Variables for the stages' coordinates, and equations for their residuals.
void AllAtOnce::guess(const Eigen::MatrixXd& q_guess) {
  const Model& model = problem_.horizon.model();
  const Eigen::Index n = model.dof();
  const Timeline& timeline = trajectory_.timeline;
  const Eigen::MatrixXd states = guess_states(problem_, head_, q_guess);
  const Eigen::Index count = n * timeline.last_stage();
  solvers::NlpVariables more{Eigen::VectorXd::Constant(count, -kNoBound),
                             Eigen::VectorXd::Constant(count, kNoBound),
                             Eigen::VectorXd(count),
                             {},
                             state_scale(problem_).head(n).replicate(timeline.last_stage(), 1)};
  std::vector<std::string> equations;
  for (int s = 1; s <= timeline.last_stage(); ++s) {
    const int step = timeline.stage(s).step;
    const double begin = timeline.stage(timeline.step_end(step)).time;
    const double share = (timeline.stage(s).time - begin) / problem_.horizon.options().h;
    more.start.segment((s - 1) * n, n) =
        (1.0 - share) * states.col(step).head(n) + share * states.col(step + 1).head(n);
    const bool ends = timeline.step_end(step + 1) == s;
    for (int c = 0; c < n; ++c) {
      const std::string name = concat(model.coordinate_name(c),
                                      ends ? " at step " : " within step ", ends ? step + 1 : step);
      more.names.push_back(name);
      equations.push_back(concat("motion of ", name));
    }
  }
  add_variables(more);
  add_equations(equations);
  trajectory_.q.setZero(n, timeline.stage_count());
  trajectory_.qdot.setZero(n, timeline.stage_count());
}

void AllAtOnce::lay_out_stages() {
  const Timeline& timeline = trajectory_.timeline;
  const int n = problem_.horizon.model().dof();
  stages_.resize(static_cast<std::size_t>(timeline.stage_count()));
  if (head_.state_is_free()) {
    stages_[0] = {{stage_place(0), 1.0, 0.0, 0.0, 0.0, 0.0},
                  {stage_place(0) + n, 0.0, 1.0, 0.0, 0.0, 0.0}};
  }
  for (int s = 1; s <= timeline.last_stage(); ++s) {
    std::vector<StageEntry>& entries = stages_[static_cast<std::size_t>(s)];
    const FlatStencil<double> stencil = flat_stencil(timeline, s);
    for (const StencilEntry<double>& entry : stencil.entries) {
      if (stage_place(entry.stage) >= 0) {
        entries.push_back({stage_place(entry.stage), entry.stage == s ? 1.0 : 0.0, entry.qdot,
                           entry.a, entry.start_q, entry.start_qdot});
      }
    }
    if (head_.state_is_free() && stencil.reaches_start) {
      entries.push_back(
          {stage_place(0) + n, 0.0, 0.0, stencil.a_by_qdot0, 0.0, stencil.start_qdot_by_qdot0});
    }
  }
}

void AllAtOnce::scale_rows(const Linearization& system) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(row_scale_.size());
  const solvers::SparseMatrix& H = system.H.matrix();
  for (int j = 0; j < H.outerSize(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(H, j); entry; ++entry) {
      largest[entry.row()] = std::max(largest[entry.row()], std::abs(entry.value()));
    }
  }
  for (Eigen::Index i = 0; i < largest.size(); ++i) {
    row_scale_[i] = largest[i] > 0.0 ? 1.0 / largest[i] : 1.0;
  }
  x_.resize(0);  // computed with other scales
}

void AllAtOnce::add_matrix(const solvers::SparseMatrix& matrix, Eigen::Index first_column) {
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      jacobian_.add(own_rows() + entry.row(), first_column + j);
    }
  }
}

void AllAtOnce::put_matrix(const solvers::SparseMatrix& matrix) {
  for (int j = 0; j < matrix.outerSize(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      jacobian_.put(entry.value() * row_scale_[entry.row()]);
    }
  }
}

void AllAtOnce::lay_out_jacobian(const Linearization& system) {
  add_own_rows(jacobian_);
  add_matrix(system.H.matrix(), head_.size());
  const Eigen::Index controls = head_.control_count();
  for (int j = 0; j < system.dg_du.outerSize(); ++j) {
    const int block = controls > 0 ? head_.block_of_step(static_cast<int>(j / controls)) : 0;
    for (solvers::SparseMatrix::InnerIterator entry(system.dg_du, j); entry; ++entry) {
      jacobian_.add(own_rows() + entry.row(), head_.control_place(block) + j % controls);
    }
  }
  for (int p = 0; p < system.dg_dp.outerSize(); ++p) {
    for (solvers::SparseMatrix::InnerIterator entry(system.dg_dp, p); entry; ++entry) {
      for (const Eigen::Index i : head_.designs_of(p)) {
        jacobian_.add(own_rows() + entry.row(), i);
      }
    }
  }
  if (head_.state_is_free()) {
    add_matrix(system.dg_dq0.matrix(), head_.state_place());
    add_matrix(system.dg_dqdot0.matrix(), head_.state_place() + problem_.horizon.model().dof());
  }
  jacobian_.finish();
  pattern_ = jacobian_.pattern();
}

void AllAtOnce::move_to(const Eigen::VectorXd& x) {
  require_size(x);
  if (x_.size() != x.size() || x_ != x) {
    const Stopwatch stopwatch(times_.simulation);
    ++times_.simulations;
    x_ = x;
    differentiated_ = false;
    failure_.clear();
    trajectory_.inputs = inputs(x);
    trajectory_.q.col(0) = trajectory_.inputs.q0;
    trajectory_.qdot.col(0) = trajectory_.inputs.qdot0;
    trajectory_.q.rightCols(trajectory_.timeline.last_stage()).reshaped() =
        x.tail(x.size() - head_.size());
    try {
      trajectory_.mechanism = problem_.horizon.mechanism(trajectory_.inputs.p);
      g_bar_ = residual_.evaluate(trajectory_).cwiseProduct(row_scale_);
      values_ = reader_.values(trajectory_);
      if (!g_bar_.allFinite()) {
        failure_ = "all-at-once: the residual is not finite at this point";
      }
    } catch (const InvalidInput& error) {  // parameters that no body can have
      failure_ = error.what();
    }
  }
  if (!failure_.empty()) {
    throw solvers::EvaluationError(failure_);
  }
}

const TrajectoryValues& AllAtOnce::trajectory_values(const Eigen::VectorXd& x) {
  move_to(x);
  return values_;
}

double AllAtOnce::residual(const Eigen::VectorXd& x) {
  move_to(x);
  return g_bar_.lpNorm<Eigen::Infinity>();
}

double AllAtOnce::objective(const Eigen::VectorXd& x) {
  move_to(x);
  return problem_.objective.value(values_) + head_.design_cost(x);
}

void AllAtOnce::objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) {
  move_to(x);
  const Stopwatch stopwatch(times_.gradient);
  ++times_.gradients;
  const TrajectoryPartials partials = problem_.objective.partials(values_);
  const StageWeights weights = stage_weights(problem_.horizon, trajectory_, partials);
  const Gradient direct{0.0, weights.p, weights.u, weights.q_bar.col(0), weights.qdot0};
  g.setZero(x.size());
  head_.add_pull_back(direct, problem_.map->jacobian(design(x)), g);
  head_.add_design_cost_gradient(x, g);
  g.tail(x.size() - head_.size()) =
      weights.q_bar.rightCols(trajectory_.timeline.last_stage()).reshaped();
}

void AllAtOnce::constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) {
  move_to(x);
  c.resize(limits_.lower.size());
  own_constraints(values_, c);
  c.tail(g_bar_.size()) = g_bar_;
}

void AllAtOnce::differentiate(const Eigen::VectorXd& x) {
  move_to(x);
  if (!differentiated_) {
    map_jacobian_ = problem_.map->jacobian(design(x));
    differentiated_ = true;
  }
}

void AllAtOnce::constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) {
  const Stopwatch stopwatch(times_.jacobian);
  ++times_.jacobians;
  differentiate(x);
  const Linearization& system = linearizer_.linearize(trajectory_);
  jacobian_.begin(values);
  put_own_rows(values_, jacobian_);
  put_matrix(system.H.matrix());
  put_matrix(system.dg_du);
  for (int p = 0; p < system.dg_dp.outerSize(); ++p) {
    for (solvers::SparseMatrix::InnerIterator entry(system.dg_dp, p); entry; ++entry) {
      for (const Eigen::Index i : head_.designs_of(p)) {
        jacobian_.put(entry.value() * row_scale_[entry.row()] * map_jacobian_(p, i));
      }
    }
  }
  if (head_.state_is_free()) {
    put_matrix(system.dg_dq0.matrix());
    put_matrix(system.dg_dqdot0.matrix());
  }
}

}  // namespace hbar
