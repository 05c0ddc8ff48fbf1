#include "hbar/core/parameters/parameters.h"

#include <algorithm>
#include <tuple>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/base/rotation.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/parameters/parameter_list.h"

namespace hbar {
namespace {

/// Whether `wanted` is `name` or a prefix of it that ends at a dot.
bool selects(std::string_view wanted, std::string_view name) {
  return name.starts_with(wanted) && (name.size() == wanted.size() || name[wanted.size()] == '.');
}

template <Scalar S>
RigidTransform<S> displaced(const RigidTransform<double>& nominal, const Vector6<S>& w_t) {
  return {nominal.R.cast<S>() * exp_rotation<S>(w_t.template head<3>()),
          nominal.p.cast<S>() + w_t.template tail<3>()};
}

/// Lets mass, moments and contact points follow the sizes already set. Kinds are applied in order,
/// so that all of these hold their values at nominal sizes.
template <Scalar S>
void resize_body(const Body& body, int link, Mechanism<S>& mechanism) {
  const auto& sizes = mechanism.sizes.col(link);
  const std::vector<double> listed = sizes_of(body.shape);
  Eigen::Vector3d nominal = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < listed.size(); ++k) {
    nominal[static_cast<Eigen::Index>(k)] = listed[k];
  }
  const UnitSolid<S> now = unit_solid<S>(body.shape, sizes);
  const UnitSolid<double> before = unit_solid<double>(body.shape, nominal);
  mechanism.mass[link] *= now.mass / before.mass;
  for (int k = 0; k < 3; ++k) {
    mechanism.moments(k, link) *= now.moments[k] / before.moments[k];
  }
  auto& points = mechanism.contact_points[static_cast<std::size_t>(link)];
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (std::size_t k = 0; k < listed.size(); ++k) {
      const Eigen::Vector3d rate =
          surface_point_rate(body.shape, body.contact_points.col(i), static_cast<int>(k));
      points.col(i) += rate.cast<S>() * (sizes[static_cast<Eigen::Index>(k)] - listed[k]);
    }
  }
}

/// Coefficients, scales and sizes that no contact can have.
template <Scalar S>
void require_contact_numbers(const ParameterSet& set, const VectorView<S>& p) {
  for (int i = 0; i < set.size(); ++i) {
    const double value = value_of(p[i]);
    const ParameterKind kind = set[i].kind;
    const bool may_vanish =
        kind == ParameterKind::kContactScale || kind == ParameterKind::kContactCoefficient;
    if ((may_vanish && value < 0.0) || (kind == ParameterKind::kSize && !(value > 0.0))) {
      throw InvalidInput(
          concat(set[i].name, " is ", value, "; it must be ", may_vanish ? "≥ 0" : "positive"));
    }
  }
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
  static const std::vector<ParameterKind> kinds = {ParameterKind::kJointTransform,
                                                   ParameterKind::kBodyTransform,
                                                   ParameterKind::kContactPoint,
                                                   ParameterKind::kMass,
                                                   ParameterKind::kInertia,
                                                   ParameterKind::kStiffness,
                                                   ParameterKind::kDamping,
                                                   ParameterKind::kContactScale,
                                                   ParameterKind::kMotorP,
                                                   ParameterKind::kMotorD,
                                                   ParameterKind::kGravity,
                                                   ParameterKind::kContactCoefficient,
                                                   ParameterKind::kSize};
  return kinds;
}

std::string_view kind_name(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::kJointTransform:
      return "joint transformation (I)";
    case ParameterKind::kBodyTransform:
      return "body transformation (II)";
    case ParameterKind::kContactPoint:
      return "contact point (III)";
    case ParameterKind::kMass:
      return "mass (IV)";
    case ParameterKind::kInertia:
      return "inertia (IV)";
    case ParameterKind::kStiffness:
      return "stiffness (V)";
    case ParameterKind::kDamping:
      return "damping (V)";
    case ParameterKind::kContactScale:
      return "contact scale (VI)";
    case ParameterKind::kMotorP:
      return "motor P";
    case ParameterKind::kMotorD:
      return "motor D";
    case ParameterKind::kGravity:
      return "gravity";
    case ParameterKind::kContactCoefficient:
      return "contact coefficient";
    case ParameterKind::kSize:
      return "size";
  }
  return "";
}

namespace {

/// Where list_parameters puts a kind of an owner: kinds that Table II has under one number, and
/// both gains of a motor, stand together by owner.
std::tuple<ParameterKind, int, ParameterKind> place(ParameterKind kind, int owner) {
  switch (kind) {
    case ParameterKind::kInertia:
      return {ParameterKind::kMass, owner, kind};
    case ParameterKind::kDamping:
      return {ParameterKind::kStiffness, owner, kind};
    case ParameterKind::kMotorD:
      return {ParameterKind::kMotorP, owner, kind};
    default:
      return {kind, owner, kind};
  }
}

}  // namespace

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

ParameterSet ParameterSet::all(const Model& model) { return ParameterSet(list_parameters(model)); }

ParameterSet ParameterSet::masked(const Model& model) {
  std::vector<Parameter> chosen;
  for (Parameter& parameter : list_parameters(model)) {
    const unsigned bit = mask_bit(parameter.kind);
    if (bit != 0 && (model.link(parameter.owner).design_mask & bit) != 0) {
      chosen.push_back(std::move(parameter));
    }
  }
  return ParameterSet(std::move(chosen));
}

ParameterSet ParameterSet::named(const Model& model, const std::vector<std::string>& names) {
  std::vector<Parameter> every = list_parameters(model);
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

int ParameterSet::index(ParameterKind kind, int owner, int component) const {
  const auto block = std::lower_bound(
      blocks_.begin(), blocks_.end(), place(kind, owner),
      [](const ParameterBlock& b, const auto& wanted) { return place(b.kind, b.owner) < wanted; });
  if (block == blocks_.end() || block->kind != kind || block->owner != owner) {
    return -1;
  }
  const auto first = parameters_.begin() + block->first;
  const auto found = std::lower_bound(
      first, first + block->size, component,
      [](const Parameter& parameter, int wanted) { return parameter.component < wanted; });
  return found != first + block->size && found->component == component
             ? static_cast<int>(found - parameters_.begin())
             : -1;
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
  require_contact_numbers<S>(set, p);
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
        case ParameterKind::kContactPoint:
          mechanism.contact_points[owner](k % 3, k / 3) = p[i];
          break;
        case ParameterKind::kContactScale:
          mechanism.contact_scale[block.owner] = p[i];
          break;
        case ParameterKind::kContactCoefficient:
          mechanism.contact_coefficients(k, block.owner) = p[i];
          break;
        case ParameterKind::kSize:
          mechanism.sizes(k, block.owner) = p[i];
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
    } else if (block.kind == ParameterKind::kSize) {
      resize_body<S>(model.link(block.owner).body, block.owner, mechanism);
    }
  }
  require_physical(model, mechanism.mass.unaryExpr([](const S& m) { return value_of(m); }),
                   mechanism.moments.unaryExpr([](const S& m) { return value_of(m); }));
  mechanism.update_derived(model);
}

template void apply_parameters(const Model&, const ParameterSet&, const VectorView<double>&,
                               Mechanism<double>&);
template void apply_parameters(const Model&, const ParameterSet&, const VectorView<Dual>&,
                               Mechanism<Dual>&);

}  // namespace hbar
