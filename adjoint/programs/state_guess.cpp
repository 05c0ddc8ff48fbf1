#include "hbar/adjoint/programs/state_guess.h"

#include <algorithm>
#include <cmath>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"

namespace hbar {

Eigen::MatrixXd guess_states(const TrajectoryProblem& problem, const InputVariables& head,
                             const Eigen::MatrixXd& q_guess) {
  const Horizon& horizon = problem.horizon;
  const Eigen::Index dof = horizon.model().dof();
  const int steps = horizon.options().steps;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * dof, steps + 1);
  if (q_guess.size() > 0) {
    if (q_guess.rows() != dof || q_guess.cols() != steps + 1 || !q_guess.allFinite()) {
      throw InvalidInput(concat("transcription: q_guess is ", q_guess.rows(), " x ", q_guess.cols(),
                                "; it must be ", dof, " x ", steps + 1, " and finite"));
    }
    const Eigen::VectorXd q0 = head.inputs(head.variables().start).q0;
    for (Eigen::Index i = 0; i < dof; ++i) {
      if (std::abs(q_guess(i, 0) - q0[i]) > 1e-6 * std::max(1.0, std::abs(q0[i]))) {
        throw InvalidInput(concat("transcription: q_guess begins with ", q_guess(i, 0), " for '",
                                  horizon.model().coordinate_name(static_cast<int>(i)),
                                  "'; the motion begins with q0 = ", q0[i]));
      }
    }
    out.topRows(dof) = q_guess;
    out.bottomRows(dof).rightCols(steps) =
        (q_guess.rightCols(steps) - q_guess.leftCols(steps)) / horizon.options().h;
    out.bottomRows(dof).col(0) = out.bottomRows(dof).col(1);
    return out;
  }
  const Rollout rollout = simulate(horizon, head.inputs(head.variables().start));
  const Trajectory& reached = rollout.partial();
  if (!reached.chart_switches.empty()) {
    const ChartSwitch& first = reached.chart_switches.front();
    const Model& model = horizon.model();
    throw InvalidInput(
        concat("transcription: in the first guess exponential coordinates of '",
               model.coordinate_name(model.tree().node(first.node).coordinates.begin),
               "' change chart at t = ", reached.timeline.stage(first.stage).time,
               ", where states are variables; give a q_guess that stays within one turn, use "
               "shooting, or Euler angles"));
  }
  const int done = reached.step_count();
  for (int k = 0; k <= done; ++k) {
    out.col(k) << reached.q_at_step(k), reached.qdot_at_step(k);
  }
  out.topRows(dof).rightCols(steps - done).colwise() = out.topRows(dof).col(done).eval();
  return out;
}

}  // namespace hbar
