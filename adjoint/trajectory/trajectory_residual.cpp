#include "hbar/adjoint/trajectory/trajectory_residual.h"

namespace hbar {

TrajectoryResidual::TrajectoryResidual(const Horizon& horizon)
    : horizon_(horizon),
      history_(horizon.model()),
      stage_(horizon.model()),
      point_(horizon.model()),
      g_(horizon.model().dof()) {}

const Eigen::VectorXd& TrajectoryResidual::evaluate(Trajectory& trajectory) {
  const int n = horizon_.model().dof();
  g_bar_.resize(n * trajectory.timeline.last_stage());
  for (int s = 1; s <= trajectory.timeline.last_stage(); ++s) {
    history_.set_point(trajectory, s, point_);
    trajectory.qdot.col(s) = point_.qdot;
    stage_.residual(*trajectory.mechanism, point_, g_);
    g_bar_.segment((s - 1) * n, n) = g_;
  }
  return g_bar_;
}

}  // namespace hbar
