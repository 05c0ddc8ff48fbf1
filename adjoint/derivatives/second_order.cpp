#include "hbar/adjoint/derivatives/second_order.h"

#include <memory>
#include <utility>

#include "hbar/adjoint/derivatives/backward_sweep.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/dual_vectors.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/stop_flag.h"

namespace hbar {
namespace {

void set_slope(VectorX<Dual>& duals, const Eigen::VectorXd& slope) {
  for (Eigen::Index i = 0; i < duals.size(); ++i) {
    duals[i].slope = slope[i];
  }
}

void require_shape(const Inputs& direction, const Inputs& inputs) {
  const auto same = [](const auto& a, const auto& b) {
    return a.rows() == b.rows() && a.cols() == b.cols();
  };
  if (!same(direction.p, inputs.p) || !same(direction.u, inputs.u) ||
      !same(direction.q0, inputs.q0) || !same(direction.qdot0, inputs.qdot0)) {
    throw InvalidInput(concat("second order: the direction has ", direction.p.size(),
                              " parameters, ", direction.u.rows(), " x ", direction.u.cols(),
                              " controls and ", direction.q0.size(), " + ", direction.qdot0.size(),
                              " initial values; expected ", inputs.p.size(), ", ", inputs.u.rows(),
                              " x ", inputs.u.cols(), ", ", inputs.q0.size(), " + ",
                              inputs.qdot0.size()));
  }
}

}  // namespace

struct SecondOrderSweep::Workspace {
  explicit Workspace(const Horizon& h)
      : horizon(h),
        adjoint(h),
        sweep(h),
        stage(h.model()),
        point(h.model()),
        block(h.model().dof(), h.model().dof()),
        g(h.model().dof()),
        history(h.model()),
        mechanism_d(nominal_mechanism<Dual>(h.model())),
        stage_d(h.model()),
        point_d(h.model()),
        measurements(h.model(), h.measurements()),
        instants(h.model(), measurements.reads_contacts()),
        g_d(h.model().dof()),
        qdot_past(h.model().dof()),
        a_past(h.model().dof()),
        delta(h.model().dof()) {}

  [[nodiscard]] const Trajectory& trajectory() const;
  [[nodiscard]] Applied<Dual> applied() const { return {mechanism_d, horizon.parameters(), p_d}; }
  void factorize();
  void set_stage(int s);
  void read_values(int k);
  void solve_adjoint(int s, const VectorX<Dual>& y, StageResidual<Dual>& at, VectorX<Dual>& z);

  Horizon horizon;
  AdjointSweep adjoint;
  BackwardSweep<Dual> sweep;
  Trajectory trajectory_;  // a copy, which nobody takes away
  bool has_point = false;
  bool has_direction = false;
  TrajectoryPartials weights{TrajectoryValues{}};
  Gradient gradient;
  StageResidual<double> stage;
  StagePoint<double> point;
  Eigen::MatrixXd block;
  Eigen::VectorXd g;
  std::vector<Eigen::PartialPivLU<Eigen::MatrixXd>> factors;  // of H_ss, per stage

  History history;
  Mechanism<Dual> mechanism_d;
  StageResidual<Dual> stage_d;
  StagePoint<Dual> point_d;
  Measurements<Dual> measurements;
  InstantMotion<Dual> instants;
  VectorX<Dual> p_d, measured;
  MatrixX<Dual> u_d, q_d, qdot_d;  // per step; per stage
  VectorX<Dual> g_d, qdot_past, a_past;
  Eigen::VectorXd delta;
  ValueTangent tangent;
  Gradient out;
};

/// Factors of every stage's block at the trajectory itself, so that no solve needs refinement.
void SecondOrderSweep::Workspace::factorize() {
  const int last = trajectory_.timeline.last_stage();
  factors.resize(static_cast<std::size_t>(last) + 1);
  for (int s = 1; s <= last; ++s) {
    require_running(horizon.options().stop, "second order: factorisation interrupted at stage ", s,
                    " of ", last);
    history.set_point(trajectory_, s, point);
    stage.linearize(*trajectory_.mechanism, point, g);
    stage.newton_matrix(block);
    factors[static_cast<std::size_t>(s)].compute(block);
  }
}

const Trajectory& SecondOrderSweep::Workspace::trajectory() const {
  if (!has_point) {
    throw InvalidInput("second order: there is no point yet; call set_point first");
  }
  return trajectory_;
}

/// The stage's point with the slopes that are known so far.
void SecondOrderSweep::Workspace::set_stage(int s) {
  const Stage& row = trajectory().timeline.stage(s);
  history.gather<Dual>(trajectory(), q_d, qdot_d, s, qdot_past, a_past, point_d.start);
  point_d.rate = row.rate;
  point_d.u = u_d.col(row.step);
  point_d.q = q_d.col(s);
  History::set_rates<Dual>(qdot_past, a_past, point_d);
}

/// Slopes of the values at step k.
void SecondOrderSweep::Workspace::read_values(int k) {
  const int s = trajectory().timeline.step_end(k);
  tangent.q.col(k) = slopes_of(q_d.col(s));
  tangent.qdot.col(k) = slopes_of(qdot_d.col(s));
  if (!measurements.empty()) {
    const Applied<Dual> parameters = applied();
    const Instant<Dual> at =
        instants.at(parameters, q_d.col(s), qdot_d.col(s), u_d.col(measured_step(k)));
    measurements.linearize(at);
    measurements.read(at, measured);
    tangent.measured.col(k) = slopes_of(measured);
  }
}

/// δz of H_ssᵀ δz = δy − (δH_ss)ᵀ z.
void SecondOrderSweep::Workspace::solve_adjoint(int s, const VectorX<Dual>& y,
                                                StageResidual<Dual>& at, VectorX<Dual>& z) {
  const double rate = at.rate();
  z = adjoint.adjoint().col(s - 1).cast<Dual>();
  at.pull_back(z);
  for (Eigen::Index i = 0; i < delta.size(); ++i) {
    delta[i] = (y[i] - at.by_q()[i] - rate * at.by_qdot()[i] - (rate * rate) * at.by_a()[i]).slope;
  }
  delta = factors[static_cast<std::size_t>(s)].transpose().solve(delta).eval();
  set_slope(z, delta);
  at.pull_back(z);
}

SecondOrderSweep::SecondOrderSweep(const Horizon& horizon)
    : work_("SecondOrderSweep", std::make_unique<Workspace>(horizon)) {}
SecondOrderSweep::~SecondOrderSweep() = default;
SecondOrderSweep::SecondOrderSweep(SecondOrderSweep&&) noexcept = default;
SecondOrderSweep& SecondOrderSweep::operator=(SecondOrderSweep&&) noexcept = default;

const Gradient& SecondOrderSweep::set_point(const Trajectory& trajectory,
                                            const TrajectoryPartials& weights) {
  Workspace& w = *work_;
  w.has_point = w.has_direction = false;
  w.gradient = w.adjoint.pull_back(trajectory, weights);
  w.trajectory_ = trajectory;
  w.weights = weights;
  w.factorize();
  w.has_point = true;
  return w.gradient;
}

const Trajectory& SecondOrderSweep::trajectory() const { return work_->trajectory(); }

const ValueTangent& SecondOrderSweep::push_forward(const Inputs& direction) {
  Workspace& w = *work_;
  const Trajectory& trajectory = w.trajectory();
  require_shape(direction, trajectory.inputs);
  w.p_d = dual_vector(trajectory.inputs.p, direction.p);
  apply_parameters<Dual>(w.horizon.model(), w.horizon.parameters(), w.p_d, w.mechanism_d);
  w.has_direction = false;
  w.u_d = dual_matrix(trajectory.inputs.u, direction.u);
  w.q_d = trajectory.q.cast<Dual>();
  w.qdot_d = trajectory.qdot.cast<Dual>();
  w.q_d.col(0) = dual_vector(trajectory.q.col(0), direction.q0);
  w.qdot_d.col(0) = dual_vector(trajectory.qdot.col(0), direction.qdot0);
  for (int s = 1; s <= trajectory.timeline.last_stage(); ++s) {
    require_running(w.horizon.options().stop, "second order: forward sweep interrupted at stage ",
                    s, " of ", trajectory.timeline.last_stage());
    w.set_stage(s);
    w.stage_d.residual(w.mechanism_d, w.point_d, w.g_d);
    w.delta = slopes_of(w.g_d);
    w.delta = -w.factors[static_cast<std::size_t>(s)].solve(w.delta).eval();
    for (Eigen::Index i = 0; i < w.delta.size(); ++i) {
      w.q_d(i, s).slope = w.delta[i];
    }
    w.point_d.q = w.q_d.col(s);
    History::set_rates<Dual>(w.qdot_past, w.a_past, w.point_d);
    w.qdot_d.col(s) = w.point_d.qdot;
  }
  const int steps = trajectory.step_count();
  w.tangent.q.resize(w.q_d.rows(), steps + 1);
  w.tangent.qdot.resize(w.q_d.rows(), steps + 1);
  w.tangent.measured.resize(w.measurements.size(), steps + 1);
  w.tangent.measured_rows = w.horizon.measured_rows();
  w.measured.resize(w.measurements.size());
  w.tangent.u = direction.u;
  w.tangent.p = direction.p;
  for (int k = 0; k <= steps; ++k) {
    w.read_values(k);
  }
  w.has_direction = true;
  return w.tangent;
}

const Gradient& SecondOrderSweep::product(const TrajectoryPartials* weights_tangent) {
  Workspace& w = *work_;
  const Trajectory& trajectory = w.trajectory();
  if (!w.has_direction) {
    throw InvalidInput("second order: there is no direction yet; call push_forward first");
  }
  const TrajectoryPartials& y = w.weights;
  const TrajectoryPartials still(w.tangent);
  const TrajectoryPartials& dy = weights_tangent != nullptr ? *weights_tangent : still;
  const Applied<Dual> applied = w.applied();
  w.sweep.run(
      {trajectory, applied, w.q_d, w.qdot_d, w.u_d},
      {dual_matrix(y.q, dy.q), dual_matrix(y.qdot, dy.qdot), dual_matrix(y.measured, dy.measured),
       dual_matrix(y.u, dy.u), dual_vector(y.p, dy.p)},
      [&](int s, const VectorX<Dual>& of, StageResidual<Dual>& at, VectorX<Dual>& z) {
        w.solve_adjoint(s, of, at, z);
      });
  w.out.p = slopes_of(w.sweep.by_p());
  w.out.u = slopes_of(w.sweep.by_u());
  w.out.q0 = slopes_of(w.sweep.by_q0());
  w.out.qdot0 = slopes_of(w.sweep.by_qdot0());
  return w.out;
}

HessianProduct::HessianProduct(const Horizon& horizon, Objective objective)
    : reader_(horizon), objective_(std::move(objective)), sweep_(horizon), adjoint_(horizon) {}

const Gradient& HessianProduct::set_point(const Trajectory& trajectory) {
  values_ = reader_.values(trajectory);
  places_ = objective_.second_places(values_);
  second_ = objective_.second_partials(values_);
  gradient_ = sweep_.set_point(trajectory, objective_.partials(values_));
  gradient_.value = objective_.value(values_);
  return gradient_;
}

const Gradient& HessianProduct::along(const Inputs& direction, solvers::HessianKind kind) {
  if (kind == solvers::HessianKind::kLimitedMemory) {
    throw InvalidInput("second order: a limited-memory Hessian is an optimiser's own");
  }
  const ValueTangent& tangent = sweep_.push_forward(direction);
  TrajectoryPartials moved(values_);
  add_second_order(places_, second_, tangent, moved);
  product_ = kind == solvers::HessianKind::kExact ? sweep_.product(&moved)
                                                  : adjoint_.pull_back(sweep_.trajectory(), moved);
  product_.value = 0.5 * (product_.p.dot(direction.p) + product_.u.cwiseProduct(direction.u).sum() +
                          product_.q0.dot(direction.q0) + product_.qdot0.dot(direction.qdot0));
  return product_;
}

}  // namespace hbar
