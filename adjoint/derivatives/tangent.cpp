#include "hbar/adjoint/derivatives/tangent.h"

#include <utility>

#include "hbar/adjoint/outputs/instant_outputs.h"
#include "hbar/adjoint/trajectory/flat_stencil.h"
#include "hbar/core/base/dual_vectors.h"

namespace hbar {
namespace {

/// Derivatives of outputs along directions: row by row in reverse where there are more directions
/// than rows, direction by direction by dual numbers where there are more rows.
class OutputTangent {
 public:
  OutputTangent(const Horizon& horizon, const Trajectory& trajectory, const Directions& directions)
      : set_(horizon.parameters()),
        inputs_(trajectory.inputs),
        directions_(directions),
        outputs_(horizon.model(), horizon.options().measurements),
        dual_outputs_(horizon.model(), horizon.options().measurements),
        mechanism_(*trajectory.mechanism),
        weights_(outputs_.zero_rows()),
        rows_(dual_outputs_.zero_rows()) {
    const Eigen::Index count =
        weights_.v.size() + weights_.tactile.size() + weights_.measured.size();
    reverse_ = count < directions.count();
    for (Eigen::Index i = 0; i < (reverse_ || count == 0 ? 0 : directions.count()); ++i) {
      mechanisms_.push_back(nominal_mechanism<Dual>(horizon.model()));
      apply_parameters<Dual>(horizon.model(), set_, dual_vector(inputs_.p, directions.p.col(i)),
                             mechanisms_.back());
    }
  }

  /// Rows of step k, which ends with coordinates q and rates q̇, in `out`.
  void at(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot, const Eigen::MatrixXd& dq,
          const Eigen::MatrixXd& dqdot, Tangents& out) {
    if (!reverse_) {
      by_direction(k, q, qdot, dq, dqdot, out);
      return;
    }
    const Motion<double>& motion = outputs_.motion_at(mechanism_, q, qdot);
    by_row(k, motion, q, qdot, dq, dqdot, weights_.v, out.v);
    by_row(k, motion, q, qdot, dq, dqdot, weights_.tactile, out.tactile);
    by_row(k, motion, q, qdot, dq, dqdot, weights_.measured, out.measured);
  }

 private:
  static void set(const VectorX<Dual>& rows, int k, Eigen::Ref<Eigen::VectorXd> out) {
    out.segment(k * rows.size(), rows.size()) = slopes_of(rows);
  }

  void by_direction(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot,
                    const Eigen::MatrixXd& dq, const Eigen::MatrixXd& dqdot, Tangents& out) {
    const Eigen::Index controls = inputs_.u.rows();
    const int step = measured_step(k);
    for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const VectorX<Dual> q_i = dual_vector(q, dq.col(column));
      const VectorX<Dual> qdot_i = dual_vector(qdot, dqdot.col(column));
      const VectorX<Dual> u_i = dual_vector(
          inputs_.u.col(step), directions_.u.col(column).segment(step * controls, controls));
      dual_outputs_.read(mechanisms_[i], dual_outputs_.motion_at(mechanisms_[i], q_i, qdot_i), q_i,
                         qdot_i, u_i, rows_);
      set(rows_.v, k, out.v.col(column));
      set(rows_.tactile, k, out.tactile.col(column));
      set(rows_.measured, k, out.measured.col(column));
    }
  }

  /// @param weights  the member of weights_ whose rows are wanted
  void by_row(int k, const Motion<double>& motion, const Eigen::VectorXd& q,
              const Eigen::VectorXd& qdot, const Eigen::MatrixXd& dq, const Eigen::MatrixXd& dqdot,
              Eigen::VectorXd& weights, Eigen::MatrixXd& out) {
    const Eigen::Index controls = inputs_.u.rows();
    const int step = measured_step(k);
    for (Eigen::Index row = 0; row < weights.size(); ++row) {
      by_q_.setZero(q.size());
      by_qdot_.setZero(q.size());
      by_u_.setZero(controls);
      by_p_.setZero(inputs_.p.size());
      weights[row] = 1.0;
      outputs_.pull_back(mechanism_, set_, inputs_.p, motion, q, qdot, inputs_.u.col(step),
                         weights_, by_q_, by_qdot_, by_u_, by_p_);
      weights[row] = 0.0;
      auto to = out.row(k * weights.size() + row);
      to.noalias() = by_q_.transpose() * dq;
      to.noalias() += by_qdot_.transpose() * dqdot;
      to.noalias() += by_p_.transpose() * directions_.p;
      if (!by_u_.isZero(0.0)) {
        to.noalias() += by_u_.transpose() * directions_.u.middleRows(step * controls, controls);
      }
    }
  }

  const ParameterSet& set_;
  const Inputs& inputs_;
  const Directions& directions_;
  bool reverse_ = true;
  InstantOutputs<double> outputs_;
  InstantOutputs<Dual> dual_outputs_;
  const Mechanism<double>& mechanism_;
  std::vector<Mechanism<Dual>> mechanisms_;  // per direction, if not in reverse
  OutputRows<double> weights_;               // all zero but for the row in hand
  OutputRows<Dual> rows_;
  Eigen::VectorXd by_q_, by_qdot_, by_u_, by_p_;
};

/// δq̇ of a stage from δq of the stages it looks back on.
Eigen::MatrixXd rate_tangent(const Model& model, const Trajectory& trajectory, int s,
                             const Eigen::MatrixXd& dq, const Eigen::MatrixXd& dqdot0) {
  const int n = model.dof();
  if (s == 0) {
    return dqdot0;
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, dq.cols());
  for (const auto& entry : flat_stencil(trajectory.timeline, s).entries) {
    out += entry.qdot * dq.middleRows(entry.stage * n, n);
  }
  for (const int node : nodes_with_chart_switch(trajectory, s)) {
    const int first = model.tree().node(node).coordinates.begin;
    out.middleRows<3>(first).setZero();
    for (const auto& entry : flat_stencil(model, trajectory, s, node).entries) {
      out.middleRows<3>(first) += entry.qdot * dq.middleRows<3>(entry.stage * n + first);
    }
  }
  return out;
}

}  // namespace

Directions Directions::zero(const Horizon& horizon, Eigen::Index count) {
  const Model& model = horizon.model();
  return {Eigen::MatrixXd::Zero(horizon.parameters().size(), count),
          Eigen::MatrixXd::Zero(model.control_count() * horizon.options().steps, count),
          Eigen::MatrixXd::Zero(model.dof(), count), Eigen::MatrixXd::Zero(model.dof(), count)};
}

TangentSweep::TangentSweep(const Horizon& horizon, solvers::SolverFactory factory)
    : horizon_(horizon), system_(horizon, std::move(factory)) {}

Tangents TangentSweep::push_forward(const Trajectory& trajectory, const Directions& directions) {
  const Linearization& system = system_.update(trajectory);
  const Model& model = horizon_.model();
  const int n = model.dof();
  const int stages = trajectory.timeline.stage_count();
  const int steps = trajectory.step_count();
  rhs_ = -(system.dg_dq0.matrix() * directions.q0);
  rhs_ -= system.dg_dqdot0.matrix() * directions.qdot0;
  rhs_ -= system.dg_dp * directions.p;
  rhs_ -= system.dg_du * directions.u;
  Eigen::MatrixXd dq(stages * n, directions.count());
  dq.topRows(n) = directions.q0;
  Eigen::MatrixXd solution(rhs_.rows(), rhs_.cols());
  system_.solver().solve(rhs_, solution);
  dq.bottomRows(rhs_.rows()) = solution;
  Tangents out;
  out.q.resize((steps + 1) * n, directions.count());
  out.qdot.resize((steps + 1) * n, directions.count());
  out.v.resize((steps + 1) * model.variable_count(), directions.count());
  out.tactile.resize((steps + 1) * model.tactile_count(), directions.count());
  out.measured.resize((steps + 1) * horizon_.measured_count(), directions.count());
  OutputTangent outputs(horizon_, trajectory, directions);
  for (int k = 0; k <= steps; ++k) {
    const int s = trajectory.timeline.step_end(k);
    out.q.middleRows(k * n, n) = dq.middleRows(s * n, n);
    out.qdot.middleRows(k * n, n) = rate_tangent(model, trajectory, s, dq, directions.qdot0);
    outputs.at(k, trajectory.q.col(s), trajectory.qdot.col(s), dq.middleRows(s * n, n),
               out.qdot.middleRows(k * n, n), out);
  }
  return out;
}

double directional_derivative(const TrajectoryPartials& partials, const Tangents& tangents,
                              const Directions& directions, Eigen::Index i) {
  return partials.q.reshaped().dot(tangents.q.col(i)) +
         partials.qdot.reshaped().dot(tangents.qdot.col(i)) +
         partials.v.reshaped().dot(tangents.v.col(i)) +
         partials.tactile.reshaped().dot(tangents.tactile.col(i)) +
         partials.measured.reshaped().dot(tangents.measured.col(i)) +
         partials.u.reshaped().dot(directions.u.col(i)) + partials.p.dot(directions.p.col(i));
}

double norm_product(const TrajectoryPartials& partials, const Tangents& tangents) {
  return partials.q.norm() * tangents.q.norm() + partials.qdot.norm() * tangents.qdot.norm() +
         partials.v.norm() * tangents.v.norm() + partials.tactile.norm() * tangents.tactile.norm() +
         partials.measured.norm() * tangents.measured.norm();
}

}  // namespace hbar
