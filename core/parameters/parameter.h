#pragma once

#include <string>

namespace hbar {

/// Classes of design parameters, in the order in which they are listed: first those of Table II of
/// the source named in doc/notation.md, by its Roman numerals, then hbar's own.
enum class ParameterKind {
  kJointTransform,  ///< I: rotation vector w and translation t, X_PJ = (R̄ exp([w]), p̄ + t)
  kBodyTransform,   ///< II: the same for X_JB
  kContactPoint,    ///< III: x, y, z of each contact point in the body frame, at nominal sizes
  kMass,            ///< IV: at nominal sizes
  kInertia,         ///< IV: principal moments, at nominal sizes
  kStiffness,       ///< V
  kDamping,         ///< V
  kContactScale,    ///< VI: s of the body whose points touch
  kMotorP,
  kMotorD,
  kGravity,
  kContactCoefficient,  ///< k_n, k_t, μ, k_d of a contact
  kSize  ///< of a body's shape: moves its contact points and surface, scales its mass and moments
};

/// One scalar design parameter.
struct Parameter {
  ParameterKind kind = ParameterKind::kJointTransform;
  int owner = 0;         ///< link, motor or contact; 0 for gravity
  int component = 0;     ///< within its kind and owner
  std::string name;      ///< as in scene_format.md: "joint.NAME.rotation.x", "body.NAME.mass", …
  std::string unit;      ///< in the model's unit system
  double nominal = 0.0;  ///< the model's own value; 0 for transformations
  double lower = 0.0;    ///< physical bound
  double upper = 0.0;
  friend bool operator==(const Parameter&, const Parameter&) = default;
};

/// Scalars of one kind and owner that are contiguous in p.
struct ParameterBlock {
  ParameterKind kind = ParameterKind::kJointTransform;
  int owner = 0;
  int first = 0;  ///< index in p
  int size = 0;
};

}  // namespace hbar
