#include "tests/benchmarks/grasp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/history.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/model_builder.h"
#include "tests/benchmarks/workloads.h"

namespace hbar::benchmarks {
namespace {

constexpr int kFingers = 5;
constexpr double kThickness = 0.008;  // radius of a phalanx, m
constexpr double kCube = 0.06;        // side, m
constexpr double kCubeHeight = 0.115;
constexpr double kPalmHeight = 0.22;

RigidTransform<double> at(double x, double y, double z) {
  return {Eigen::Matrix3d::Identity(), {x, y, z}};
}

Body phalanx(const std::string& name, double length) {
  Body body = solid_body(name, Capsule{kThickness, length}, 1200.0, at(0.0, 0.0, -0.5 * length));
  SurfaceResolution resolution;
  resolution.capsule = {13, 10};
  body.contact_points = surface_points(body.shape, resolution);
  return body;
}

void add_motor(ModelBuilder& builder, int link, double P, double D) {
  builder.add_motor(
      {.link = link, .kind = Motor::Kind::kPosition, .P = P, .D = D, .implicit = true});
}

/// Adds a finger that hangs from the palm; returns its phalanges.
std::vector<int> add_finger(ModelBuilder& builder, int palm, int finger) {
  const double angle = 2.0 * std::numbers::pi * finger / kFingers + 0.3;
  const Eigen::Vector3d radial(std::cos(angle), std::sin(angle), 0.0);
  const Eigen::Vector3d tangent(-std::sin(angle), std::cos(angle), 0.0);
  const std::string name = concat("finger", finger);
  const auto hinge = [&](const char* part, const Eigen::Vector3d& axis, double drop) {
    Joint joint{.name = name + part, .kind = RevoluteJoint{axis}};
    joint.X_PJ = at(0.0, 0.0, -drop);
    joint.damping = 1e-3;
    return joint;
  };
  Joint spread = hinge("_spread", radial, 0.02);
  spread.X_PJ.p += 0.056 * radial;
  const int knuckle =
      builder.add_link(palm, spread, solid_body(name + "_knuckle", Sphere{kThickness}, 1200.0));
  add_motor(builder, knuckle, 1.0, 0.02);
  std::vector<int> phalanges;
  int parent = knuckle;
  double drop = 0.0;
  for (const auto& [part, length] :
       {std::pair{"_proximal", 0.045}, std::pair{"_middle", 0.035}, std::pair{"_distal", 0.025}}) {
    parent = builder.add_link(parent, hinge(concat(part, "_hinge").c_str(), tangent, drop),
                              phalanx(name + part, length));
    add_motor(builder, parent, 1.0, 0.01);
    phalanges.push_back(parent);
    drop = length;
  }
  builder.add_end_effector({.name = name + "_tip", .link = parent, .position = {0, 0, -drop}});
  return phalanges;
}

}  // namespace

Model grasp_model(bool contacts) {
  ModelBuilder builder("grasp");
  builder.set_gravity({0.0, 0.0, -9.81});
  Joint wrist{.name = "wrist", .kind = SphericalEulerJoint{}, .X_PJ = at(0.0, 0.0, kPalmHeight)};
  const int palm =
      builder.add_link(-1, wrist, solid_body("palm", Cylinder{0.06, 0.02}, 800.0), "palm");
  add_motor(builder, palm, 20.0, 0.5);
  std::vector<int> phalanges;
  for (int finger = 0; finger < kFingers; ++finger) {
    for (const int link : add_finger(builder, palm, finger)) {
      phalanges.push_back(link);
    }
  }
  Joint free{.name = "cube", .kind = Free3dExpJoint{}, .X_PJ = at(0.0, 0.0, kCubeHeight)};
  const int cube = builder.add_link(
      -1, free, solid_body("cube", Cuboid{Eigen::Vector3d::Constant(kCube)}, 400.0), "cube");
  builder.add_end_effector({.name = "cube", .link = cube, .position = Eigen::Vector3d::Zero()});
  if (contacts) {
    for (const int link : phalanges) {
      Contact contact{.link = link, .other = cube};
      contact.coefficients = {.kn = 2000.0, .kt = 20.0, .mu = 0.8, .damping = 2000.0};
      builder.add_contact(contact);
    }
  }
  return builder.build();
}

struct GraspWork::Workspace {
  explicit Workspace(const std::string& integrator)
      : horizon(grasp_model(), parameters(grasp_model()), options(integrator, true)),
        simulator(horizon),
        bare(horizon.with(options(integrator, false))),
        model_without(grasp_model(false)),
        inputs(horizon.nominal_inputs()),
        adjoint(horizon),
        objective(squared_variables()),
        mechanism(nominal_mechanism<double>(horizon.model())),
        mechanism_without(nominal_mechanism<double>(model_without)),
        stage(horizon.model()),
        stage_without(model_without),
        g(horizon.model().dof()),
        matrix(g.size(), g.size()) {
    const Model& model = horizon.model();
    // The fingers close within the first tenth of a second and hold on.
    for (int k = 0; k < kSteps; ++k) {
      const double closed = std::min(1.0, k * kStep / 0.1);
      for (int i = 0; i < model.control_count(); ++i) {
        const bool spread = i < 3 || (i - 3) % 4 == 0;
        inputs.u(i, k) = spread ? 0.0 : 0.45 * closed;
      }
    }
    inputs.u.topRows(3).setZero();
  }

  static SimulationOptions options(const std::string& integrator, bool keep_factors) {
    SimulationOptions out;
    out.integrator = integrator;
    out.h = kStep;
    out.steps = kSteps;
    out.keep_factors = keep_factors;
    return out;
  }

  /// All but the contact points, whose number would hide everything else.
  static ParameterSet parameters(const Model& model) {
    std::vector<std::string> names;
    const ParameterSet all = ParameterSet::all(model);
    for (const Parameter& parameter : all.parameters()) {
      if (parameter.kind != ParameterKind::kContactPoint) {
        names.push_back(parameter.name);
      }
    }
    return ParameterSet::named(model, names);
  }

  const StagePoint<double>& next() {
    at = at % static_cast<std::size_t>(points.size()) + 1;
    return points[at - 1];
  }

  Horizon horizon;
  Simulator simulator;
  Simulator bare;  // keeps nothing
  Model model_without;
  Inputs inputs;
  AdjointSweep adjoint;
  Objective objective;
  Mechanism<double> mechanism;
  Mechanism<double> mechanism_without;
  StageResidual<double> stage;
  StageResidual<double> stage_without;
  Trajectory trajectory;
  std::vector<StagePoint<double>> points;
  std::size_t at = 0;
  Eigen::VectorXd g;
  Eigen::MatrixXd matrix;
};

GraspWork::GraspWork(const std::string& integrator)
    : work_(std::make_shared<Workspace>(integrator)) {
  forward();
  Workspace& w = *work_;
  History history(w.horizon.model());
  for (int s = 1; s < w.trajectory.timeline.stage_count(); ++s) {
    w.points.emplace_back(w.horizon.model());
    history.set_point(w.trajectory, s, w.points.back());
  }
}

void GraspWork::forward() {
  work_->trajectory = work_->simulator.rollout(work_->inputs).trajectory();
}

void GraspWork::forward_alone() {
  const Rollout rollout = work_->bare.rollout(work_->inputs);
  if (!rollout.converged()) {
    throw NumericalFailure(rollout.report().message);
  }
}

void GraspWork::sweep() {
  const Gradient gradient = work_->adjoint.gradient(work_->trajectory, work_->objective);
  if (!gradient.q0.allFinite()) {
    throw NumericalFailure("gradient not finite");
  }
}

void GraspWork::forward_and_sweep() {
  forward();
  sweep();
}

void GraspWork::newton_matrix() {
  work_->stage.linearize(work_->mechanism, work_->next(), work_->g);
  work_->stage.newton_matrix(work_->matrix);
}
void GraspWork::newton_matrix_without() {
  work_->stage_without.linearize(work_->mechanism_without, work_->next(), work_->g);
  work_->stage_without.newton_matrix(work_->matrix);
}
void GraspWork::residual() { work_->stage.residual(work_->mechanism, work_->next(), work_->g); }
void GraspWork::residual_without() {
  work_->stage_without.residual(work_->mechanism_without, work_->next(), work_->g);
}
void GraspWork::pull_back() {
  const StagePoint<double>& point = work_->next();
  work_->stage.linearize(work_->mechanism, point, work_->g);
  work_->stage.pull_back(point.q);
}
void GraspWork::pull_back_without() {
  const StagePoint<double>& point = work_->next();
  work_->stage_without.linearize(work_->mechanism_without, point, work_->g);
  work_->stage_without.pull_back(point.q);
}

int GraspWork::steps() const { return kSteps; }
int GraspWork::stages() const { return work_->trajectory.timeline.stage_count() - 1; }
int GraspWork::parameter_count() const { return work_->horizon.parameters().size(); }

int GraspWork::newton_iterations() const {
  return benchmarks::newton_iterations(work_->trajectory);
}

int GraspWork::factorizations() const { return benchmarks::factorizations(work_->trajectory); }

int GraspWork::declared_points() const {
  Eigen::Index count = 0;
  const Model& model = work_->horizon.model();
  for (const Contact& contact : model.contacts()) {
    count += model.link(contact.link).body.contact_points.cols();
  }
  return static_cast<int>(count);
}

namespace {

std::vector<int> active_points(const Horizon& horizon, const Trajectory& trajectory) {
  std::vector<int> counts;
  for (const std::vector<ContactSummary>& step : contact_history(horizon, trajectory)) {
    int count = 0;
    for (const ContactSummary& summary : step) {
      count += summary.active;
    }
    counts.push_back(count);
  }
  return counts;
}

}  // namespace

double GraspWork::mean_active_points() const {
  const std::vector<int> counts = active_points(work_->horizon, work_->trajectory);
  double sum = 0.0;
  for (const int count : counts) {
    sum += count;
  }
  return sum / static_cast<double>(counts.size());
}

int GraspWork::most_active_points() const {
  const std::vector<int> counts = active_points(work_->horizon, work_->trajectory);
  return *std::max_element(counts.begin(), counts.end());
}

double GraspWork::slip() const {
  const int z = work_->horizon.model().dof() - 4;
  double lowest = 0.0;
  for (int k = 0; k <= work_->trajectory.step_count(); ++k) {
    lowest = std::min(lowest, work_->trajectory.q_at_step(k)[z]);
  }
  return -lowest;
}

}  // namespace hbar::benchmarks
