#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "hbar/core/dynamics/joint_forces.h"
#include "hbar/core/parameters/parameter.h"

namespace hbar {

/// What a parameter belongs to: what Parameter::owner indexes.
enum class ParameterOwner { kLink, kMotor, kContact, kModel };

/// What a parameter changes, which decides how derivatives with respect to it are computed. Changes
/// of contact forces are added (contact/contact_parameters.h).
enum class ParameterEffect {
  kJointFrame,  ///< displaces everything below a joint's rest frame
  kBodyFrame,   ///< displaces a body alone
  kInertia,     ///< mass and moments of a body
  kJointForce,  ///< joint forces of a link, coordinate by coordinate
  kMotorForce,  ///< joint forces of a motor, control by control
  kGravity,
  kContact  ///< contact forces alone
};

/// The values that a parameter may take; physically impossible bodies are refused in addition.
enum class ParameterRange { kAny, kNonNegative, kPositive };

/// A component of a parameter block, and its value.
template <Scalar S>
struct ParameterValue {
  int component = 0;
  S value = S(0.0);
};

/// How a body's mass and principal moments change with a parameter.
template <Scalar S>
struct InertiaRate {
  S mass = S(0.0);
  Vector3<S> moments = Vector3<S>::Zero();  ///<                                        [3]
};

/// The numerical functions of a kind.
template <Scalar S>
struct ParameterActions {
  /// Sets a mechanism's numbers; those of the kinds listed before are already set.
  void (*apply)(const Model& model, int owner, std::span<const ParameterValue<S>> values,
                Mechanism<S>& mechanism) = nullptr;
  /// For kInertia, with the parameter applied.
  InertiaRate<S> (*inertia_rate)(const Model& model, const Mechanism<S>& mechanism, int owner,
                                 const ParameterValue<S>& at) = nullptr;
  /// For kJointForce and kMotorForce: which derivative of the joint forces belongs to this kind.
  VectorX<S> JointForces<S>::*force_by = nullptr;
};

/// A kind of parameter: a row of the table, with everything that is specific to the kind.
struct ParameterKindRow {
  ParameterKind kind = ParameterKind::kJointTransform;
  std::string_view name = {};  ///< in messages and reports
  ParameterOwner owner = ParameterOwner::kLink;
  bool with_previous = false;  ///< listed together with the previous row, owner by owner
  unsigned mask_bit = 0;       ///< of a link's design mask that selects it; 0: none does
  ParameterEffect effect = ParameterEffect::kContact;
  ParameterRange range = ParameterRange::kAny;
  /// Appends an owner's parameters.
  void (*list)(const Model& model, int owner, std::vector<Parameter>& out) = nullptr;
  /// The rows of g that it can affect, ascending.
  std::vector<int> (*rows)(const Model& model, int owner) = nullptr;
  ParameterActions<double> real = {};
  ParameterActions<Dual> dual = {};

  template <Scalar S>
  [[nodiscard]] const ParameterActions<S>& actions() const {
    if constexpr (std::same_as<S, double>) {
      return real;
    } else {
      return dual;
    }
  }
};

/// The table, in the order of ParameterKind, which is that of p.
[[nodiscard]] std::span<const ParameterKindRow> parameter_kinds();
/// The row of a kind.
[[nodiscard]] const ParameterKindRow& row_of(ParameterKind kind);
[[nodiscard]] inline std::string_view kind_name(ParameterKind kind) { return row_of(kind).name; }

/// Every scalar that can be free in a model, in the order of p: kind by kind, then owner by owner
/// (links, motors, contacts), then by component; mass and inertia, stiffness and damping, P and D
/// are listed together by owner. Contact points and scales are listed for bodies whose points a
/// contact tests, and for those whose design mask selects them.
[[nodiscard]] std::vector<Parameter> list_parameters(const Model& model);

/// The rows of g that a block's parameters can affect, ascending: the coordinates on the path to
/// the world, for a joint transformation also those below it, and those coupled by contacts of
/// moved bodies.
[[nodiscard]] inline std::vector<int> parameter_rows(const Model& model,
                                                     const ParameterBlock& block) {
  return row_of(block.kind).rows(model, block.owner);
}

}  // namespace hbar
