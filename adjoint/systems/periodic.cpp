#include "hbar/adjoint/systems/periodic.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "hbar/adjoint/derivatives/factorized_linearization.h"
#include "hbar/adjoint/derivatives/stage_weights.h"
#include "hbar/adjoint/systems/periodic_matrix.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/trajectory_residual.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

PeriodicOptions checked(const Horizon& horizon, PeriodicOptions options) {
  const Eigen::Index n = horizon.model().dof();
  if (options.warm_up < 1) {
    throw InvalidInput(concat("periodic: warm_up is ", options.warm_up, "; it must be at least 1"));
  }
  if (options.advance.size() == 0) {
    options.advance.setZero(n);
  }
  if (options.advance.size() != n || !options.advance.allFinite()) {
    throw InvalidInput(concat("periodic: advance has ", options.advance.size(),
                              " entries; it must have ", n, ", all finite"));
  }
  return options;
}

}  // namespace

struct PeriodicSolver::Workspace final : public solvers::NewtonSystem {
  Workspace(const Horizon& h, PeriodicOptions o)
      : horizon(h),
        options(checked(h, std::move(o))),
        simulator(h),
        residual_of(h),
        linearizer(h),
        solver(options.solver),
        history(h.model()),
        end(h.model()) {}

  void residual(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    close(x);
    g = residual_of.evaluate(trajectory);
  }
  void factorize(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    residual(x, g);
    factorize_here();
  }
  void solve(const Eigen::VectorXd& g, Eigen::VectorXd& dx) override {
    solver.solver().solve(g, dx);
  }

  void close(const Eigen::VectorXd& x);
  const Linearization& factorize_here();
  void warm_up(const Inputs& guess);
  [[nodiscard]] std::string failure_message(const solvers::NewtonReport& report) const;

  Horizon horizon;
  PeriodicOptions options;
  Simulator simulator;
  TrajectoryResidual residual_of;
  Linearizer linearizer;
  solvers::CachedSolver solver;
  History history;
  StagePoint<double> end;
  Trajectory trajectory;
  double mismatch = 0.0;
};

/// Sets the stages' coordinates to q̄ and the initial state to their final one.
void PeriodicSolver::Workspace::close(const Eigen::VectorXd& x) {
  const int last = trajectory.timeline.last_stage();
  trajectory.q.rightCols(last).reshaped() = x;
  trajectory.q.col(0) = trajectory.q.col(last) - options.advance;
  // The last rate depends on coordinates alone, not on the rates of earlier stages.
  history.set_point(trajectory, last, end);
  trajectory.qdot.col(0) = end.qdot;
  trajectory.inputs.q0 = trajectory.q.col(0);
  trajectory.inputs.qdot0 = trajectory.qdot.col(0);
}

const Linearization& PeriodicSolver::Workspace::factorize_here() {
  const Linearization& system = linearizer.linearize(trajectory);
  solver.factorize(periodic_matrix(horizon.model(), trajectory, system), linearizer.pattern_count(),
                   [&] {
                     return solvers::MatrixDescription{periodic_options(system),
                                                       stage_names(horizon, trajectory.timeline)};
                   });
  return system;
}

/// Simulates some periods, each from the end of the previous one.
void PeriodicSolver::Workspace::warm_up(const Inputs& guess) {
  Inputs inputs = guess;
  for (int i = 0; i < options.warm_up; ++i) {
    trajectory = simulator.rollout(inputs).trajectory();
    const int last = trajectory.timeline.last_stage();
    refuse_changed_charts(horizon.model(), trajectory);
    const Eigen::VectorXd q0 = trajectory.q.col(last) - options.advance;
    mismatch = std::max((q0 - inputs.q0).lpNorm<Eigen::Infinity>(),
                        (trajectory.qdot.col(last) - inputs.qdot0).lpNorm<Eigen::Infinity>());
    inputs.q0 = q0;
    inputs.qdot0 = trajectory.qdot.col(last);
  }
  trajectory.factors.clear();
}

std::string PeriodicSolver::Workspace::failure_message(const solvers::NewtonReport& report) const {
  const Model& model = horizon.model();
  return concat("periodic: ", solvers::describe(report.status), " after ", report.iterations,
                " iterations on the whole trajectory, |g| = ", report.residual,
                ", largest correction in ", stage_names(horizon, trajectory.timeline)(report.worst),
                " of ", trajectory.timeline.last_stage(), " stages of ", model.dof(),
                " coordinates; the last simulated period missed its start by ", mismatch,
                ": simulate more periods first (warm_up), start nearer, add damping, or check "
                "that the drive repeats after N steps");
}

PeriodicSolver::PeriodicSolver(const Horizon& horizon, PeriodicOptions options)
    : work_("PeriodicSolver", std::make_unique<Workspace>(horizon, std::move(options))) {}
PeriodicSolver::~PeriodicSolver() = default;
PeriodicSolver::PeriodicSolver(PeriodicSolver&&) noexcept = default;
PeriodicSolver& PeriodicSolver::operator=(PeriodicSolver&&) noexcept = default;

const solvers::LinearSolver& PeriodicSolver::solver() const { return work_->solver.solver(); }

PeriodicOrbit PeriodicSolver::solve(const Inputs& guess) {
  Workspace& w = *work_;
  w.warm_up(guess);
  const int last = w.trajectory.timeline.last_stage();
  Eigen::VectorXd x = w.trajectory.q.rightCols(last).reshaped();
  solvers::NewtonOptions newton = w.options.newton;
  newton.tol *= std::sqrt(static_cast<double>(last));
  PeriodicOrbit out;
  out.newton = solvers::Newton(x.size()).solve(w, newton, x);
  if (!out.newton.converged()) {
    throw NumericalFailure(w.failure_message(out.newton));
  }
  // Once more at the solution, for the rates.
  Eigen::VectorXd g(x.size());
  w.residual(x, g);
  out.trajectory = w.trajectory;
  out.mismatch = w.mismatch;
  return out;
}

Gradient PeriodicSolver::gradient(const Trajectory& orbit, const Objective& objective) {
  Workspace& w = *work_;
  const TrajectoryValues values = read_values(w.horizon, orbit);
  const TrajectoryPartials partials = objective.partials(values);
  StageWeights weights = stage_weights(w.horizon, orbit, partials);
  const int last = orbit.timeline.last_stage();
  // The initial state is the last one: its weights go there.
  add_rate_weights(w.horizon.model(), orbit, last, weights.qdot0, weights);
  weights.q_bar.col(last) += weights.q_bar.col(0);
  const Eigen::VectorXd y_bar = weights.q_bar.rightCols(last).reshaped();
  w.trajectory = orbit;
  const Linearization& system = w.factorize_here();
  Eigen::VectorXd z_bar(y_bar.size());
  w.solver.solver().solve_transposed(y_bar, z_bar);
  Gradient out;
  out.value = objective.value(values);
  out.p = weights.p - system.dg_dp.transpose() * z_bar;
  out.u = weights.u;
  out.u.reshaped() -= system.dg_du.transpose() * z_bar;
  out.q0.setZero(w.horizon.model().dof());
  out.qdot0.setZero(w.horizon.model().dof());
  return out;
}

PeriodicOrbit solve_periodic(const Horizon& horizon, const Inputs& guess,
                             const PeriodicOptions& options) {
  return PeriodicSolver(horizon, options).solve(guess);
}

}  // namespace hbar
