#include "walker.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/terms/place.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::walker {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLimitMargin = 0.02;  // of joint limits between the steps, rad

/// Of an objective that is a cost of transport.
struct CostWeights {
  double power_smoothing = 0.0;  // ε of the smooth |P|, W
  double effort = 0.0;
  double control_smoothness = 0.0;
};
constexpr CostWeights kWide = {40.0, 0.3, 1e-3};
constexpr CostWeights kNarrow = {4.0, 0.02, 5e-5};

/// Sizes that the first guess is drawn with.
struct Leg {
  double thigh = 0.0;
  double shank = 0.0;
  double foot = 0.0;  // height of the foot's centre while it stands
};

double length_of(const Model& model, const std::string& joint) {
  return -model.link(model.find_joint(joint)).joint.X_PJ.p.y();
}

Leg leg_of(const Model& model) {
  const int foot = model.find_body("left_foot");
  const auto* ball = std::get_if<Sphere>(&model.link(foot).body.shape);
  if (ball == nullptr) {
    throw InvalidInput("walker: body 'left_foot' must be a sphere");
  }
  const double kn =
      model.contacts()[static_cast<std::size_t>(model.find_contact("left"))].coefficients.kn;
  return {length_of(model, "left_knee"), length_of(model, "left_foot"),
          ball->radius - nominal_weight(model) / kn};
}

/// Angles of hip and knee that put the foot's centre at (x, z) from the hip.
Eigen::Vector2d bend(const Leg& leg, double x, double z) {
  const double a = leg.thigh;
  const double b = leg.shank;
  const double cosine = (x * x + z * z - a * a - b * b) / (2.0 * a * b);
  if (!(std::abs(cosine) <= 1.0)) {
    throw InvalidInput("walker: the first guess's steps are too long for the legs");
  }
  const double knee = std::acos(cosine);
  const double ahead = std::atan2(b * std::sin(knee), a + b * std::cos(knee));
  return {std::atan2(x, -z) + ahead, -knee};
}

std::string power_name(const Model& model, int motor) {
  return model.control_name(model.first_control(motor)) + ".power";
}

SimulationOptions simulation_options(const Plan& plan, const Model& model) {
  SimulationOptions options;
  options.integrator = "bdf2";
  options.h = plan.duration / plan.steps;
  options.steps = plan.steps;
  for (std::size_t i = 0; i < model.motors().size(); ++i) {
    const auto motor = static_cast<int>(i);
    options.measurements.emplace_back(MotorPower{power_name(model, motor), motor});
  }
  for (const char* side : {"left", "right"}) {
    options.measurements.emplace_back(
        ContactForce{std::string(side) + ".force", model.find_contact(side)});
  }
  return options;
}

Objective objective_of(const Plan& plan, Aim aim, const Horizon& horizon,
                       const Eigen::MatrixXd& guess) {
  if (aim == Aim::kFollowGuess) {
    Objective objective(tracking(guess.rightCols(plan.steps)));
    return objective.add(effort(0.1)).add(control_smoothness(1e-3));
  }
  std::vector<int> powers;
  for (int motor = 0; motor < static_cast<int>(horizon.model().motors().size()); ++motor) {
    powers.push_back(horizon.measured_index(power_name(horizon.model(), motor)));
  }
  const double scale = 1.0 / (nominal_weight(horizon.model()) * plan.advance());
  const CostWeights& weights = aim == Aim::kSmoothedCost ? kWide : kNarrow;
  Objective objective(work(powers, weights.power_smoothing, scale));
  return objective.add(effort(weights.effort)).add(control_smoothness(weights.control_smoothness));
}

/// Which foot touches when: the left one always; the right one until it takes off, and again at
/// the end by periodicity. In between it is above its clearance, which rises and falls as a sine.
/// With contacts that neither begin nor end elsewhere, no iterate meets the corner of their law.
std::vector<ConstraintPointer> contact_schedule(const Plan& plan, const Model& model) {
  const int left = place::end_effector(model, "left_foot", kZ, 0).index;
  const int right = place::end_effector(model, "right_foot", kZ, 0).index;
  const double radius =
      std::get<Sphere>(model.link(model.find_body("left_foot")).body.shape).radius;
  const int off = plan.take_off();
  std::vector<ConstraintPointer> rows;
  rows.push_back(value_limits("height of the left foot", ValueField::kMeasured, left,
                              step_range(0, plan.steps), -kInfinity, radius));
  rows.push_back(value_limits("height of the right foot", ValueField::kMeasured, right,
                              step_range(0, off), -kInfinity, radius));
  for (int k = off + 1; k < plan.steps; ++k) {
    const double share = static_cast<double>(k - off) / (plan.steps - off);
    rows.push_back(value_limits("height of the right foot", ValueField::kMeasured, right, {k},
                                radius + plan.clearance * std::sin(std::numbers::pi * share),
                                kInfinity));
  }
  return rows;
}

InitialStateBounds initial_bounds(const Model& model) {
  const Eigen::Index n = model.dof();
  InitialStateBounds bounds{Eigen::VectorXd::Constant(n, -1.5), Eigen::VectorXd::Constant(n, 1.5),
                            Eigen::VectorXd::Constant(n, -10.0),
                            Eigen::VectorXd::Constant(n, 10.0)};
  bounds.q_lower[0] = bounds.q_upper[0] = 0.0;
  return bounds;
}

}  // namespace

double nominal_weight(const Model& model) {
  double mass = 0.0;
  for (int i = 0; i < model.link_count(); ++i) {
    mass += model.link(i).body.mass;
  }
  return mass * model.gravity().norm();
}

std::vector<example::FreeLength> leg_lengths() {
  return {{"length of thigh", {{"left_thigh", "left_knee"}, {"right_thigh", "right_knee"}}, 0.04},
          {"length of shank", {{"left_shank", "left_foot"}, {"right_shank", "right_foot"}}, 0.04}};
}

std::vector<int> mirror(const Model& model) {
  std::vector<int> out;
  for (int i = 0; i < model.dof(); ++i) {
    std::string name = model.coordinate_name(i);
    if (name.starts_with("left_")) {
      name.replace(0, 5, "right_");
    } else if (name.starts_with("right_")) {
      name.replace(0, 6, "left_");
    }
    int found = -1;
    for (int j = 0; j < model.dof(); ++j) {
      found = model.coordinate_name(j) == name ? j : found;
    }
    if (found < 0) {
      throw InvalidInput(concat("walker: the scene has no coordinate '", name, "', of which '",
                                model.coordinate_name(i), "' would be the mirror image"));
    }
    out.push_back(found);
  }
  return out;
}

ConstraintPointer mirrored_periodicity(const Model& model, int steps, double advance) {
  const std::vector<int> other = mirror(model);
  ConstraintRows rows;
  std::vector<PartialPlace> places;
  std::vector<double> weights;
  for (const ValueField field : {ValueField::kQ, ValueField::kQdot}) {
    for (int i = 0; i < model.dof(); ++i) {
      const auto row = static_cast<int>(rows.names.size());
      rows.names.push_back(concat(model.coordinate_name(i),
                                  field == ValueField::kQ ? " mirrored" : " rate mirrored"));
      places.push_back({row, field, steps, other[static_cast<std::size_t>(i)]});
      places.push_back({row, field, 0, i});
      weights.insert(weights.end(), {1.0, -1.0});
    }
  }
  rows.lower.setZero(2 * model.dof());
  rows.lower[0] = advance;
  rows.upper = rows.lower;
  return linear_constraint(
      rows, places,
      Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size())));
}

Eigen::MatrixXd first_guess(const Plan& plan, const Model& model) {
  constexpr double kLift = 0.07;     // of the swinging foot, m
  constexpr double kStretch = 0.98;  // longest leg over thigh and shank
  Leg leg = leg_of(model);
  if (!plan.begin.empty()) {
    leg.thigh = plan.begin.at(0);
    leg.shank = plan.begin.at(1);
  }
  const double half = 0.5 * plan.advance();
  const double reach = kStretch * (leg.thigh + leg.shank);
  const double hip = std::sqrt(reach * reach - half * half);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(model.dof(), plan.steps + 1);
  for (int k = 0; k <= plan.steps; ++k) {
    const double share = static_cast<double>(k) / plan.steps;
    const double swing = (1.0 - std::cos(std::numbers::pi * share)) * 2.0 - 1.0;
    const double lift = kLift * std::pow(std::sin(std::numbers::pi * share), 2);
    const double x = plan.advance() * share;
    q(0, k) = x;
    q(1, k) = hip + leg.foot;
    q.col(k).segment<2>(3) = bend(leg, half - x, -hip);
    q.col(k).segment<2>(5) = bend(leg, swing * half - x, lift - hip);
  }
  return q;
}

TrajectoryProblem walker_problem(const Plan& plan, Aim aim) {
  const scene::Scene scene = scene::read_scene(plan.scene);
  const Model model = scene::build_model(scene);
  if (model.dof() != 7 || model.control_count() != 4 || mirror(model)[3] != 5) {
    throw InvalidInput(
        "walker: the scene must have a trunk with three coordinates, then the left "
        "hip and knee, then the right ones, and motors at these four");
  }
  const Eigen::MatrixXd guess = first_guess(plan, model);
  const ParameterSet set =
      ParameterSet::named(model, example::stretched_parameters(model, leg_lengths()));
  const Eigen::VectorXd begin = Eigen::Map<const Eigen::VectorXd>(
      plan.begin.data(), static_cast<Eigen::Index>(plan.begin.size()));
  Horizon horizon(model, set, simulation_options(plan, model));

  std::vector<ConstraintPointer> constraints = contact_schedule(plan, model);
  constraints.push_back(mirrored_periodicity(model, plan.steps, plan.advance()));
  constraints.push_back(joint_limits(model, step_range(0, plan.steps), kLimitMargin));

  HeldControls controls;
  controls.hold = plan.hold();
  controls.lower = Eigen::VectorXd::Constant(4, -1.0);
  controls.upper = Eigen::VectorXd::Constant(4, 1.0);
  Objective objective = objective_of(plan, aim, horizon, guess);
  const Eigen::VectorXd qdot0 = (guess.col(1) - guess.col(0)) / horizon.options().h;
  return TrajectoryProblem{.horizon = std::move(horizon),
                           .map = example::stretch_map(model, set, set.nominal(), leg_lengths(),
                                                       plan.length_share, begin),
                           .objective = std::move(objective),
                           .constraints = std::move(constraints),
                           .controls = std::move(controls),
                           .q0 = guess.col(0),
                           .qdot0 = qdot0,
                           .initial = initial_bounds(model)};
}

solvers::IpoptOptions ipopt_options(Aim aim, const solvers::IpoptResult* earlier) {
  solvers::IpoptOptions options;
  options.hessian = solvers::HessianKind::kExact;
  options.tolerance = aim == Aim::kCostOfTransport ? 1e-7 : 1e-5;
  options.constraint_tolerance = 1e-7;
  options.acceptable_tolerance = 1e-5;
  if (earlier == nullptr) {
    options.string_options["mu_strategy"] = "adaptive";
    return options;
  }
  // The aim has changed: begin at the earlier point, but with a barrier again.
  options.warm_start = earlier->point();
  options.number_options["mu_init"] = 1e-3;
  options.number_options["warm_start_bound_push"] = 1e-3;
  options.number_options["warm_start_mult_bound_push"] = 1e-3;
  return options;
}

}  // namespace hbar::walker
