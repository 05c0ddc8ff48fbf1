#include "hbar/core/parameters/parameter_list.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "hbar/core/base/error.h"

namespace hbar::detail {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
/// Optimisers may come this close to zero mass or size, relative to the nominal one.
constexpr double kSmallestShare = 1e-6;

const char* axis(int k) { return kAxes[static_cast<std::size_t>(k)]; }

std::string length(const Model& model) { return std::string(length_unit(model.units())); }

void list_transform(const Model& model, ParameterKind kind, int link, const std::string& owner,
                    ParameterList& out) {
  for (int k = 0; k < 3; ++k) {
    out.push_back({kind, link, k, concat(owner, ".rotation.", axis(k)), "rad", 0.0,
                   -std::numbers::pi, std::numbers::pi});
  }
  for (int k = 0; k < 3; ++k) {
    out.push_back({kind, link, 3 + k, concat(owner, ".translation.", axis(k)), length(model), 0.0,
                   -kUnbounded, kUnbounded});
  }
}

/// "N·m/rad" or "N/m" and the like, by what the joint's first coordinate is.
std::string force_per(const Model& model, int link, bool per_rate) {
  const Joint& joint = model.link(link).joint;
  const bool angle = joint_dof(joint.kind) == 0 || is_angle(joint.kind, 0);
  const bool metric = model.units() == Units::kMetreKilogram;
  const std::string displacement =
      angle ? (metric ? "N·m/rad" : "dyn·cm/rad") : (metric ? "N/m" : "dyn/cm");
  return per_rate ? displacement + "·s" : displacement;
}

void list_gain(const Model& model, ParameterKind kind, int index, ParameterList& out) {
  const Motor& motor = model.motors()[static_cast<std::size_t>(index)];
  if (motor.kind == Motor::Kind::kPosition) {
    const bool rate = kind == ParameterKind::kMotorD;
    out.push_back({kind, index, 0,
                   concat("motor.", model.link(motor.link).joint.name, rate ? ".D" : ".P"),
                   force_per(model, motor.link, rate), rate ? motor.D : motor.P, 0.0, kUnbounded});
  }
}

}  // namespace

void list_joint_transform(const Model& model, int link, ParameterList& out) {
  list_transform(model, ParameterKind::kJointTransform, link,
                 "joint." + model.link(link).joint.name, out);
}

void list_body_transform(const Model& model, int link, ParameterList& out) {
  list_transform(model, ParameterKind::kBodyTransform, link, "body." + model.link(link).body.name,
                 out);
}

void list_contact_points(const Model& model, int link, ParameterList& out) {
  const Link& owner = model.link(link);
  if (!model.is_tested(link) && (owner.design_mask & kMaskContactPoints) == 0) {
    return;
  }
  for (int i = 0; i < owner.body.contact_points.cols(); ++i) {
    for (int k = 0; k < 3; ++k) {
      out.push_back({ParameterKind::kContactPoint, link, 3 * i + k,
                     concat("body.", owner.body.name, ".contact.", i, '.', axis(k)), length(model),
                     owner.body.contact_points(k, i), -kUnbounded, kUnbounded});
    }
  }
}

void list_mass(const Model& model, int link, ParameterList& out) {
  const Body& body = model.link(link).body;
  out.push_back({ParameterKind::kMass, link, 0, concat("body.", body.name, ".mass"),
                 std::string(mass_unit(model.units())), body.mass, kSmallestShare * body.mass,
                 kUnbounded});
}

void list_inertia(const Model& model, int link, ParameterList& out) {
  const Body& body = model.link(link).body;
  for (int k = 0; k < 3; ++k) {
    out.push_back({ParameterKind::kInertia, link, k,
                   concat("body.", body.name, ".inertia.", axis(k)),
                   concat(mass_unit(model.units()), "·", length(model), "²"), body.inertia[k],
                   kSmallestShare * body.inertia[k], kUnbounded});
  }
}

void list_stiffness(const Model& model, int link, ParameterList& out) {
  const Joint& joint = model.link(link).joint;
  out.push_back({ParameterKind::kStiffness, link, 0, concat("joint.", joint.name, ".stiffness"),
                 force_per(model, link, false), joint.stiffness, 0.0, kUnbounded});
}

void list_damping(const Model& model, int link, ParameterList& out) {
  const Joint& joint = model.link(link).joint;
  out.push_back({ParameterKind::kDamping, link, 0, concat("joint.", joint.name, ".damping"),
                 force_per(model, link, true), joint.damping, 0.0, kUnbounded});
}

void list_contact_scale(const Model& model, int link, ParameterList& out) {
  const Link& owner = model.link(link);
  const bool can_touch = owner.body.contact_points.cols() > 0;
  if (model.is_tested(link) || (can_touch && (owner.design_mask & kMaskContactScale) != 0)) {
    out.push_back({ParameterKind::kContactScale, link, 0,
                   concat("body.", owner.body.name, ".contact_scale"), "1", 1.0, 0.0, kUnbounded});
  }
}

void list_motor_P(const Model& model, int motor, ParameterList& out) {
  list_gain(model, ParameterKind::kMotorP, motor, out);
}

void list_motor_D(const Model& model, int motor, ParameterList& out) {
  list_gain(model, ParameterKind::kMotorD, motor, out);
}

void list_gravity(const Model& model, int, ParameterList& out) {
  for (int k = 0; k < 3; ++k) {
    out.push_back({ParameterKind::kGravity, 0, k, concat("gravity.", axis(k)),
                   concat(length(model), "/s²"), model.gravity()[k], -kUnbounded, kUnbounded});
  }
}

void list_contact_coefficients(const Model& model, int index, ParameterList& out) {
  const Contact& contact = model.contact(index);
  const ContactCoefficients& c = contact.coefficients;
  const std::string force = model.units() == Units::kMetreKilogram ? "N" : "dyn";
  const bool linear = contact.normal_law == NormalLaw::kLinear;
  const auto add = [&](int component, const char* name, std::string unit, double nominal) {
    out.push_back({ParameterKind::kContactCoefficient, index, component,
                   concat("contact.", contact.name, name), std::move(unit), nominal, 0.0,
                   kUnbounded});
  };
  add(0, ".kn", concat(force, '/', length(model)), c.kn);
  add(1, ".kt", concat(force, "·s/", length(model)), c.kt);
  add(2, ".mu", "1", c.mu);
  add(3, ".damping", concat(force, "·s/", length(model), linear ? "" : "²"), c.damping);
}

void list_sizes(const Model& model, int link, ParameterList& out) {
  const Body& body = model.link(link).body;
  const std::vector<double> values = sizes_of(body.shape);
  const std::vector<std::string> names = size_names(body.shape);
  for (std::size_t k = 0; k < values.size(); ++k) {
    out.push_back({ParameterKind::kSize, link, static_cast<int>(k),
                   concat("body.", body.name, '.', names[k]), length(model), values[k],
                   kSmallestShare * values[k], kUnbounded});
  }
}

}  // namespace hbar::detail
