#include "hbar/adjoint/derivatives/stage_hessian.h"

#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/core/base/dual_vectors.h"
#include "hbar/core/model/drives.h"

namespace hbar {
namespace {

VectorX<Dual> without_slope(const Eigen::VectorXd& values) { return values.cast<Dual>(); }

}  // namespace

StageHessian::StageHessian(const Horizon& horizon, Eigen::Index designs)
    : horizon_(horizon),
      stage_(horizon.model()),
      measurements_(horizon.model(), horizon.measurements()),
      instants_(horizon.model(), measurements_.reads_contacts()),
      history_(horizon.model()),
      at_(horizon.model()),
      point_(horizon.model()),
      still_(nominal_mechanism<Dual>(horizon.model())),
      moving_(static_cast<std::size_t>(designs), nominal_mechanism<Dual>(horizon.model())),
      moving_p_(static_cast<std::size_t>(designs)),
      g_(horizon.model().dof()) {
  const Eigen::Index n = horizon.model().dof();
  const Eigen::Index controls = horizon.model().control_count();
  for (Eigen::MatrixXd* square : {&out_.qq, &out_.qv, &out_.qa, &out_.vv}) {
    square->setZero(n, n);
  }
  out_.uq.setZero(controls, n);
  out_.uv.setZero(controls, n);
  for (Eigen::MatrixXd* wide : {&out_.dq, &out_.dv, &out_.da, &out_.dsq, &out_.dsv}) {
    wide->setZero(designs, n);
  }
  out_.du.setZero(designs, controls);
  out_.dd.setZero(designs, designs);
  out_.by_p.setZero(horizon.parameters().size());
}

void StageHessian::set_parameters(const Eigen::VectorXd& p, const Eigen::MatrixXd& map_jacobian) {
  map_jacobian_ = map_jacobian;
  still_p_ = without_slope(p);
  apply_parameters<Dual>(horizon_.model(), horizon_.parameters(), still_p_, still_);
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    moving_p_[i] = still_p_;
    for (Eigen::Index k = 0; k < p.size(); ++k) {
      moving_p_[i][k].slope = map_jacobian(k, static_cast<Eigen::Index>(i));
    }
    apply_parameters<Dual>(horizon_.model(), horizon_.parameters(), moving_p_[i], moving_[i]);
  }
}

void StageHessian::set_zero() {
  for (Eigen::MatrixXd* part :
       {&out_.qq, &out_.qv, &out_.qa, &out_.vv, &out_.uq, &out_.uv, &out_.dq, &out_.dv, &out_.da,
        &out_.dsq, &out_.dsv, &out_.du, &out_.dd}) {
    part->setZero();
  }
  out_.by_p.setZero();
}

/// by_q_ and by_qdot_ of zᵀ g at the current point.
void StageHessian::linearize_stage(const Mechanism<Dual>& mechanism) {
  stage_.linearize(mechanism, point_, g_);
  stage_.pull_back(z_);
  by_q_ = stage_.by_q();
  by_qdot_ = stage_.by_qdot();
}

/// Adds the outputs' gradients to by_q_, by_qdot_, by_u_ and by_p_.
void StageHessian::linearize_outputs(const Mechanism<Dual>& mechanism, const VectorX<Dual>& p) {
  if (has_outputs_) {
    const Applied<Dual> applied{mechanism, horizon_.parameters(), p};
    const Instant<Dual> at = instants_.at(applied, point_.q, point_.qdot, point_.u);
    InstantGradient<Dual> by{by_q_, by_qdot_, by_u_, by_p_};
    measurements_.linearize(at);
    measurements_.pull_back(at, y_, by);
  }
}

void StageHessian::evaluate_design(Eigen::Index i, bool with_stage) {
  const auto k = static_cast<std::size_t>(i);
  by_u_.setZero();
  by_p_.setZero();
  if (with_stage) {
    linearize_stage(moving_[k]);
    add_parameter_gradient<Dual>({moving_[k], horizon_.parameters(), moving_p_[k]}, stage_, point_,
                                 z_, 1.0, by_p_);
    const JointForces<Dual>& forces = stage_.joint_forces();
    const double c = point_.c();
    out_.da.row(i) = slopes_of(stage_.by_a());
    out_.dsq.row(i) = -c * slopes_of(z_.cwiseProduct(forces.by_start_q));
    out_.dsv.row(i) = -c * slopes_of(z_.cwiseProduct(forces.by_start_qdot));
    for_each_drive(horizon_.model(), [&](int at, int control) {
      by_u_[control] -= c * z_[at] * forces.by_u[control];
    });
  } else {
    by_q_.setZero();
    by_qdot_.setZero();
  }
  linearize_outputs(moving_[k], moving_p_[k]);
  out_.dq.row(i) = slopes_of(by_q_);
  out_.dv.row(i) = slopes_of(by_qdot_);
  out_.du.row(i) = slopes_of(by_u_);
  out_.dd.row(i) = map_jacobian_.transpose() * slopes_of(by_p_).matrix();
  if (i == 0) {
    out_.by_p = by_p_.unaryExpr([](const Dual& x) { return x.value; });
  }
}

const StageCurvature& StageHessian::evaluate(const Trajectory& trajectory, int stage,
                                             const Eigen::VectorXd& z, const Eigen::VectorXd* y) {
  set_zero();
  history_.set_point(trajectory, stage, at_);
  point_.q = without_slope(at_.q);
  point_.qdot = without_slope(at_.qdot);
  point_.a = without_slope(at_.a);
  point_.u = without_slope(at_.u);
  point_.start = {without_slope(at_.start.q), without_slope(at_.start.qdot)};
  point_.rate = at_.rate;
  z_ = without_slope(z);
  by_p_.setZero(still_p_.size());
  by_u_.setZero(at_.u.size());
  has_outputs_ = y != nullptr;
  if (has_outputs_) {
    y_ = without_slope(*y);
  }
  for (Eigen::Index i = 0; i < at_.q.size(); ++i) {
    point_.q[i].slope = 1.0;
    by_u_.setZero();
    linearize_stage(still_);
    linearize_outputs(still_, still_p_);
    point_.q[i].slope = 0.0;
    out_.qq.row(i) = slopes_of(by_q_);
    out_.qv.row(i) = slopes_of(by_qdot_);
    out_.qa.row(i) = slopes_of(stage_.by_a());
    out_.uq.col(i) = slopes_of(by_u_);
    point_.qdot[i].slope = 1.0;
    by_u_.setZero();
    linearize_stage(still_);
    linearize_outputs(still_, still_p_);
    point_.qdot[i].slope = 0.0;
    out_.vv.row(i) = slopes_of(by_qdot_);
    out_.uv.col(i) = slopes_of(by_u_);
  }
  for (Eigen::Index i = 0; i < out_.dq.rows(); ++i) {
    evaluate_design(i, true);
  }
  return out_;
}

const StageCurvature& StageHessian::evaluate_start(const Trajectory& trajectory,
                                                   const Eigen::VectorXd& y) {
  set_zero();
  point_.q = without_slope(trajectory.q.col(0));
  point_.qdot = without_slope(trajectory.qdot.col(0));
  point_.u = without_slope(trajectory.inputs.u.col(0));
  by_p_.setZero(still_p_.size());
  by_u_.setZero(point_.u.size());
  by_q_.setZero(point_.q.size());
  by_qdot_.setZero(point_.q.size());
  has_outputs_ = true;
  y_ = without_slope(y);
  const auto along = [&](Dual& moved, Eigen::Index i, Eigen::MatrixXd& by_u) {
    by_q_.setZero();
    by_qdot_.setZero();
    by_u_.setZero();
    moved.slope = 1.0;
    linearize_outputs(still_, still_p_);
    moved.slope = 0.0;
    by_u.col(i) = slopes_of(by_u_);
  };
  for (Eigen::Index i = 0; i < point_.q.size(); ++i) {
    along(point_.q[i], i, out_.uq);
    out_.qq.row(i) = slopes_of(by_q_);
    out_.qv.row(i) = slopes_of(by_qdot_);
    along(point_.qdot[i], i, out_.uv);
    out_.vv.row(i) = slopes_of(by_qdot_);
  }
  for (Eigen::Index i = 0; i < out_.dq.rows(); ++i) {
    evaluate_design(i, false);
  }
  return out_;
}

}  // namespace hbar
