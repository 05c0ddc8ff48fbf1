#include "hbar/core/parameters.h"

#include <array>
#include <limits>
#include <numbers>

#include "hbar/core/error.h"
#include "hbar/core/nearest_name.h"
#include "hbar/core/rotation.h"

namespace hbar {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
/// Optimisers may come this close to zero mass, relative to the nominal one.
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
      mass_and_inertia(i);
    }
    for (int i = 0; i < model_.link_count(); ++i) {
      stiffness_and_damping(i);
    }
    motors();
    for (int k = 0; k < 3; ++k) {
      add(ParameterKind::kGravity, 0, k, concat("gravity.", axis(k)),
          concat(length_unit(model_.units()), "/s²"), model_.gravity()[k], -kInfinity, kInfinity);
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
          std::string(length_unit(model_.units())), 0.0, -kInfinity, kInfinity);
    }
  }

  void mass_and_inertia(int link) {
    const Body& body = model_.link(link).body;
    const std::string mass(mass_unit(model_.units()));
    add(ParameterKind::kMass, link, 0, concat("body.", body.name, ".mass"), mass, body.mass,
        kSmallestShare * body.mass, kInfinity);
    for (int k = 0; k < 3; ++k) {
      add(ParameterKind::kInertia, link, k, concat("body.", body.name, ".inertia.", axis(k)),
          concat(mass, "·", length_unit(model_.units()), "²"), body.inertia[k],
          kSmallestShare * body.inertia[k], kInfinity);
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
        force_per(joint, false), joint.stiffness, 0.0, kInfinity);
    add(ParameterKind::kDamping, link, 0, concat("joint.", joint.name, ".damping"),
        force_per(joint, true), joint.damping, 0.0, kInfinity);
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
          force_per(joint, false), motor.P, 0.0, kInfinity);
      add(ParameterKind::kMotorD, owner, 0, concat("motor.", joint.name, ".D"),
          force_per(joint, true), motor.D, 0.0, kInfinity);
    }
  }

  const Model& model_;
  std::vector<Parameter> out_;
};

unsigned mask_bit(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kJointTransform:
      return kMaskJointTransform;
    case ParameterKind::kBodyTransform:
      return kMaskBodyTransform;
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

/// Whether `wanted` is `name` or a prefix of it that ends at a dot.
bool selects(std::string_view wanted, std::string_view name) {
  return name.starts_with(wanted) && (name.size() == wanted.size() || name[wanted.size()] == '.');
}

template <Scalar S>
RigidTransform<S> displaced(const RigidTransform<double>& nominal, const Vector6<S>& w_t) {
  return {nominal.R.cast<S>() * exp_rotation<S>(w_t.template head<3>()),
          nominal.p.cast<S>() + w_t.template tail<3>()};
}

void require_physical(const Model& model, const Eigen::VectorXd& mass,
                      const Eigen::Matrix3Xd& moments) {
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    const std::string& body = model.link(static_cast<int>(i)).body.name;
    if (!(mass[i] > 0.0)) {
      throw InvalidInput(concat("body.", body, ".mass is ", mass[i], "; it must be positive"));
    }
    const Eigen::Vector3d I = moments.col(i);
    if (!(I.minCoeff() > 0.0) || 2.0 * I.maxCoeff() > I.sum() * (1.0 + 1e-9)) {
      throw InvalidInput(concat("body.", body, ".inertia is (", I.transpose(),
                                "); moments must be positive and none may exceed the sum of the "
                                "other two (see InertiaChart for a chart that keeps to that)"));
    }
  }
}

}  // namespace

const std::vector<ParameterKind>& parameter_kinds() {
  static const std::vector<ParameterKind> kinds = {
      ParameterKind::kJointTransform, ParameterKind::kBodyTransform, ParameterKind::kMass,
      ParameterKind::kInertia,        ParameterKind::kStiffness,     ParameterKind::kDamping,
      ParameterKind::kMotorP,         ParameterKind::kMotorD,        ParameterKind::kGravity};
  return kinds;
}

std::string_view kind_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kJointTransform:
      return "joint transformation (I)";
    case ParameterKind::kBodyTransform:
      return "body transformation (II)";
    case ParameterKind::kMass:
      return "mass (IV)";
    case ParameterKind::kInertia:
      return "inertia (IV)";
    case ParameterKind::kStiffness:
      return "stiffness (V)";
    case ParameterKind::kDamping:
      return "damping (V)";
    case ParameterKind::kMotorP:
      return "motor P";
    case ParameterKind::kMotorD:
      return "motor D";
    case ParameterKind::kGravity:
      return "gravity";
  }
  return "";
}

ParameterSet::ParameterSet(std::vector<Parameter> parameters) : parameters_(std::move(parameters)) {
  for (int i = 0; i < size(); ++i) {
    const Parameter& parameter = (*this)[i];
    if (blocks_.empty() || blocks_.back().kind != parameter.kind ||
        blocks_.back().owner != parameter.owner) {
      blocks_.push_back({parameter.kind, parameter.owner, i, 0});
    }
    ++blocks_.back().size;
  }
}

ParameterSet ParameterSet::all(const Model& model) { return ParameterSet(Lister(model).list()); }

ParameterSet ParameterSet::masked(const Model& model) {
  std::vector<Parameter> chosen;
  for (Parameter& parameter : Lister(model).list()) {
    const unsigned bit = mask_bit(parameter.kind);
    if (bit != 0 && (model.link(parameter.owner).design_mask & bit) != 0) {
      chosen.push_back(std::move(parameter));
    }
  }
  return ParameterSet(std::move(chosen));
}

ParameterSet ParameterSet::named(const Model& model, const std::vector<std::string>& names) {
  std::vector<Parameter> every = Lister(model).list();
  std::vector<bool> wanted(every.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    for (std::size_t i = 0; i < every.size(); ++i) {
      if (!name.empty() && selects(name, every[i].name)) {
        wanted[i] = true;
        found = true;
      }
    }
    if (!found) {
      std::vector<std::string> known;
      for (const Parameter& parameter : every) {
        known.push_back(parameter.name);
      }
      throw InvalidInput(
          concat("there is no parameter '", name, "'; ", unknown_name_hint(name, known)));
    }
  }
  std::vector<Parameter> chosen;
  for (std::size_t i = 0; i < every.size(); ++i) {
    if (wanted[i]) {
      chosen.push_back(std::move(every[i]));
    }
  }
  return ParameterSet(std::move(chosen));
}

int ParameterSet::find(std::string_view name) const {
  std::vector<std::string> known;
  for (int i = 0; i < size(); ++i) {
    if ((*this)[i].name == name) {
      return i;
    }
    known.push_back((*this)[i].name);
  }
  throw InvalidInput(
      concat("parameter '", name, "' is not in the set; ", unknown_name_hint(name, known)));
}

namespace {

template <typename Field>
Eigen::VectorXd gather(const std::vector<Parameter>& parameters, Field field) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    out[i] = parameters[static_cast<std::size_t>(i)].*field;
  }
  return out;
}

}  // namespace

Eigen::VectorXd ParameterSet::nominal() const { return gather(parameters_, &Parameter::nominal); }
Eigen::VectorXd ParameterSet::lower() const { return gather(parameters_, &Parameter::lower); }
Eigen::VectorXd ParameterSet::upper() const { return gather(parameters_, &Parameter::upper); }

template <Scalar S>
void apply_parameters(const Model& model, const ParameterSet& set, const VectorView<S>& p,
                      Mechanism<S>& mechanism) {
  if (p.size() != set.size()) {
    throw InvalidInput(concat("p has ", p.size(), " entries; the parameter set has ", set.size()));
  }
  mechanism = nominal_mechanism<S>(model);
  for (const ParameterBlock& block : set.blocks()) {
    const auto owner = static_cast<std::size_t>(block.owner);
    Vector6<S> w_t = Vector6<S>::Zero();
    for (int i = block.first; i < block.first + block.size; ++i) {
      if (!std::isfinite(value_of(p[i]))) {
        throw InvalidInput(concat(set[i].name, " is ", value_of(p[i]), "; it must be finite"));
      }
      const int k = set[i].component;
      switch (block.kind) {
        case ParameterKind::kJointTransform:
        case ParameterKind::kBodyTransform:
          w_t[k] = p[i];
          break;
        case ParameterKind::kMass:
          mechanism.mass[block.owner] = p[i];
          break;
        case ParameterKind::kInertia:
          mechanism.moments(k, block.owner) = p[i];
          break;
        case ParameterKind::kStiffness:
          mechanism.stiffness[block.owner] = p[i];
          break;
        case ParameterKind::kDamping:
          mechanism.damping[block.owner] = p[i];
          break;
        case ParameterKind::kMotorP:
          mechanism.motor_P[block.owner] = p[i];
          break;
        case ParameterKind::kMotorD:
          mechanism.motor_D[block.owner] = p[i];
          break;
        case ParameterKind::kGravity:
          mechanism.gravity[k] = p[i];
          break;
      }
    }
    if (block.kind == ParameterKind::kJointTransform) {
      mechanism.X_PJ[owner] = displaced<S>(model.link(block.owner).joint.X_PJ, w_t);
    } else if (block.kind == ParameterKind::kBodyTransform) {
      mechanism.X_JB[owner] = displaced<S>(model.link(block.owner).body.X_JB, w_t);
    }
  }
  require_physical(model, mechanism.mass.unaryExpr([](const S& m) { return value_of(m); }),
                   mechanism.moments.unaryExpr([](const S& m) { return value_of(m); }));
  mechanism.update_inertia();
}

template void apply_parameters(const Model&, const ParameterSet&, const VectorView<double>&,
                               Mechanism<double>&);
template void apply_parameters(const Model&, const ParameterSet&, const VectorView<Dual>&,
                               Mechanism<Dual>&);

}  // namespace hbar
