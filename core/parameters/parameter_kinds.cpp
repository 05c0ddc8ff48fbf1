#include "hbar/core/parameters/parameter_kinds.h"

#include <array>

#include "hbar/core/base/rotation.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/parameters/parameter_list.h"
#include "hbar/core/parameters/parameter_rows.h"

namespace hbar {
namespace {

// What each kind sets.

template <Scalar S>
using Values = std::span<const ParameterValue<S>>;

/// The nominal pose, displaced by rotation vector w and translation t.
template <Scalar S>
RigidTransform<S> displaced(const RigidTransform<double>& nominal, Values<S> values) {
  Vector6<S> w_t = Vector6<S>::Zero();
  for (const auto& [k, value] : values) {
    w_t[k] = value;
  }
  return {nominal.R.cast<S>() * exp_rotation<S>(w_t.template head<3>()),
          nominal.p.cast<S>() + w_t.template tail<3>()};
}

/// Updates mass, moments and contact points to the sizes already set. Kinds are applied in order,
/// so that all of these hold their values at nominal sizes before.
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

template <Scalar S>
void apply_joint_transform(const Model& model, int link, Values<S> values, Mechanism<S>& out) {
  out.X_PJ[static_cast<std::size_t>(link)] = displaced<S>(model.link(link).joint.X_PJ, values);
}
template <Scalar S>
void apply_body_transform(const Model& model, int link, Values<S> values, Mechanism<S>& out) {
  out.X_JB[static_cast<std::size_t>(link)] = displaced<S>(model.link(link).body.X_JB, values);
}
template <Scalar S>
void apply_contact_points(const Model&, int link, Values<S> values, Mechanism<S>& out) {
  for (const auto& [k, value] : values) {
    out.contact_points[static_cast<std::size_t>(link)](k % 3, k / 3) = value;
  }
}
template <Scalar S>
void apply_inertia(const Model&, int link, Values<S> values, Mechanism<S>& out) {
  for (const auto& [k, value] : values) {
    out.moments(k, link) = value;
  }
}
template <Scalar S>
void apply_contact_coefficients(const Model&, int contact, Values<S> values, Mechanism<S>& out) {
  for (const auto& [k, value] : values) {
    out.contact_coefficients(k, contact) = value;
  }
}
template <Scalar S>
void apply_gravity(const Model&, int, Values<S> values, Mechanism<S>& out) {
  for (const auto& [k, value] : values) {
    out.gravity[k] = value;
  }
}
template <Scalar S>
void apply_sizes(const Model& model, int link, Values<S> values, Mechanism<S>& out) {
  for (const auto& [k, value] : values) {
    out.sizes(k, link) = value;
  }
  resize_body<S>(model.link(link).body, link, out);
}
/// A kind with one number per owner.
template <Scalar S, VectorX<S> Mechanism<S>::*kField>
void apply_number(const Model&, int owner, Values<S> values, Mechanism<S>& out) {
  (out.*kField)[owner] = values.front().value;
}

// How mass and moments change. A mechanism's are the parameters' times factors from the sizes.

template <Scalar S>
InertiaRate<S> rate_by_mass(const Model&, const Mechanism<S>& mechanism, int link,
                            const ParameterValue<S>& at) {
  return {.mass = mechanism.mass[link] / at.value};
}
template <Scalar S>
InertiaRate<S> rate_by_inertia(const Model&, const Mechanism<S>& mechanism, int link,
                               const ParameterValue<S>& at) {
  InertiaRate<S> out;
  out.moments[at.component] = mechanism.moments(at.component, link) / at.value;
  return out;
}
template <Scalar S>
InertiaRate<S> rate_by_size(const Model& model, const Mechanism<S>& mechanism, int link,
                            const ParameterValue<S>& at) {
  const Shape& shape = model.link(link).body.shape;
  const Vector3<S> sizes = mechanism.sizes.col(link);
  const UnitSolid<S> solid = unit_solid<S>(shape, sizes);
  const UnitSolid<S> rate = unit_solid_rate<S>(shape, sizes, at.component);
  InertiaRate<S> out;
  out.mass = mechanism.mass[link] * rate.mass / solid.mass;
  for (int i = 0; i < 3; ++i) {
    out.moments[i] = mechanism.moments(i, link) * rate.moments[i] / solid.moments[i];
  }
  return out;
}

// The table.

using enum ParameterKind;
using Owner = ParameterOwner;
using Effect = ParameterEffect;
using Range = ParameterRange;
using R = double;
using D = Dual;

template <Scalar S>
using M = Mechanism<S>;
template <Scalar S>
using F = JointForces<S>;

constexpr std::array kTable = {
    ParameterKindRow{.kind = kJointTransform,
                     .name = "joint transformation (I)",
                     .owner = Owner::kLink,
                     .mask_bit = kMaskJointTransform,
                     .effect = Effect::kJointFrame,
                     .list = detail::list_joint_transform,
                     .rows = detail::rows_of_joint_frame,
                     .real = {.apply = apply_joint_transform<R>},
                     .dual = {.apply = apply_joint_transform<D>}},
    ParameterKindRow{.kind = kBodyTransform,
                     .name = "body transformation (II)",
                     .owner = Owner::kLink,
                     .mask_bit = kMaskBodyTransform,
                     .effect = Effect::kBodyFrame,
                     .list = detail::list_body_transform,
                     .rows = detail::rows_of_body,
                     .real = {.apply = apply_body_transform<R>},
                     .dual = {.apply = apply_body_transform<D>}},
    ParameterKindRow{.kind = kContactPoint,
                     .name = "contact point (III)",
                     .owner = Owner::kLink,
                     .mask_bit = kMaskContactPoints,
                     .effect = Effect::kContact,
                     .list = detail::list_contact_points,
                     .rows = detail::rows_of_points,
                     .real = {.apply = apply_contact_points<R>},
                     .dual = {.apply = apply_contact_points<D>}},
    ParameterKindRow{
        .kind = kMass,
        .name = "mass (IV)",
        .owner = Owner::kLink,
        .mask_bit = kMaskMassInertia,
        .effect = Effect::kInertia,
        .list = detail::list_mass,
        .rows = detail::rows_of_inertia,
        .real = {.apply = apply_number<R, &M<R>::mass>, .inertia_rate = rate_by_mass<R>},
        .dual = {.apply = apply_number<D, &M<D>::mass>, .inertia_rate = rate_by_mass<D>}},
    ParameterKindRow{.kind = kInertia,
                     .name = "inertia (IV)",
                     .owner = Owner::kLink,
                     .with_previous = true,
                     .mask_bit = kMaskMassInertia,
                     .effect = Effect::kInertia,
                     .list = detail::list_inertia,
                     .rows = detail::rows_of_inertia,
                     .real = {.apply = apply_inertia<R>, .inertia_rate = rate_by_inertia<R>},
                     .dual = {.apply = apply_inertia<D>, .inertia_rate = rate_by_inertia<D>}},
    ParameterKindRow{
        .kind = kStiffness,
        .name = "stiffness (V)",
        .owner = Owner::kLink,
        .mask_bit = kMaskStiffnessDamping,
        .effect = Effect::kJointForce,
        .range = Range::kNonNegative,
        .list = detail::list_stiffness,
        .rows = detail::rows_of_joint,
        .real = {.apply = apply_number<R, &M<R>::stiffness>, .force_by = &F<R>::by_stiffness},
        .dual = {.apply = apply_number<D, &M<D>::stiffness>, .force_by = &F<D>::by_stiffness}},
    ParameterKindRow{
        .kind = kDamping,
        .name = "damping (V)",
        .owner = Owner::kLink,
        .with_previous = true,
        .mask_bit = kMaskStiffnessDamping,
        .effect = Effect::kJointForce,
        .range = Range::kNonNegative,
        .list = detail::list_damping,
        .rows = detail::rows_of_joint,
        .real = {.apply = apply_number<R, &M<R>::damping>, .force_by = &F<R>::by_damping},
        .dual = {.apply = apply_number<D, &M<D>::damping>, .force_by = &F<D>::by_damping}},
    ParameterKindRow{.kind = kContactScale,
                     .name = "contact scale (VI)",
                     .owner = Owner::kLink,
                     .mask_bit = kMaskContactScale,
                     .effect = Effect::kContact,
                     .range = Range::kNonNegative,
                     .list = detail::list_contact_scale,
                     .rows = detail::rows_of_points,
                     .real = {.apply = apply_number<R, &M<R>::contact_scale>},
                     .dual = {.apply = apply_number<D, &M<D>::contact_scale>}},
    ParameterKindRow{.kind = kMotorP,
                     .name = "motor P",
                     .owner = Owner::kMotor,
                     .effect = Effect::kMotorForce,
                     .range = Range::kNonNegative,
                     .list = detail::list_motor_P,
                     .rows = detail::rows_of_motor,
                     .real = {.apply = apply_number<R, &M<R>::motor_P>, .force_by = &F<R>::by_P},
                     .dual = {.apply = apply_number<D, &M<D>::motor_P>, .force_by = &F<D>::by_P}},
    ParameterKindRow{.kind = kMotorD,
                     .name = "motor D",
                     .owner = Owner::kMotor,
                     .with_previous = true,
                     .effect = Effect::kMotorForce,
                     .range = Range::kNonNegative,
                     .list = detail::list_motor_D,
                     .rows = detail::rows_of_motor,
                     .real = {.apply = apply_number<R, &M<R>::motor_D>, .force_by = &F<R>::by_D},
                     .dual = {.apply = apply_number<D, &M<D>::motor_D>, .force_by = &F<D>::by_D}},
    ParameterKindRow{.kind = kGravity,
                     .name = "gravity",
                     .owner = Owner::kModel,
                     .effect = Effect::kGravity,
                     .list = detail::list_gravity,
                     .rows = detail::every_row,
                     .real = {.apply = apply_gravity<R>},
                     .dual = {.apply = apply_gravity<D>}},
    ParameterKindRow{.kind = kContactCoefficient,
                     .name = "contact coefficient",
                     .owner = Owner::kContact,
                     .effect = Effect::kContact,
                     .range = Range::kNonNegative,
                     .list = detail::list_contact_coefficients,
                     .rows = detail::rows_of_contact,
                     .real = {.apply = apply_contact_coefficients<R>},
                     .dual = {.apply = apply_contact_coefficients<D>}},
    // The last: it updates mass, moments and points from their values at nominal sizes.
    ParameterKindRow{.kind = kSize,
                     .name = "size",
                     .owner = Owner::kLink,
                     .effect = Effect::kInertia,
                     .range = Range::kPositive,
                     .list = detail::list_sizes,
                     .rows = detail::rows_of_body,
                     .real = {.apply = apply_sizes<R>, .inertia_rate = rate_by_size<R>},
                     .dual = {.apply = apply_sizes<D>, .inertia_rate = rate_by_size<D>}},
};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (static_cast<std::size_t>(kTable[i].kind) != i) {
      return false;
    }
  }
  return true;
}
static_assert(is_in_order(), "row_of() finds a kind by its number");

int owner_count(const Model& model, ParameterOwner owner) {
  switch (owner) {
    case ParameterOwner::kLink:
      return model.link_count();
    case ParameterOwner::kMotor:
      return static_cast<int>(model.motors().size());
    case ParameterOwner::kContact:
      return model.contact_count();
    case ParameterOwner::kModel:
      break;
  }
  return 1;
}

}  // namespace

std::span<const ParameterKindRow> parameter_kinds() { return kTable; }

const ParameterKindRow& row_of(ParameterKind kind) {
  return kTable[static_cast<std::size_t>(kind)];
}

std::vector<Parameter> list_parameters(const Model& model) {
  std::vector<Parameter> out;
  for (std::size_t first = 0, end = 0; first < kTable.size(); first = end) {
    for (end = first + 1; end < kTable.size() && kTable[end].with_previous;) {
      ++end;
    }
    for (int owner = 0; owner < owner_count(model, kTable[first].owner); ++owner) {
      for (std::size_t i = first; i < end; ++i) {
        kTable[i].list(model, owner, out);
      }
    }
  }
  return out;
}

}  // namespace hbar
