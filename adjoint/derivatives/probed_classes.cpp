#include "hbar/adjoint/derivatives/probed_classes.h"

#include <algorithm>
#include <cmath>

#include "hbar/core/parameters/parameter_kinds.h"

namespace hbar {
namespace {

/// The problem's own units: what is 1 for a metre-sized robot that moves for a second.
struct TypicalSizes {
  double length = 1.0;
  double time = 1.0;
  double acceleration = 1.0;
  double mass = 1.0;

  [[nodiscard]] double force() const { return mass * acceleration; }
};

double or_one(double size) { return size > 0.0 && std::isfinite(size) ? size : 1.0; }

TypicalSizes typical_sizes(const Problem& problem) {
  const Model& model = problem.horizon.model();
  double length = 0.0;
  double mass = 0.0;
  for (const Link& link : model.links()) {
    length = std::max({length, link.joint.X_PJ.p.norm(), link.body.X_JB.p.norm()});
    for (const double size : sizes_of(link.body.shape)) {
      length = std::max(length, size);
    }
    if (link.body.contact_points.cols() > 0) {
      length = std::max(length, link.body.contact_points.cwiseAbs().maxCoeff());
    }
    mass += link.body.mass;
  }
  TypicalSizes out;
  out.length = or_one(length);
  out.time = problem.horizon.options().h * problem.horizon.steps();
  out.acceleration = or_one(std::max(model.gravity().norm(), out.length / (out.time * out.time)));
  out.mass = or_one(mass);
  return out;
}

bool is_translation(const Model& model, int coordinate) {
  const Tree& tree = model.tree();
  return tree.node(tree.node_of(coordinate)).motion == MotionKind::kTranslation;
}

/// 1 rad, or the typical length.
double coordinate_size(const Model& model, int coordinate, const TypicalSizes& typical) {
  return is_translation(model, coordinate) ? typical.length : 1.0;
}

/// Force or torque of a coordinate.
double effort_size(const Model& model, int coordinate, const TypicalSizes& typical) {
  return typical.force() * (is_translation(model, coordinate) ? 1.0 : typical.length);
}

/// Of a parameter whose nominal value is 0.
double size_of_zero(const Model& model, const Parameter& parameter, const TypicalSizes& typical) {
  const auto per_coordinate = [&](int link) {
    const CoordinateRange range = model.coordinates_of_link(link);
    return range.begin == range.end ? 1.0
                                    : effort_size(model, range.begin, typical) /
                                          coordinate_size(model, range.begin, typical);
  };
  const double stiffness = typical.force() / typical.length;
  switch (parameter.kind) {
    case ParameterKind::kJointTransform:
    case ParameterKind::kBodyTransform:
      return parameter.component < 3 ? 1.0 : typical.length;
    case ParameterKind::kGravity:
      return typical.acceleration;
    case ParameterKind::kStiffness:
      return per_coordinate(parameter.owner);
    case ParameterKind::kDamping:
      return per_coordinate(parameter.owner) * typical.time;
    case ParameterKind::kMotorP:
      return per_coordinate(model.motors()[static_cast<std::size_t>(parameter.owner)].link);
    case ParameterKind::kMotorD:
      return per_coordinate(model.motors()[static_cast<std::size_t>(parameter.owner)].link) *
             typical.time;
    case ParameterKind::kContactCoefficient:
      switch (parameter.component) {
        case 0:
          return stiffness;
        case 1:
          return stiffness * typical.time;
        case 2:
          return 1.0;
        default:
          return stiffness * typical.time /
                 (model.contact(parameter.owner).normal_law == NormalLaw::kLinear ? 1.0
                                                                                  : typical.length);
      }
    default:
      return 1.0;
  }
}

/// A fraction of the nominal value; moments only as far as the triangle inequality allows.
double parameter_size(const Model& model, const Parameter& parameter, const TypicalSizes& typical) {
  double size = std::abs(parameter.nominal);
  if (parameter.kind == ParameterKind::kContactPoint) {
    // A coordinate may be zero, so the body's extent counts.
    size = model.link(parameter.owner).body.contact_points.cwiseAbs().maxCoeff();
    return size > 0.0 ? 0.1 * size : typical.length;
  }
  if (parameter.kind == ParameterKind::kInertia) {
    const Eigen::Vector3d& I = model.link(parameter.owner).body.inertia;
    size = std::min(size, I.sum() - 2.0 * I.maxCoeff());
  }
  return size > 0.0 ? 0.3 * size : size_of_zero(model, parameter, typical);
}

/// A force motor with a range takes −1 … 1, a position motor a target, one without a range a force.
double control_size(const Model& model, const Motor& motor, int coordinate,
                    const TypicalSizes& typical) {
  if (motor.kind == Motor::Kind::kPosition) {
    return coordinate_size(model, coordinate, typical);
  }
  return std::isfinite(motor.lower) ? 1.0 : effort_size(model, coordinate, typical);
}

}  // namespace

std::vector<ProbedClass> probed_classes(const Problem& problem) {
  const Model& model = problem.horizon.model();
  const ParameterSet& set = problem.horizon.parameters();
  const TypicalSizes typical = typical_sizes(problem);
  std::vector<ProbedClass> classes;
  for (const ParameterKindRow& kind : parameter_kinds()) {
    ProbedClass next{std::string(kind.name), {}, {}};
    for (int i = 0; i < set.size(); ++i) {
      if (set[i].kind == kind.kind) {
        next.entries.push_back(i);
        next.scales.push_back(parameter_size(model, set[i], typical));
      }
    }
    classes.push_back(std::move(next));
  }
  Eigen::Index at = set.size();
  ProbedClass controls{"controls", {}, {}};
  for (int step = 0; step < problem.horizon.steps(); ++step) {
    for (const Motor& motor : model.motors()) {
      const CoordinateRange range = model.coordinates_of_link(motor.link);
      for (int i = range.begin; i < range.end; ++i) {
        controls.entries.push_back(at++);
        controls.scales.push_back(control_size(model, motor, i, typical));
      }
    }
  }
  ProbedClass position{"initial position", {}, {}};
  ProbedClass velocity{"initial velocity", {}, {}};
  for (int i = 0; i < model.dof(); ++i) {
    const double size = coordinate_size(model, i, typical);
    position.entries.push_back(at + i);
    position.scales.push_back(size);
    velocity.entries.push_back(at + model.dof() + i);
    velocity.scales.push_back(size / typical.time);
  }
  classes.insert(classes.end(), {controls, position, velocity});
  std::erase_if(classes, [](const ProbedClass& c) { return c.entries.empty(); });
  return classes;
}

}  // namespace hbar
