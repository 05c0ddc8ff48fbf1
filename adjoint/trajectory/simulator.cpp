#include "hbar/adjoint/trajectory/simulator.h"

#include <algorithm>
#include <utility>

#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/chart.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"

namespace hbar {
namespace {

/// No stage turns a joint farther than this from where its last acceleration would take it, rad.
constexpr double kLargestTurn = 1.5;

}  // namespace

const Trajectory& Rollout::trajectory() const& {
  if (!converged()) {
    throw NumericalFailure(report_.message);
  }
  return trajectory_;
}

Trajectory Rollout::trajectory() && {
  if (!converged()) {
    throw NumericalFailure(report_.message);
  }
  return std::move(trajectory_);
}

/// A stage as Newton's method sees it: unknown q, with q̇ and q̈ following.
class Simulator::StageSystem final : public solvers::NewtonSystem {
 public:
  StageSystem(const Model& model, const Mechanism<double>& mechanism)
      : mechanism_(mechanism),
        stage_(model),
        point(model),
        qdot_past(model.dof()),
        a_past(model.dof()),
        jacobian_(model.dof(), model.dof()),
        lu(std::max(model.dof(), 1)) {}

  void residual(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    set(x);
    stage_.residual(mechanism_, point, g);
  }
  void factorize(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    set(x);
    stage_.linearize(mechanism_, point, g);
    stage_.newton_matrix(jacobian_);
    lu.compute(jacobian_);
  }
  void solve(const Eigen::VectorXd& g, Eigen::VectorXd& dx) override { dx = lu.solve(g); }

  /// Of the last evaluation.
  [[nodiscard]] const ContactForces<double>& contacts() const { return stage_.contacts(); }

 private:
  void set(const Eigen::VectorXd& x) {
    point.q = x;
    History::set_rates(qdot_past, a_past, point);
  }

  const Mechanism<double>& mechanism_;
  StageResidual<double> stage_;

 public:
  StagePoint<double> point;
  Eigen::VectorXd qdot_past;
  Eigen::VectorXd a_past;

 private:
  Eigen::MatrixXd jacobian_;

 public:
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
};

struct Simulator::Workspace {
  Workspace(const Model& model, const SimulationOptions& options)
      : mechanism(nominal_mechanism<double>(model)),
        history(model),
        system(model, mechanism),
        newton(model.dof()),
        x(model.dof()),
        predicted(model.dof()),
        last_a(model.dof()),
        reader(model, options.measurements) {}

  Mechanism<double> mechanism;
  History history;
  StageSystem system;
  solvers::Newton newton;
  Eigen::VectorXd x;
  Eigen::VectorXd predicted;  // x before Newton's method
  Eigen::VectorXd last_a;     // of the stage that was solved last
  ValueReader reader;
};

Simulator::Simulator(Model model, ParameterSet parameters, SimulationOptions options)
    : Simulator(std::make_shared<const Model>(std::move(model)), std::move(parameters),
                std::move(options)) {}

Simulator::Simulator(std::shared_ptr<const Model> model, ParameterSet parameters,
                     SimulationOptions options)
    : model_(std::move(model)),
      parameters_(std::move(parameters)),
      options_(std::move(options)),
      integrator_(&find_integrator(options_.integrator)) {
  check_options();
  const double stages = 2.0 * options_.steps;
  keep_factors_ = options_.keep_factors && stages * bytes_per_stage(true) <= options_.max_memory;
  work_ = std::make_unique<Workspace>(*model_, options_);
}

Simulator::~Simulator() = default;
Simulator::Simulator(const Simulator& other)
    : Simulator(other.model_, other.parameters_, other.options_) {}
Simulator& Simulator::operator=(const Simulator& other) { return *this = Simulator(other); }
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

double Simulator::bytes_per_stage(bool with_factors) const {
  const double n = model_->dof();
  return 8.0 * (4.0 * n + model_->control_count() + 16.0 + (with_factors ? n * n + n : 0.0));
}

void Simulator::check_options() const {
  if (!(options_.h > 0.0) || !std::isfinite(options_.h)) {
    throw InvalidInput(concat("time step h is ", options_.h, "; it must be positive"));
  }
  if (options_.steps < 1) {
    throw InvalidInput(concat("steps is ", options_.steps, "; it must be at least 1"));
  }
  for (const int step : options_.restarts) {
    if (step < 0 || step >= options_.steps) {
      throw InvalidInput(
          concat("restart at step ", step, "; there are steps 0 to ", options_.steps - 1));
    }
  }
  const double bytes = options_.steps * bytes_per_stage(false);
  if (bytes > options_.max_memory) {
    throw InvalidInput(concat(options_.steps, " steps of ", model_->dof(),
                              " coordinates take about ", bytes * 1e-9, " GB; the limit is ",
                              options_.max_memory * 1e-9,
                              " GB: take fewer steps or raise max_memory"));
  }
  if (model_->dof() == 0) {
    throw InvalidInput("the model has no coordinate: every joint is fixed");
  }
}

Inputs Simulator::nominal_inputs() const {
  return {parameters_.nominal(), Eigen::MatrixXd::Zero(model_->control_count(), options_.steps),
          Eigen::VectorXd::Zero(model_->dof()), Eigen::VectorXd::Zero(model_->dof())};
}

void Simulator::check_inputs(const Inputs& inputs) const {
  const auto check = [](const Eigen::MatrixXd& value, std::string_view name, Eigen::Index rows,
                        Eigen::Index columns) {
    if (value.rows() != rows || value.cols() != columns) {
      throw InvalidInput(concat(name, " is ", value.rows(), " x ", value.cols(), "; it must be ",
                                rows, " x ", columns));
    }
    for (Eigen::Index j = 0; j < columns; ++j) {
      for (Eigen::Index i = 0; i < rows; ++i) {
        if (!std::isfinite(value(i, j))) {
          throw InvalidInput(
              concat(name, "(", i, ", ", j, ") is ", value(i, j), "; it must be finite"));
        }
      }
    }
  };
  check(inputs.p, "p", parameters_.size(), 1);
  check(inputs.u, "u", model_->control_count(), options_.steps);
  check(inputs.q0, "q0", model_->dof(), 1);
  check(inputs.qdot0, "qdot0", model_->dof(), 1);
}

bool Simulator::solve_stage(Trajectory& trajectory, int stage, RolloutReport& report) {
  const Stage& row = trajectory.timeline.stage(stage);
  StageSystem& system = work_->system;
  StagePoint<double>& point = system.point;
  work_->history.gather(trajectory, stage, system.qdot_past, system.a_past, point.start);
  point.rate = row.rate;
  point.u = trajectory.inputs.u.col(row.step);
  // Predictor: the acceleration of the last stage goes on (zero before there is one).
  const bool has_last = stage > 1;
  work_->x = -system.a_past / row.rate - system.qdot_past;
  if (has_last) {
    work_->x += work_->last_a / row.rate;
  }
  work_->x /= row.rate;
  work_->predicted = work_->x;
  const solvers::NewtonReport newton = work_->newton.solve(system, options_.newton, work_->x);
  report.last_newton = newton;
  if (newton.converged() && strays(work_->predicted, work_->x)) {
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
  if (keep_factors_) {
    trajectory.factors[static_cast<std::size_t>(stage)] = system.lu;
  }
  return true;
}

/// Whether a solution is so far from its prediction that it must be another root: with contact, a
/// stage may have some in which bodies have gone through each other.
bool Simulator::strays(const Eigen::VectorXd& predicted, const Eigen::VectorXd& found) const {
  if (model_->contacts().empty()) {
    return false;
  }
  for (int i = 0; i < model_->tree().node_count(); ++i) {
    const Node& node = model_->tree().node(i);
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

void Simulator::switch_charts(Trajectory& trajectory) const {
  const int stage = trajectory.timeline.last_stage();
  for (int i = 0; i < model_->tree().node_count(); ++i) {
    const Node& node = model_->tree().node(i);
    if (node.motion != MotionKind::kExponential) {
      continue;
    }
    const auto r = trajectory.q.col(stage).segment<3>(node.coordinates.begin);
    if (r.squaredNorm() > kChartLimit * kChartLimit) {
      trajectory.chart_switches.push_back({stage, i});
    }
  }
}

bool Simulator::advance(Trajectory& trajectory, int step, double h, int depth,
                        RolloutReport& report) {
  const int kept = trajectory.timeline.stage_count();
  trajectory.timeline.append(*integrator_, step, h);
  const int count = trajectory.timeline.stage_count();
  if (count > trajectory.q.cols()) {
    const int columns = std::max(count, static_cast<int>(trajectory.q.cols() * 3 / 2));
    trajectory.q.conservativeResize(Eigen::NoChange, columns);
    trajectory.qdot.conservativeResize(Eigen::NoChange, columns);
  }
  trajectory.newton.resize(static_cast<std::size_t>(count));
  if (keep_factors_) {
    trajectory.factors.resize(static_cast<std::size_t>(count));
  }
  report.smallest_h = std::min(report.smallest_h, h);
  for (int stage = kept; stage < count; ++stage) {
    if (solve_stage(trajectory, stage, report)) {
      continue;
    }
    trajectory.timeline.truncate(kept);
    return depth < options_.max_halvings && advance(trajectory, step, 0.5 * h, depth + 1, report) &&
           advance(trajectory, step, 0.5 * h, depth + 1, report);
  }
  switch_charts(trajectory);
  return true;
}

/// ", deepest contact 'a-b': …" at the last iterate; empty where nothing touches.
std::string Simulator::deepest_contact() const {
  const ContactForces<double>& contacts = work_->system.contacts();
  int deepest = -1;
  for (int i = 0; i < model_->contact_count(); ++i) {
    if (contacts.summary(i).active > 0 &&
        (deepest < 0 || contacts.summary(i).penetration > contacts.summary(deepest).penetration)) {
      deepest = i;
    }
  }
  if (deepest < 0) {
    return {};
  }
  const ContactSummary& summary = contacts.summary(deepest);
  return concat(", deepest contact '", model_->contact(deepest).name, "' with ", summary.active,
                " points down to ", summary.penetration, ' ', length_unit(model_->units()));
}

std::string Simulator::failure_message(const Trajectory& trajectory, int step,
                                       const RolloutReport& report) const {
  const solvers::NewtonReport& newton = report.last_newton;
  return concat("simulation stopped at step ", step + 1, " of ", options_.steps,
                " (t = ", trajectory.timeline.stage(trajectory.timeline.last_stage()).time,
                "): ", solvers::describe(newton.status), " after ", newton.iterations,
                " iterations, |g| = ", newton.residual, " (tol ", options_.newton.tol,
                "), largest correction in coordinate '", model_->coordinate_name(newton.worst),
                "', smallest time step tried ", report.smallest_h, deepest_contact(),
                "; try a smaller time step, softer springs, limits, contacts or motor gains, or a "
                "larger Newton tolerance");
}

Rollout Simulator::rollout(const Inputs& inputs) {
  check_inputs(inputs);
  apply_parameters<double>(*model_, parameters_, inputs.p, work_->mechanism);
  const auto stages =
      static_cast<Eigen::Index>(integrator_->stages.size()) * options_.steps +
      static_cast<Eigen::Index>((options_.restarts.size() + 1) *
                                find_integrator(integrator_->starter).stages.size());
  Trajectory trajectory;
  trajectory.inputs = inputs;
  trajectory.q.resize(model_->dof(), stages + 1);
  trajectory.qdot.resize(model_->dof(), stages + 1);
  trajectory.q.col(0) = inputs.q0;
  trajectory.qdot.col(0) = inputs.qdot0;
  trajectory.newton.resize(1);
  RolloutReport report;
  report.smallest_h = options_.h;
  report.status = RolloutStatus::kConverged;
  switch_charts(trajectory);
  for (int step = 0; step < options_.steps; ++step) {
    if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
      report.status = RolloutStatus::kInterrupted;
      report.message =
          concat("simulation interrupted after ", step, " of ", options_.steps, " steps");
      break;
    }
    if (std::find(options_.restarts.begin(), options_.restarts.end(), step) !=
        options_.restarts.end()) {
      trajectory.timeline.restart();
    }
    if (!advance(trajectory, step, options_.h, 0, report)) {
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

void Simulator::set_point(const Trajectory& trajectory, int stage, StagePoint<double>& point) {
  const Stage& row = trajectory.timeline.stage(stage);
  StageSystem& system = work_->system;
  work_->history.gather(trajectory, stage, system.qdot_past, system.a_past, point.start);
  point.rate = row.rate;
  point.u = trajectory.inputs.u.col(row.step);
  point.q = trajectory.q.col(stage);
  History::set_rates(system.qdot_past, system.a_past, point);
}

TrajectoryValues Simulator::values(const Trajectory& trajectory) {
  return work_->reader.values(parameters_, trajectory, options_.h);
}

std::vector<std::vector<ContactSummary>> Simulator::contact_history(const Trajectory& trajectory) {
  return work_->reader.contact_history(parameters_, trajectory);
}

const std::vector<std::string>& Simulator::measured_names() const {
  return work_->reader.measured_names();
}

int Simulator::measured_index(std::string_view name) const {
  const std::vector<std::string>& names = measured_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InvalidInput(
        concat("there is no measured row '", name, "'; ", unknown_name_hint(name, names)));
  }
  return static_cast<int>(found - names.begin());
}

}  // namespace hbar
