#include "hbar/core/parameters/parameter_list.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
/// Optimisers may come this close to zero mass or size, relative to the nominal one.
constexpr double kSmallestShare = 1e-6;

/// Appends the parameters of one kind, for all owners that `wanted` accepts.
class Lister {
 public:
  explicit Lister(const Model& model) : model_(model) {}

  std::vector<Parameter> list() {
    for (int i = 0; i < model_.link_count(); ++i) {
      transform(ParameterKind::kJointTransform, i, "joint." + model_.link(i).joint.name);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      transform(ParameterKind::kBodyTransform, i, "body." + model_.link(i).body.name);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      contact_points(i);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      mass_and_inertia(i);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      stiffness_and_damping(i);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      contact_scale(i);
    }
    motors();
    for (int k = 0; k < 3; ++k) {
      add(ParameterKind::kGravity, 0, k, concat("gravity.", axis(k)),
          concat(length_unit(model_.units()), "/s²"), model_.gravity()[k], -kUnbounded, kUnbounded);
    }
    for (int i = 0; i < model_.contact_count(); ++i) {
      contact_coefficients(i);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      sizes(i);
    }
    return std::move(out_);
  }

 private:
  static std::string_view axis(int k) { return kAxes[static_cast<std::size_t>(k)]; }

  void add(ParameterKind kind, int owner, int component, std::string name, std::string unit,
           double nominal, double lower, double upper) {
    out_.push_back(
        {kind, owner, component, std::move(name), std::move(unit), nominal, lower, upper});
  }

  void transform(ParameterKind kind, int link, const std::string& owner) {
    for (int k = 0; k < 3; ++k) {
      add(kind, link, k, concat(owner, ".rotation.", axis(k)), "rad", 0.0, -std::numbers::pi,
          std::numbers::pi);
    }
    for (int k = 0; k < 3; ++k) {
      add(kind, link, 3 + k, concat(owner, ".translation.", axis(k)),
          std::string(length_unit(model_.units())), 0.0, -kUnbounded, kUnbounded);
    }
  }

  /// Whether a contact tests the body's points.
  bool touches(int link) const {
    return std::any_of(model_.contacts().begin(), model_.contacts().end(),
                       [link](const Contact& contact) { return contact.link == link; });
  }

  void contact_points(int link) {
    const Link& owner = model_.link(link);
    if (!touches(link) && (owner.design_mask & kMaskContactPoints) == 0) {
      return;
    }
    const std::string unit(length_unit(model_.units()));
    for (int i = 0; i < owner.body.contact_points.cols(); ++i) {
      for (int k = 0; k < 3; ++k) {
        add(ParameterKind::kContactPoint, link, 3 * i + k,
            concat("body.", owner.body.name, ".contact.", i, '.', axis(k)), unit,
            owner.body.contact_points(k, i), -kUnbounded, kUnbounded);
      }
    }
  }

  void contact_scale(int link) {
    const Link& owner = model_.link(link);
    const bool can_touch = owner.body.contact_points.cols() > 0;
    if (touches(link) || (can_touch && (owner.design_mask & kMaskContactScale) != 0)) {
      add(ParameterKind::kContactScale, link, 0, concat("body.", owner.body.name, ".contact_scale"),
          "1", 1.0, 0.0, kUnbounded);
    }
  }

  void contact_coefficients(int i) {
    const Contact& contact = model_.contact(i);
    const bool metric = model_.units() == Units::kMetreKilogram;
    const bool linear = contact.normal_law == NormalLaw::kLinear;
    const std::string force = metric ? "N" : "dyn";
    const std::string length(length_unit(model_.units()));
    const std::string name = concat("contact.", contact.name);
    const ContactCoefficients& c = contact.coefficients;
    add(ParameterKind::kContactCoefficient, i, 0, name + ".kn", concat(force, '/', length), c.kn,
        0.0, kUnbounded);
    add(ParameterKind::kContactCoefficient, i, 1, name + ".kt", concat(force, "·s/", length), c.kt,
        0.0, kUnbounded);
    add(ParameterKind::kContactCoefficient, i, 2, name + ".mu", "1", c.mu, 0.0, kUnbounded);
    add(ParameterKind::kContactCoefficient, i, 3, name + ".damping",
        concat(force, "·s/", length, linear ? "" : "²"), c.damping, 0.0, kUnbounded);
  }

  void sizes(int link) {
    const Body& body = model_.link(link).body;
    const std::vector<double> values = sizes_of(body.shape);
    const std::vector<std::string> names = size_names(body.shape);
    for (std::size_t k = 0; k < values.size(); ++k) {
      add(ParameterKind::kSize, link, static_cast<int>(k),
          concat("body.", body.name, '.', names[k]), std::string(length_unit(model_.units())),
          values[k], kSmallestShare * values[k], kUnbounded);
    }
  }

  void mass_and_inertia(int link) {
    const Body& body = model_.link(link).body;
    const std::string mass(mass_unit(model_.units()));
    add(ParameterKind::kMass, link, 0, concat("body.", body.name, ".mass"), mass, body.mass,
        kSmallestShare * body.mass, kUnbounded);
    for (int k = 0; k < 3; ++k) {
      add(ParameterKind::kInertia, link, k, concat("body.", body.name, ".inertia.", axis(k)),
          concat(mass, "·", length_unit(model_.units()), "²"), body.inertia[k],
          kSmallestShare * body.inertia[k], kUnbounded);
    }
  }

  /// "N·m/rad" or "N/m" and the like, by what the joint's first coordinate is.
  std::string force_per(const Joint& joint, bool per_rate) const {
    const bool angle = joint_dof(joint.kind) == 0 || is_angle(joint.kind, 0);
    const bool metric = model_.units() == Units::kMetreKilogram;
    const std::string displacement =
        angle ? (metric ? "N·m/rad" : "dyn·cm/rad") : (metric ? "N/m" : "dyn/cm");
    return per_rate ? displacement + "·s" : displacement;
  }

  void stiffness_and_damping(int link) {
    const Joint& joint = model_.link(link).joint;
    add(ParameterKind::kStiffness, link, 0, concat("joint.", joint.name, ".stiffness"),
        force_per(joint, false), joint.stiffness, 0.0, kUnbounded);
    add(ParameterKind::kDamping, link, 0, concat("joint.", joint.name, ".damping"),
        force_per(joint, true), joint.damping, 0.0, kUnbounded);
  }

  void motors() {
    for (std::size_t m = 0; m < model_.motors().size(); ++m) {
      const Motor& motor = model_.motors()[m];
      if (motor.kind != Motor::Kind::kPosition) {
        continue;
      }
      const Joint& joint = model_.link(motor.link).joint;
      const int owner = static_cast<int>(m);
      add(ParameterKind::kMotorP, owner, 0, concat("motor.", joint.name, ".P"),
          force_per(joint, false), motor.P, 0.0, kUnbounded);
      add(ParameterKind::kMotorD, owner, 0, concat("motor.", joint.name, ".D"),
          force_per(joint, true), motor.D, 0.0, kUnbounded);
    }
  }

  const Model& model_;
  std::vector<Parameter> out_;
};

}  // namespace

std::vector<Parameter> list_parameters(const Model& model) { return Lister(model).list(); }

unsigned mask_bit(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kJointTransform:
      return kMaskJointTransform;
    case ParameterKind::kBodyTransform:
      return kMaskBodyTransform;
    case ParameterKind::kContactPoint:
      return kMaskContactPoints;
    case ParameterKind::kContactScale:
      return kMaskContactScale;
    case ParameterKind::kMass:
    case ParameterKind::kInertia:
      return kMaskMassInertia;
    case ParameterKind::kStiffness:
    case ParameterKind::kDamping:
      return kMaskStiffnessDamping;
    default:
      return 0;
  }
}

}  // namespace hbar
