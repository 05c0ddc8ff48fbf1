#include "hbar/adjoint/derivatives/backward_sweep.h"

#include <utility>

#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/core/base/stop_flag.h"
#include "hbar/core/model/drives.h"

namespace hbar {

template <Scalar S>
BackwardSweep<S>::BackwardSweep(Horizon horizon)
    : horizon_(std::move(horizon)),
      history_(horizon_.model()),
      stage_(horizon_.model()),
      point_(horizon_.model()),
      measurements_(horizon_.model(), horizon_.measurements()),
      start_(horizon_.model(), measurements_.reads_contacts()),
      g_(horizon_.model().dof()),
      z_(horizon_.model().dof()),
      qdot_past_(horizon_.model().dof()),
      a_past_(horizon_.model().dof()),
      y_start_{VectorX<S>(horizon_.model().dof()), VectorX<S>(horizon_.model().dof())} {}

template <Scalar S>
void BackwardSweep<S>::set_point(const SweptTrajectory<S>& at, int s) {
  const Stage& row = at.trajectory.timeline.stage(s);
  history_.template gather<S>(at.trajectory, at.q, at.qdot, s, qdot_past_, a_past_, point_.start);
  point_.rate = row.rate;
  point_.u = at.u.col(row.step);
  point_.q = at.q.col(s);
  History::set_rates<S>(qdot_past_, a_past_, point_);
}

/// Pulls the weights on what is measured at step k back to coordinates, rates, controls,
/// parameters.
template <Scalar S>
void BackwardSweep<S>::add_outputs(const SweptTrajectory<S>& at, const SweptWeights<S>& weights,
                                   int k, const Instant<S>& instant) {
  const int s = at.trajectory.timeline.step_end(k);
  InstantGradient<S> out{q_bar_.col(s), qdot_bar_.col(s), u_bar_.col(measured_step(k)), p_bar_};
  measurements_.linearize(instant);
  measurements_.pull_back(instant, weights.measured.col(k), out);
}

template <Scalar S>
void BackwardSweep<S>::sweep_stage(const SweptTrajectory<S>& at, int s, const SolveBlock& solve) {
  const double rate = point_.rate;
  y_ = q_bar_.col(s) + rate * qdot_bar_.col(s);
  solve(s, y_, stage_, z_);
  // L = Ψ − Σ zᵀ g: the remaining ∂L/∂a and ∂L/∂q̇ are passed on to earlier stages.
  const JointForces<S>& forces = stage_.joint_forces();
  const double c = stage_.c();
  y_a_ = -stage_.by_a();
  y_qdot_ = qdot_bar_.col(s) - stage_.by_qdot() + rate * y_a_;
  y_start_.q = c * z_.cwiseProduct(forces.by_start_q);
  y_start_.qdot = c * z_.cwiseProduct(forces.by_start_qdot);
  history_.template scatter<S>(at.trajectory, at.q, at.qdot, s, y_qdot_, y_a_, y_start_, q_bar_,
                               qdot_bar_);
  const int step = at.trajectory.timeline.stage(s).step;
  for_each_drive(horizon_.model(), [&](int k, int control) {
    u_bar_(control, step) += c * z_[k] * forces.by_u[control];
  });
  add_parameter_gradient<S>(at.applied, stage_, point_, z_, -1.0, p_bar_);
}

template <Scalar S>
void BackwardSweep<S>::run(const SweptTrajectory<S>& at, const SweptWeights<S>& weights,
                           const SolveBlock& solve) {
  const Timeline& timeline = at.trajectory.timeline;
  q_bar_.setZero(at.q.rows(), timeline.stage_count());
  qdot_bar_.setZero(at.q.rows(), timeline.stage_count());
  u_bar_ = weights.u;
  p_bar_ = weights.p;
  for (int k = 0; k <= timeline.step_count(); ++k) {
    q_bar_.col(timeline.step_end(k)) += weights.q.col(k);
    qdot_bar_.col(timeline.step_end(k)) += weights.qdot.col(k);
  }
  int k = timeline.step_count();
  for (int s = timeline.last_stage(); s > 0; --s) {
    require_running(horizon_.options().stop, "backward sweep interrupted at stage ", s, " of ",
                    timeline.last_stage());
    set_point(at, s);
    stage_.linearize(at.applied.mechanism, point_, g_);
    if (s == timeline.step_end(k)) {
      if (!measurements_.empty()) {
        add_outputs(at, weights, k,
                    {at.applied, stage_.motion(), &stage_.contacts(), at.q.col(s), at.qdot.col(s),
                     at.u.col(measured_step(k))});
      }
      --k;
    }
    sweep_stage(at, s, solve);
  }
  if (!measurements_.empty()) {
    add_outputs(at, weights, 0,
                start_.at(at.applied, at.q.col(0), at.qdot.col(0), at.u.col(measured_step(0))));
  }
}

template class BackwardSweep<double>;
template class BackwardSweep<Dual>;

}  // namespace hbar
