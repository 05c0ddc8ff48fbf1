#include "hbar/adjoint/derivatives/tangent.h"

#include <utility>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/flat_stencil.h"
#include "hbar/core/base/dual_vectors.h"

namespace hbar {
namespace {

/// Derivatives of measurements along directions: row by row in reverse where there are more
/// directions than rows, direction by direction by dual numbers where there are more rows.
class MeasuredTangent {
 public:
  MeasuredTangent(const Horizon& horizon, const Trajectory& trajectory,
                  const Directions& directions)
      : set_(horizon.parameters()),
        inputs_(trajectory.inputs),
        directions_(directions),
        applied_{*trajectory.mechanism, set_, inputs_.p},
        measurements_(horizon.model(), horizon.measurements()),
        instants_(horizon.model(), measurements_.reads_contacts()),
        dual_measurements_(horizon.model(), horizon.measurements()),
        dual_instants_(horizon.model(), measurements_.reads_contacts()),
        reverse_(measurements_.size() < directions.count()) {
    const bool by_direction = !reverse_ && !measurements_.empty();
    for (Eigen::Index i = 0; i < (by_direction ? directions.count() : 0); ++i) {
      p_.push_back(dual_vector(inputs_.p, directions.p.col(i)));
      mechanisms_.push_back(nominal_mechanism<Dual>(horizon.model()));
      apply_parameters<Dual>(horizon.model(), set_, p_.back(), mechanisms_.back());
    }
  }

  /// Rows of step k, which ends with coordinates q and rates q̇, in `out`.
  void at(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot, const Eigen::MatrixXd& dq,
          const Eigen::MatrixXd& dqdot, Eigen::MatrixXd& out) {
    if (measurements_.empty()) {
      return;
    }
    auto rows = out.middleRows(k * measurements_.size(), measurements_.size());
    if (reverse_) {
      by_row(measured_step(k), q, qdot, dq, dqdot, rows);
    } else {
      by_direction(measured_step(k), q, qdot, dq, dqdot, rows);
    }
  }

 private:
  void by_direction(int step, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot,
                    const Eigen::MatrixXd& dq, const Eigen::MatrixXd& dqdot,
                    Eigen::Ref<Eigen::MatrixXd> out) {
    const Eigen::Index controls = inputs_.u.rows();
    VectorX<Dual> rows(measurements_.size());
    for (std::size_t i = 0; i < mechanisms_.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const Applied<Dual> applied{mechanisms_[i], set_, p_[i]};
      const VectorX<Dual> q_i = dual_vector(q, dq.col(column));
      const VectorX<Dual> qdot_i = dual_vector(qdot, dqdot.col(column));
      const VectorX<Dual> u_i = dual_vector(
          inputs_.u.col(step), directions_.u.col(column).segment(step * controls, controls));
      const Instant<Dual> instant = dual_instants_.at(applied, q_i, qdot_i, u_i);
      dual_measurements_.linearize(instant);
      dual_measurements_.read(instant, rows);
      out.col(column) = slopes_of(rows);
    }
  }

  void by_row(int step, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot,
              const Eigen::MatrixXd& dq, const Eigen::MatrixXd& dqdot,
              Eigen::Ref<Eigen::MatrixXd> out) {
    const Eigen::Index controls = inputs_.u.rows();
    const Instant<double> instant = instants_.at(applied_, q, qdot, inputs_.u.col(step));
    measurements_.linearize(instant);
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(measurements_.size());
    for (Eigen::Index row = 0; row < weights.size(); ++row) {
      by_q_.setZero(q.size());
      by_qdot_.setZero(q.size());
      by_u_.setZero(controls);
      by_p_.setZero(inputs_.p.size());
      InstantGradient<double> by{by_q_, by_qdot_, by_u_, by_p_};
      weights[row] = 1.0;
      measurements_.pull_back(instant, weights, by);
      weights[row] = 0.0;
      auto to = out.row(row);
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
  Applied<double> applied_;
  Measurements<double> measurements_;
  InstantMotion<double> instants_;
  Measurements<Dual> dual_measurements_;
  InstantMotion<Dual> dual_instants_;
  bool reverse_ = true;
  std::vector<VectorX<Dual>> p_;  // per direction, if not in reverse
  std::vector<Mechanism<Dual>> mechanisms_;
  Eigen::VectorXd by_q_, by_qdot_, by_u_, by_p_;
};

/// δq̇ of a stage from δq of the stages it depends on.
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

namespace {

void require_directions(const Horizon& horizon, const Directions& directions) {
  const Model& model = horizon.model();
  const auto require = [&](const char* name, const Eigen::MatrixXd& given, Eigen::Index rows) {
    if (given.rows() != rows || given.cols() != directions.count()) {
      throw InvalidInput(concat("tangent: the directions by ", name, " are ", given.rows(), " x ",
                                given.cols(), "; they must be ", rows, " x ", directions.count()));
    }
  };
  require("p", directions.p, horizon.parameters().size());
  require("u", directions.u, Eigen::Index{model.control_count()} * horizon.steps());
  require("q0", directions.q0, model.dof());
  require("qdot0", directions.qdot0, model.dof());
}

}  // namespace

Tangents TangentSweep::push_forward(const Trajectory& trajectory, const Directions& directions) {
  require_directions(horizon_, directions);
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
  out.measured.resize((steps + 1) * horizon_.measured_count(), directions.count());
  MeasuredTangent measured(horizon_, trajectory, directions);
  for (int k = 0; k <= steps; ++k) {
    const int s = trajectory.timeline.step_end(k);
    out.q.middleRows(k * n, n) = dq.middleRows(s * n, n);
    out.qdot.middleRows(k * n, n) = rate_tangent(model, trajectory, s, dq, directions.qdot0);
    measured.at(k, trajectory.q.col(s), trajectory.qdot.col(s), dq.middleRows(s * n, n),
                out.qdot.middleRows(k * n, n), out.measured);
  }
  return out;
}

double directional_derivative(const TrajectoryPartials& partials, const Tangents& tangents,
                              const Directions& directions, Eigen::Index i) {
  return partials.q.reshaped().dot(tangents.q.col(i)) +
         partials.qdot.reshaped().dot(tangents.qdot.col(i)) +
         partials.measured.reshaped().dot(tangents.measured.col(i)) +
         partials.u.reshaped().dot(directions.u.col(i)) + partials.p.dot(directions.p.col(i));
}

double norm_product(const TrajectoryPartials& partials, const Tangents& tangents) {
  return partials.q.norm() * tangents.q.norm() + partials.qdot.norm() * tangents.qdot.norm() +
         partials.measured.norm() * tangents.measured.norm();
}

}  // namespace hbar
