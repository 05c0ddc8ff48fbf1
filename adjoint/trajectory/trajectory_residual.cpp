#include "hbar/adjoint/trajectory/trajectory_residual.h"

namespace hbar {

TrajectoryResidual::TrajectoryResidual(Simulator& simulator)
    : simulator_(simulator),
      mechanism_(nominal_mechanism<double>(simulator.model())),
      stage_(simulator.model()),
      point_(simulator.model()),
      g_(simulator.model().dof()) {}

const Eigen::VectorXd& TrajectoryResidual::evaluate(Trajectory& trajectory) {
  const Model& model = simulator_.model();
  const int n = model.dof();
  apply_parameters<double>(model, simulator_.parameters(), trajectory.inputs.p, mechanism_);
  g_bar_.resize(n * trajectory.timeline.last_stage());
  for (int s = 1; s <= trajectory.timeline.last_stage(); ++s) {
    simulator_.set_point(trajectory, s, point_);
    trajectory.qdot.col(s) = point_.qdot;
    stage_.residual(mechanism_, point_, g_);
    g_bar_.segment((s - 1) * n, n) = g_;
  }
  return g_bar_;
}

}  // namespace hbar
