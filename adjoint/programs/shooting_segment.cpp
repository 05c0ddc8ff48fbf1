#include "hbar/adjoint/programs/shooting_segment.h"

#include <utility>

#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// Options of a part of a horizon; restarts within it are counted from its own start.
SimulationOptions options_of_stretch(const Horizon& whole, int first_step, int steps) {
  SimulationOptions out = whole.options();
  out.steps = steps;
  out.restarts.clear();
  for (const int step : whole.options().restarts) {
    if (step > first_step && step < first_step + steps) {
      out.restarts.push_back(step - first_step);
    }
  }
  return out;
}

}  // namespace

ShootingSegment::ShootingSegment(const Horizon& whole, int first_step, int steps, int hold,
                                 SegmentColumns columns)
    : first_step_(first_step),
      hold_(hold),
      columns_(columns),
      simulator_(whole.with(options_of_stretch(whole, first_step, steps))),
      reader_(horizon()),
      adjoint_(horizon()),
      tangent_(horizon()),
      second_(horizon()) {}

void ShootingSegment::simulate(const Inputs& inputs) {
  failure_.clear();
  try {
    trajectory_ = simulator_.rollout(inputs).trajectory();
    values_ = reader_.values(trajectory_);
  } catch (const NumericalFailure& error) {
    failure_ = error.what();
  } catch (const InvalidInput& error) {  // parameters that are physically impossible
    failure_ = error.what();
  }
}

Eigen::Index ShootingSegment::control_variable(int k, Eigen::Index i) const {
  const int block = (first_step_ + k) / hold_ - first_step_ / hold_;
  return columns_.design + block * horizon().model().control_count() + i;
}

const Tangents& ShootingSegment::differentiate(const Eigen::MatrixXd& map_jacobian) {
  Directions along = Directions::zero(horizon(), columns_.size());
  along.p.leftCols(columns_.design) = map_jacobian;
  const Eigen::Index controls = horizon().model().control_count();
  for (int k = 0; k < step_count(); ++k) {
    for (Eigen::Index i = 0; i < controls; ++i) {
      along.u(k * controls + i, control_variable(k, i)) = 1.0;
    }
  }
  if (columns_.state > 0) {
    const Eigen::Index dof = horizon().model().dof();
    along.q0.rightCols(2 * dof).leftCols(dof).setIdentity();
    along.qdot0.rightCols(dof).setIdentity();
  }
  tangents_ = tangent_.push_forward(trajectory_, along);
  return tangents_;
}

Inputs ShootingSegment::direction(Eigen::Index variable,
                                  const Eigen::MatrixXd& map_jacobian) const {
  const Inputs& at = trajectory_.inputs;
  const Eigen::Index dof = at.q0.size();
  Inputs out{Eigen::VectorXd::Zero(at.p.size()), Eigen::MatrixXd::Zero(at.u.rows(), at.u.cols()),
             Eigen::VectorXd::Zero(dof), Eigen::VectorXd::Zero(dof)};
  if (variable < columns_.design) {
    out.p = map_jacobian.col(variable);
    return out;
  }
  const Eigen::Index state = variable - columns_.design - columns_.controls;
  if (state >= 0) {
    (state < dof ? out.q0[state] : out.qdot0[state - dof]) = 1.0;
    return out;
  }
  for (int k = 0; k < step_count(); ++k) {
    for (Eigen::Index i = 0; i < out.u.rows(); ++i) {
      out.u(i, k) = control_variable(k, i) == variable ? 1.0 : 0.0;
    }
  }
  return out;
}

Eigen::MatrixXd ShootingSegment::curvature(const TrajectoryPartials& weights,
                                           const Eigen::MatrixXd& map_jacobian,
                                           Eigen::VectorXd& by_p) {
  const Eigen::Index dof = horizon().model().dof();
  by_p = second_.set_point(trajectory_, weights).p;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(columns_.size(), columns_.size());
  for (Eigen::Index j = 0; j < columns_.size(); ++j) {
    static_cast<void>(second_.push_forward(direction(j, map_jacobian)));
    const Gradient& product = second_.product();
    out.col(j).head(columns_.design) = map_jacobian.transpose() * product.p;
    for (int k = 0; k < step_count(); ++k) {
      for (Eigen::Index i = 0; i < product.u.rows(); ++i) {
        out(control_variable(k, i), j) += product.u(i, k);
      }
    }
    if (columns_.state > 0) {
      out.col(j).tail(2 * dof) << product.q0, product.qdot0;
    }
  }
  return out;
}

}  // namespace hbar
