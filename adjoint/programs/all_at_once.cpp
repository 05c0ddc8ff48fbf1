#include "hbar/adjoint/programs/all_at_once.h"

#include <algorithm>
#include <limits>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/stage_weights.h"
#include "hbar/adjoint/programs/state_guess.h"
#include "hbar/adjoint/programs/state_variables.h"
#include "hbar/adjoint/programs/stopwatch.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// The horizon's stages, no step halved, at rest.
Trajectory empty_trajectory(const Horizon& horizon) {
  const SimulationOptions& options = horizon.options();
  Trajectory out;
  out.model = horizon.shared_model();
  out.parameters = horizon.parameters();
  out.integrator = horizon.integrator().name;
  out.timeline = even_timeline(horizon.integrator(), options.h, options.steps, options.restarts);
  out.q.setZero(horizon.model().dof(), out.timeline.stage_count());
  out.qdot.setZero(horizon.model().dof(), out.timeline.stage_count());
  return out;
}

}  // namespace

AllAtOnce::AllAtOnce(const TrajectoryProblem& problem, const TranscriptionOptions& options)
    : Transcription(problem),
      trajectory_(empty_trajectory(problem_.horizon)),
      layout_(head_, trajectory_.timeline, problem_.horizon.model().dof()),
      dependence_(problem_.horizon, head_, layout_),
      residual_(problem_.horizon),
      linearizer_(problem_.horizon),
      hessian_(problem_, head_, layout_, dependence_),
      reader_(problem_.horizon),
      row_scale_(Eigen::VectorXd::Ones(layout_.dof() * trajectory_.timeline.last_stage())) {
  guess(options.q_guess);
  differentiate(variables_.start);
  const Linearization& system = linearizer_.linearize(trajectory_);
  scale_rows(system);
  lay_out_jacobian(system);
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
    } catch (const InvalidInput& error) {  // parameters that are physically impossible
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
    dependence_.move_to(trajectory_, map_jacobian_);
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

void AllAtOnce::lagrangian_hessian(const Eigen::VectorXd& x, double sigma,
                                   const Eigen::VectorXd& lambda, solvers::HessianKind kind,
                                   Eigen::VectorXd& values) {
  require_multipliers(lambda);
  const Stopwatch stopwatch(times_.hessian);
  ++times_.hessians;
  HessianPlan& at = plan(kind);
  differentiate(x);
  begin_values(at, values_, sigma, lambda, values);
  if (kind == solvers::HessianKind::kExact) {
    hessian_.put(trajectory_, design(x), map_jacobian_,
                 lambda.tail(row_scale_.size()).cwiseProduct(row_scale_),
                 lagrangian_partials(values_, sigma, lambda), at.entries);
  }
}

}  // namespace hbar
