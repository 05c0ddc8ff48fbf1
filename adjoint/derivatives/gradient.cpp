#include "hbar/adjoint/derivatives/gradient.h"

#include <algorithm>

#include "hbar/adjoint/outputs/instant_outputs.h"
#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/drives.h"

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
        history(h.model()),
        stage(h.model()),
        point(h.model()),
        outputs(h.model(), h.options().measurements),
        rows(outputs.zero_rows()),
        y_start{Eigen::VectorXd(h.model().dof()), Eigen::VectorXd(h.model().dof())},
        block(h.model().dof(), h.model().dof()),
        lu(h.model().dof()) {}

  void add_variables(const Trajectory& trajectory, const TrajectoryPartials& partials, int k,
                     Gradient& out);
  void solve_block(const Trajectory& trajectory, int s);
  void sweep_stage(const Trajectory& trajectory, int s, Gradient& out);

  Horizon horizon;
  ValueReader reader;
  History history;
  StageResidual<double> stage;
  StagePoint<double> point;
  InstantOutputs<double> outputs;
  OutputRows<double> rows;
  Eigen::MatrixXd q_bar;     // ∂L/∂q per stage, so far
  Eigen::MatrixXd qdot_bar;  // ∂L/∂q̇ per stage, so far
  Eigen::VectorXd g, y, z, residual, correction, y_qdot, y_a;
  StepStart<double> y_start;
  Eigen::MatrixXd block;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Eigen::MatrixXd z_bar;  // per stage
  double worst_residual = 0.0;
  int refactorized = 0;
};

/// Brings ∂Ψ/∂v, ∂Ψ/∂tactile and ∂Ψ/∂measured at step k to coordinates, rates, controls,
/// parameters.
void AdjointSweep::Workspace::add_variables(const Trajectory& trajectory,
                                            const TrajectoryPartials& partials, int k,
                                            Gradient& out) {
  if (outputs.empty()) {
    return;
  }
  const int s = trajectory.timeline.step_end(k);
  const int step = measured_step(k);
  rows.v = partials.v.col(k);
  rows.tactile = partials.tactile.col(k);
  rows.measured = partials.measured.col(k);
  outputs.pull_back(*trajectory.mechanism, horizon.parameters(), trajectory.inputs.p,
                    stage.motion(), trajectory.q.col(s), trajectory.qdot.col(s),
                    trajectory.inputs.u.col(step), rows, q_bar.col(s), qdot_bar.col(s),
                    out.u.col(step), out.p);
}

/// z = H_ss⁻ᵀ y, refined against the exact block through its transposed product.
void AdjointSweep::Workspace::solve_block(const Trajectory& trajectory, int s) {
  const double rate = point.rate;
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
}

void AdjointSweep::Workspace::sweep_stage(const Trajectory& trajectory, int s, Gradient& out) {
  const double rate = point.rate;
  y = q_bar.col(s) + rate * qdot_bar.col(s);
  solve_block(trajectory, s);
  z_bar.col(s - 1) = z;
  // L = Ψ − Σ zᵀ g: what is left of ∂L/∂a and ∂L/∂q̇ goes to the past.
  const JointForces<double>& forces = stage.joint_forces();
  const double c = stage.c();
  y_a = -stage.by_a();
  y_qdot = qdot_bar.col(s) - stage.by_qdot() + rate * y_a;
  y_start.q = c * z.cwiseProduct(forces.by_start_q);
  y_start.qdot = c * z.cwiseProduct(forces.by_start_qdot);
  history.scatter(trajectory, s, y_qdot, y_a, y_start, q_bar, qdot_bar);
  const int step = trajectory.timeline.stage(s).step;
  for_each_drive(horizon.model(), [&](int k, int control) {
    out.u(control, step) += c * z[k] * forces.by_u[control];
  });
  add_parameter_gradient<double>(*trajectory.mechanism, horizon.parameters(), trajectory.inputs.p,
                                 stage, point, z, -1.0, out.p);
}

AdjointSweep::AdjointSweep(const Horizon& horizon) : work_(std::make_unique<Workspace>(horizon)) {}
AdjointSweep::~AdjointSweep() = default;
AdjointSweep::AdjointSweep(AdjointSweep&&) noexcept = default;
AdjointSweep& AdjointSweep::operator=(AdjointSweep&&) noexcept = default;

const Eigen::MatrixXd& AdjointSweep::adjoint() const { return work_->z_bar; }
double AdjointSweep::worst_residual() const { return work_->worst_residual; }
int AdjointSweep::refactorized() const { return work_->refactorized; }

Gradient AdjointSweep::pull_back(const Trajectory& trajectory, const TrajectoryPartials& partials) {
  Workspace& w = *work_;
  const Model& model = w.horizon.model();
  const Timeline& timeline = trajectory.timeline;
  w.q_bar.setZero(model.dof(), timeline.stage_count());
  w.qdot_bar.setZero(model.dof(), timeline.stage_count());
  w.g.resize(model.dof());
  w.z_bar.resize(model.dof(), timeline.stage_count() - 1);
  w.worst_residual = 0.0;
  w.refactorized = 0;
  Gradient out{0.0, partials.p, partials.u, {}, {}};
  for (int k = 0; k <= timeline.step_count(); ++k) {
    w.q_bar.col(timeline.step_end(k)) += partials.q.col(k);
    w.qdot_bar.col(timeline.step_end(k)) += partials.qdot.col(k);
  }
  int k = timeline.step_count();
  for (int s = timeline.last_stage(); s > 0; --s) {
    w.history.set_point(trajectory, s, w.point);
    w.stage.linearize(*trajectory.mechanism, w.point, w.g);
    if (s == timeline.step_end(k)) {
      w.add_variables(trajectory, partials, k, out);
      --k;
    }
    w.sweep_stage(trajectory, s, out);
  }
  w.point.q = trajectory.q.col(0);
  w.point.qdot = trajectory.qdot.col(0);
  w.point.a.setZero();
  w.stage.linearize(*trajectory.mechanism, w.point, w.g);
  w.add_variables(trajectory, partials, 0, out);
  out.q0 = w.q_bar.col(0);
  out.qdot0 = w.qdot_bar.col(0);
  return out;
}

Gradient AdjointSweep::gradient(const Trajectory& trajectory, const Objective& objective) {
  const TrajectoryValues values = work_->reader.values(trajectory);
  Gradient out = pull_back(trajectory, objective.partials(values));
  out.value = objective.value(values);
  return out;
}

Gradient gradient(const Horizon& horizon, const Trajectory& trajectory,
                  const Objective& objective) {
  return AdjointSweep(horizon).gradient(trajectory, objective);
}

}  // namespace hbar
