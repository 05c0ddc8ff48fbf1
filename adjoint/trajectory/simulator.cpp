#include "hbar/adjoint/trajectory/simulator.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/core/base/chart.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/stop_flag.h"

namespace hbar {
namespace {

/// Largest angle by which a stage may turn a joint away from its prediction, rad.
constexpr double kLargestTurn = 1.5;

void require_complete(const RolloutReport& report) {
  if (report.status == RolloutStatus::kInterrupted) {
    throw Interrupted(report.message);
  }
  if (report.status != RolloutStatus::kConverged) {
    throw NumericalFailure(report.message);
  }
}

/// Whether a solution is so far from its prediction that it must be another root: with contact, a
/// stage may have roots in which bodies have passed through each other.
bool strays(const Model& model, const Eigen::VectorXd& predicted, const Eigen::VectorXd& found) {
  if (model.contacts().empty()) {
    return false;
  }
  for (int i = 0; i < model.tree().node_count(); ++i) {
    const Node& node = model.tree().node(i);
    const bool turns =
        node.motion == MotionKind::kRotation || node.motion == MotionKind::kExponential;
    for (int c = node.coordinates.begin; turns && c < node.coordinates.end; ++c) {
      if (!(std::abs(found[c] - predicted[c]) <= kLargestTurn)) {
        return true;
      }
    }
  }
  return false;
}

/// Records which exponential coordinates change chart after the last stage.
void switch_charts(const Model& model, Trajectory& trajectory) {
  const int stage = trajectory.timeline.last_stage();
  for (int i = 0; i < model.tree().node_count(); ++i) {
    const Node& node = model.tree().node(i);
    if (node.motion != MotionKind::kExponential) {
      continue;
    }
    const auto r = trajectory.q.col(stage).segment<3>(node.coordinates.begin);
    if (r.squaredNorm() > kChartLimit * kChartLimit) {
      trajectory.chart_switches.push_back({stage, i});
    }
  }
}

}  // namespace

const Trajectory& Rollout::trajectory() const& {
  require_complete(report_);
  return trajectory_;
}

Trajectory Rollout::trajectory() && {
  require_complete(report_);
  return std::move(trajectory_);
}

/// A stage as a system for Newton's method: unknown q, with q̇ and q̈ following.
class Simulator::StageSystem final : public solvers::NewtonSystem {
 public:
  explicit StageSystem(const Model& model)
      : point(model),
        qdot_past(model.dof()),
        a_past(model.dof()),
        lu(std::max(model.dof(), 1)),
        stage_(model),
        jacobian_(model.dof(), model.dof()) {}

  void residual(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    set(x);
    stage_.residual(*mechanism, point, g);
  }
  void factorize(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    set(x);
    stage_.linearize(*mechanism, point, g);
    stage_.newton_matrix(jacobian_);
    lu.compute(jacobian_);
  }
  void solve(const Eigen::VectorXd& g, Eigen::VectorXd& dx) override { dx = lu.solve(g); }

  /// Of the last evaluation.
  [[nodiscard]] const ContactForces<double>& contacts() const { return stage_.contacts(); }

  const Mechanism<double>* mechanism = nullptr;  // of the trajectory being computed
  StagePoint<double> point;
  Eigen::VectorXd qdot_past;
  Eigen::VectorXd a_past;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;

 private:
  void set(const Eigen::VectorXd& x) {
    point.q = x;
    History::set_rates(qdot_past, a_past, point);
  }

  StageResidual<double> stage_;
  Eigen::MatrixXd jacobian_;
};

struct Simulator::Workspace {
  explicit Workspace(const Horizon& horizon)
      : history(horizon.model()),
        system(horizon.model()),
        newton(horizon.model().dof()),
        x(horizon.model().dof()),
        predicted(horizon.model().dof()),
        last_a(horizon.model().dof()) {}

  History history;
  StageSystem system;
  solvers::Newton newton;
  Eigen::VectorXd x;
  Eigen::VectorXd predicted;  // x before Newton's method
  Eigen::VectorXd last_a;     // of the stage solved last
};

Simulator::Simulator(Horizon horizon)
    : horizon_(std::move(horizon)), work_("Simulator", std::make_unique<Workspace>(horizon_)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

Rollout Simulator::rollout(const Inputs& inputs) {
  horizon_.check(inputs);
  const Model& model = horizon_.model();
  const SimulationOptions& options = horizon_.options();
  const auto stages =
      static_cast<Eigen::Index>(horizon_.integrator().stages.size()) * options.steps +
      static_cast<Eigen::Index>((options.restarts.size() + 1) *
                                find_integrator(horizon_.integrator().starter).stages.size());
  Trajectory trajectory;
  trajectory.model = horizon_.shared_model();
  trajectory.parameters = horizon_.parameters();
  trajectory.integrator = horizon_.integrator().name;
  trajectory.inputs = inputs;
  trajectory.mechanism = horizon_.mechanism(inputs.p);
  work_->system.mechanism = trajectory.mechanism.get();
  trajectory.q.resize(model.dof(), stages + 1);
  trajectory.qdot.resize(model.dof(), stages + 1);
  trajectory.q.col(0) = inputs.q0;
  trajectory.qdot.col(0) = inputs.qdot0;
  trajectory.timeline.reserve(static_cast<int>(stages) + 1, options.steps);
  trajectory.newton.reserve(static_cast<std::size_t>(stages) + 1);
  trajectory.newton.resize(1);
  if (horizon_.keeps_factors()) {
    trajectory.factors.reserve(static_cast<std::size_t>(stages) + 1);
  }
  RolloutReport report;
  report.smallest_h = options.h;
  report.status = RolloutStatus::kConverged;
  switch_charts(model, trajectory);
  for (int step = 0; step < options.steps; ++step) {
    if (is_set(options.stop)) {
      report.status = RolloutStatus::kInterrupted;
      report.message =
          concat("simulation interrupted after ", step, " of ", options.steps, " steps");
      break;
    }
    if (std::find(options.restarts.begin(), options.restarts.end(), step) !=
        options.restarts.end()) {
      trajectory.timeline.restart();
    }
    if (!advance(trajectory, step, options.h, 0, report)) {
      trajectory.timeline.truncate(trajectory.timeline.step_end(step) + 1);
      report.status = RolloutStatus::kStepFailed;
      report.message = failure_message(trajectory, step, report);
      break;
    }
    trajectory.timeline.end_step();
    report.steps_done = step + 1;
  }
  const int count = trajectory.timeline.stage_count();
  report.time = trajectory.timeline.stage(count - 1).time;
  trajectory.q.conservativeResize(Eigen::NoChange, count);
  trajectory.qdot.conservativeResize(Eigen::NoChange, count);
  trajectory.newton.resize(static_cast<std::size_t>(count));
  std::erase_if(trajectory.chart_switches,
                [count](const ChartSwitch& s) { return s.stage >= count; });
  return {std::move(report), std::move(trajectory)};
}

bool Simulator::advance(Trajectory& trajectory, int step, double h, int depth,
                        RolloutReport& report) {
  const int kept = trajectory.timeline.stage_count();
  trajectory.timeline.append(horizon_.integrator(), step, h);
  const int count = trajectory.timeline.stage_count();
  if (count > trajectory.q.cols()) {
    const int columns = std::max(count, static_cast<int>(trajectory.q.cols() * 3 / 2));
    trajectory.q.conservativeResize(Eigen::NoChange, columns);
    trajectory.qdot.conservativeResize(Eigen::NoChange, columns);
  }
  trajectory.newton.resize(static_cast<std::size_t>(count));
  if (horizon_.keeps_factors()) {
    trajectory.factors.resize(static_cast<std::size_t>(count));
  }
  report.smallest_h = std::min(report.smallest_h, h);
  for (int stage = kept; stage < count; ++stage) {
    if (solve_stage(trajectory, stage, report)) {
      continue;
    }
    trajectory.timeline.truncate(kept);
    return depth < horizon_.options().max_halvings && 0.5 * h >= kSmallestStep &&
           advance(trajectory, step, 0.5 * h, depth + 1, report) &&
           advance(trajectory, step, 0.5 * h, depth + 1, report);
  }
  switch_charts(horizon_.model(), trajectory);
  return true;
}

bool Simulator::solve_stage(Trajectory& trajectory, int stage, RolloutReport& report) {
  const Stage& row = trajectory.timeline.stage(stage);
  StageSystem& system = work_->system;
  StagePoint<double>& point = system.point;
  work_->history.gather(trajectory, stage, system.qdot_past, system.a_past, point.start);
  point.rate = row.rate;
  point.u = trajectory.inputs.u.col(row.step);
  // Predictor: the acceleration of the last stage continues (zero at first).
  const bool has_last = stage > 1;
  work_->x = -system.a_past / row.rate - system.qdot_past;
  if (has_last) {
    work_->x += work_->last_a / row.rate;
  }
  work_->x /= row.rate;
  work_->predicted = work_->x;
  const solvers::NewtonReport newton =
      work_->newton.solve(system, horizon_.options().newton, work_->x);
  report.last_newton = newton;
  if (newton.converged() && strays(horizon_.model(), work_->predicted, work_->x)) {
    report.last_newton.status = solvers::NewtonStatus::kStrayed;
  }
  if (!report.last_newton.converged()) {
    return false;
  }
  point.q = work_->x;
  History::set_rates(system.qdot_past, system.a_past, point);
  work_->last_a = point.a;
  trajectory.q.col(stage) = point.q;
  trajectory.qdot.col(stage) = point.qdot;
  trajectory.newton[static_cast<std::size_t>(stage)] = newton;
  if (horizon_.keeps_factors()) {
    trajectory.factors[static_cast<std::size_t>(stage)] = system.lu;
  }
  return true;
}

/// ", deepest contact 'a-b': …" at the last iterate; empty where nothing touches.
std::string Simulator::deepest_contact() const {
  const ContactForces<double>& contacts = work_->system.contacts();
  int deepest = -1;
  for (int i = 0; i < horizon_.model().contact_count(); ++i) {
    if (contacts.summary(i).active > 0 &&
        (deepest < 0 || contacts.summary(i).penetration > contacts.summary(deepest).penetration)) {
      deepest = i;
    }
  }
  if (deepest < 0) {
    return {};
  }
  const ContactSummary& summary = contacts.summary(deepest);
  return concat(", deepest contact '", horizon_.model().contact(deepest).name, "' with ",
                summary.active, " points down to ", summary.penetration, ' ',
                length_unit(horizon_.model().units()));
}

std::string Simulator::failure_message(const Trajectory& trajectory, int step,
                                       const RolloutReport& report) const {
  const solvers::NewtonReport& newton = report.last_newton;
  return concat("simulation stopped at step ", step + 1, " of ", horizon_.options().steps,
                " (t = ", trajectory.timeline.stage(trajectory.timeline.last_stage()).time,
                "): ", solvers::describe(newton.status), " after ", newton.iterations,
                " iterations, |g| = ", newton.residual, " (tol ", horizon_.options().newton.tol,
                "), largest correction in coordinate '",
                horizon_.model().coordinate_name(newton.worst), "', smallest time step tried ",
                report.smallest_h, deepest_contact(),
                "; try a smaller time step, softer springs, limits, contacts or motor gains, or a "
                "larger Newton tolerance");
}

Rollout simulate(const Horizon& horizon, const Inputs& inputs) {
  return Simulator(horizon).rollout(inputs);
}

}  // namespace hbar
