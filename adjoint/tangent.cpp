#include "hbar/adjoint/tangent.h"

#include <utility>

#include "hbar/core/measurements.h"

namespace hbar {
namespace {

/// Adds ∂v/∂p δp at one step to its rows.
class VariableTangent {
 public:
  explicit VariableTangent(Simulator& simulator)
      : simulator_(simulator),
        mechanism_(nominal_mechanism<double>(simulator.model())),
        motion_(simulator.model().tree()),
        end_effectors_(simulator.model()) {}

  /// δv = ∂v/∂q δq + ∂v/∂p δp at coordinates q.
  Eigen::MatrixXd at(const Inputs& inputs, const Eigen::VectorXd& q, const Eigen::MatrixXd& dq,
                     const Eigen::MatrixXd& dp) {
    const Model& model = simulator_.model();
    const int n = model.dof();
    const int variables = model.variable_count();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    compute_motion<double>(model.tree(), mechanism_, q, none, none, motion_);
    Eigen::MatrixXd dv_dq(variables, n);
    end_effectors_.jacobian(motion_, dv_dq);
    Eigen::MatrixXd out = dv_dq * dq;
    if (dp.rows() > 0) {
      Eigen::VectorXd by_q(n);
      Eigen::VectorXd row(dp.rows());
      for (int i = 0; i < variables; ++i) {
        by_q.setZero();
        row.setZero();
        end_effectors_.pull_back(mechanism_, simulator_.parameters(), inputs.p, motion_,
                                 Eigen::VectorXd::Unit(variables, i), by_q, row);
        out.row(i) += row.transpose() * dp;
      }
    }
    return out;
  }

  void set_parameters(const Eigen::VectorXd& p) {
    apply_parameters<double>(simulator_.model(), simulator_.parameters(), p, mechanism_);
  }

 private:
  Simulator& simulator_;
  Mechanism<double> mechanism_;
  Motion<double> motion_;
  EndEffectors<double> end_effectors_;
};

/// Derivatives of sensor readings and measurements along one direction at a time, by dual numbers.
class ReadingTangent {
 public:
  /// @param dp  no column where nothing is to be read
  ReadingTangent(Simulator& simulator, const Inputs& inputs, const Eigen::MatrixXd& dp)
      : model_(simulator.model()),
        inputs_(inputs),
        motion_(model_.tree()),
        tactile_(model_),
        measurements_(model_, simulator.options().measurements),
        none_(VectorX<Dual>::Zero(model_.dof())),
        touched_(VectorX<Dual>::Zero(model_.tactile_count())),
        measured_(VectorX<Dual>::Zero(measurements_.size())) {
    for (Eigen::Index i = 0; i < dp.cols(); ++i) {
      mechanisms_.push_back(nominal_mechanism<Dual>(model_));
      apply_parameters<Dual>(model_, simulator.parameters(), dual(inputs.p, dp.col(i)),
                             mechanisms_.back());
    }
  }

  /// Rows of step k, which ends with coordinates q and rates q̇, in `out`.
  void at(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot, const Eigen::MatrixXd& dq,
          const Eigen::MatrixXd& dqdot, const Eigen::MatrixXd& du, Tangents& out) {
    const int step = measured_step(k);
    const auto slope = [](const Dual& reading) { return reading.slope; };
    for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const VectorX<Dual> q_i = dual(q, dq.col(column));
      const VectorX<Dual> qdot_i = dual(qdot, dqdot.col(column));
      const VectorX<Dual> u_i = dual(
          inputs_.u.col(step), du.col(column).segment(step * inputs_.u.rows(), inputs_.u.rows()));
      compute_motion<Dual>(model_.tree(), mechanisms_[i], q_i, qdot_i, none_, motion_);
      tactile_.readings(mechanisms_[i], motion_, touched_);
      measurements_.readings(mechanisms_[i], motion_, q_i, qdot_i, u_i, measured_);
      out.tactile.col(column).segment(k * touched_.size(), touched_.size()) =
          touched_.unaryExpr(slope);
      out.measured.col(column).segment(k * measured_.size(), measured_.size()) =
          measured_.unaryExpr(slope);
    }
  }

 private:
  static VectorX<Dual> dual(const Eigen::VectorXd& value, const Eigen::VectorXd& slope) {
    VectorX<Dual> out(value.size());
    for (Eigen::Index i = 0; i < value.size(); ++i) {
      out[i] = {value[i], slope[i]};
    }
    return out;
  }

  const Model& model_;
  const Inputs& inputs_;
  std::vector<Mechanism<Dual>> mechanisms_;  // per direction
  Motion<Dual> motion_;
  TactileReadings<Dual> tactile_;
  Measurements<Dual> measurements_;
  VectorX<Dual> none_;
  VectorX<Dual> touched_;
  VectorX<Dual> measured_;
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

Directions Directions::zero(const Simulator& simulator, Eigen::Index count) {
  const Model& model = simulator.model();
  return {Eigen::MatrixXd::Zero(simulator.parameters().size(), count),
          Eigen::MatrixXd::Zero(model.control_count() * simulator.options().steps, count),
          Eigen::MatrixXd::Zero(model.dof(), count), Eigen::MatrixXd::Zero(model.dof(), count)};
}

TangentSweep::TangentSweep(Simulator& simulator, solvers::SolverFactory factory)
    : simulator_(simulator), system_(simulator, std::move(factory)) {}

Tangents TangentSweep::push_forward(const Trajectory& trajectory, const Directions& directions) {
  const Linearization& system = system_.update(trajectory);
  const Model& model = simulator_.model();
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
  const int measured = simulator_.measured_count();
  const bool reads = model.tactile_count() + measured > 0;
  out.tactile.resize((steps + 1) * model.tactile_count(), directions.count());
  out.measured.resize((steps + 1) * measured, directions.count());
  ReadingTangent readings(simulator_, trajectory.inputs, reads ? directions.p : Eigen::MatrixXd());
  VariableTangent variables(simulator_);
  variables.set_parameters(trajectory.inputs.p);
  for (int k = 0; k <= steps; ++k) {
    const int s = trajectory.timeline.step_end(k);
    out.q.middleRows(k * n, n) = dq.middleRows(s * n, n);
    out.qdot.middleRows(k * n, n) = rate_tangent(model, trajectory, s, dq, directions.qdot0);
    if (model.variable_count() > 0) {
      out.v.middleRows(k * model.variable_count(), model.variable_count()) = variables.at(
          trajectory.inputs, trajectory.q.col(s), dq.middleRows(s * n, n), directions.p);
    }
    if (reads) {
      readings.at(k, trajectory.q.col(s), trajectory.qdot.col(s), dq.middleRows(s * n, n),
                  out.qdot.middleRows(k * n, n), directions.u, out);
    }
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
