#include "hbar/adjoint/derivatives/gradient.h"

#include <algorithm>
#include <memory>

#include "hbar/adjoint/derivatives/backward_sweep.h"
#include "hbar/adjoint/trajectory/check_trajectory.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

constexpr double kResidualGoal = 1e-15;
constexpr double kResidualBound = 1e-11;
constexpr int kRefinements = 4;

}  // namespace

struct AdjointSweep::Workspace {
  explicit Workspace(const Horizon& h)
      : horizon(h),
        reader(h),
        sweep(h),
        block(h.model().dof(), h.model().dof()),
        lu(h.model().dof()) {}

  void solve_block(const Trajectory& trajectory, int s, const Eigen::VectorXd& y,
                   StageResidual<double>& stage, Eigen::VectorXd& z);

  Horizon horizon;
  ValueReader reader;
  BackwardSweep<double> sweep;
  Eigen::VectorXd residual, correction;
  Eigen::MatrixXd block;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Eigen::MatrixXd z_bar;  // per stage
  double worst_residual = 0.0;
  int refactorized = 0;
};

/// z = H_ss⁻ᵀ y, refined against the exact block through its transposed product.
void AdjointSweep::Workspace::solve_block(const Trajectory& trajectory, int s,
                                          const Eigen::VectorXd& y, StageResidual<double>& stage,
                                          Eigen::VectorXd& z) {
  const double rate = stage.rate();
  const auto measure = [&]() {
    stage.pull_back(z);
    const auto product = stage.by_q() + rate * stage.by_qdot() + (rate * rate) * stage.by_a();
    residual = y - product;
    const double scale = y.norm() + (rate * rate) * stage.by_a().norm();
    return scale == 0.0 ? 0.0 : residual.norm() / scale;  // a NaN stays one
  };
  const auto refine = [&](const Eigen::PartialPivLU<Eigen::MatrixXd>& factors) {
    z = factors.transpose().solve(y);
    double error = measure();
    for (int i = 0; i < kRefinements && error > kResidualGoal; ++i) {
      const double before = error;
      correction = factors.transpose().solve(residual);
      z += correction;
      error = measure();
      if (!(error < 0.5 * before)) {
        break;
      }
    }
    return error;
  };
  double error = 1.0;
  if (!trajectory.factors.empty()) {
    error = refine(trajectory.factors[static_cast<std::size_t>(s)]);
  }
  if (!(error <= 1e-14)) {
    ++refactorized;
    stage.newton_matrix(block);
    lu.compute(block);
    error = refine(lu);
  }
  if (!(error <= kResidualBound)) {
    throw NumericalFailure(
        concat("adjoint: the block of stage ", s, " (t = ", trajectory.timeline.stage(s).time,
               ") is singular or too ill-conditioned: relative residual ", error, ", bound ",
               kResidualBound, "; look for massless or locked coordinates there"));
  }
  worst_residual = std::max(worst_residual, error);
  z_bar.col(s - 1) = z;
}

AdjointSweep::AdjointSweep(const Horizon& horizon)
    : work_("AdjointSweep", std::make_unique<Workspace>(horizon)) {}
AdjointSweep::~AdjointSweep() = default;
AdjointSweep::AdjointSweep(AdjointSweep&&) noexcept = default;
AdjointSweep& AdjointSweep::operator=(AdjointSweep&&) noexcept = default;

const Eigen::MatrixXd& AdjointSweep::adjoint() const { return work_->z_bar; }
double AdjointSweep::worst_residual() const { return work_->worst_residual; }
int AdjointSweep::refactorized() const { return work_->refactorized; }

Gradient AdjointSweep::pull_back(const Trajectory& trajectory, const TrajectoryPartials& partials) {
  Workspace& w = *work_;
  require_whole_trajectory_of(w.horizon, trajectory);
  w.z_bar.resize(w.horizon.model().dof(), trajectory.timeline.last_stage());
  w.worst_residual = 0.0;
  w.refactorized = 0;
  const Applied<double> applied{*trajectory.mechanism, w.horizon.parameters(), trajectory.inputs.p};
  w.sweep.run({trajectory, applied, trajectory.q, trajectory.qdot, trajectory.inputs.u},
              {partials.q, partials.qdot, partials.measured, partials.u, partials.p},
              [&](int s, const Eigen::VectorXd& y, StageResidual<double>& stage,
                  Eigen::VectorXd& z) { w.solve_block(trajectory, s, y, stage, z); });
  return {0.0, w.sweep.by_p(), w.sweep.by_u(), w.sweep.by_q0(), w.sweep.by_qdot0()};
}

Gradient AdjointSweep::gradient(const Trajectory& trajectory, const Objective& objective) {
  TrajectoryValues values = work_->reader.values(trajectory);
  const TrajectoryPartials partials = objective.partials(values);
  const double value = objective.value(values);
  values = {};  // they are as large as the partials
  Gradient out = pull_back(trajectory, partials);
  out.value = value;
  return out;
}

Gradient gradient(const Horizon& horizon, const Trajectory& trajectory,
                  const Objective& objective) {
  return AdjointSweep(horizon).gradient(trajectory, objective);
}

}  // namespace hbar
