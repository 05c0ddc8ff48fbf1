#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hbar/core/base/spatial.h"

namespace hbar {

/// The kinds of joint. Axes are unit vectors in the joint frame; coordinates are listed in order.
struct FixedJoint {
  friend bool operator==(const FixedJoint&, const FixedJoint&) = default;
};
/// θ: rotation about `axis`.
struct RevoluteJoint {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  friend bool operator==(const RevoluteJoint& a, const RevoluteJoint& b) {
    return a.axis == b.axis;
  }
};
/// d: translation along `axis`.
struct PrismaticJoint {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  friend bool operator==(const PrismaticJoint& a, const PrismaticJoint& b) {
    return a.axis == b.axis;
  }
};
/// d0, d1: translations along `axis0` and `axis1`.
struct PlanarJoint {
  Eigen::Vector3d axis0 = Eigen::Vector3d::UnitX();
  Eigen::Vector3d axis1 = Eigen::Vector3d::UnitY();
  friend bool operator==(const PlanarJoint& a, const PlanarJoint& b) {
    return a.axis0 == b.axis0 && a.axis1 == b.axis1;
  }
};
/// x, y, z: translation.
struct TranslationalJoint {
  friend bool operator==(const TranslationalJoint&, const TranslationalJoint&) = default;
};
/// x, y, θ: translation in the x-y plane, then rotation about z.
struct Free2dJoint {
  friend bool operator==(const Free2dJoint&, const Free2dJoint&) = default;
};
/// a, b, c: R = Rx(a) Ry(b) Rz(c).
struct SphericalEulerJoint {
  friend bool operator==(const SphericalEulerJoint&, const SphericalEulerJoint&) = default;
};
/// r ∈ R³: R = exp([r]).
struct SphericalExpJoint {
  friend bool operator==(const SphericalExpJoint&, const SphericalExpJoint&) = default;
};
/// x, y, z, a, b, c: translation, then R = Rx(a) Ry(b) Rz(c).
struct Free3dEulerJoint {
  friend bool operator==(const Free3dEulerJoint&, const Free3dEulerJoint&) = default;
};
/// x, y, z, r: translation, then R = exp([r]).
struct Free3dExpJoint {
  friend bool operator==(const Free3dExpJoint&, const Free3dExpJoint&) = default;
};
/// a, b: rotation about `axis0`, then about `axis1`.
struct UniversalJoint {
  Eigen::Vector3d axis0 = Eigen::Vector3d::UnitX();
  Eigen::Vector3d axis1 = Eigen::Vector3d::UnitY();
  friend bool operator==(const UniversalJoint& a, const UniversalJoint& b) {
    return a.axis0 == b.axis0 && a.axis1 == b.axis1;
  }
};
using JointKind = std::variant<FixedJoint, RevoluteJoint, PrismaticJoint, PlanarJoint,
                               TranslationalJoint, Free2dJoint, SphericalEulerJoint,
                               SphericalExpJoint, Free3dEulerJoint, Free3dExpJoint, UniversalJoint>;

/// The four elementary motions; every joint is a chain of them. Only the exponential rotation has a
/// motion subspace that depends on its coordinates.
enum class MotionKind { kFixed, kRotation, kTranslation, kExponential };

/// One element of that chain.
struct ElementaryMotion {
  MotionKind kind = MotionKind::kFixed;
  Eigen::Vector3d axis =
      Eigen::Vector3d::Zero();  ///< unit, in its own frame; rotation, translation
};

/// The chain of elementary motions that makes up a joint, outermost (next to the parent) first. A
/// fixed joint gives one motion without coordinates.
[[nodiscard]] std::vector<ElementaryMotion> elementary_motions(const JointKind& kind);

/// Number of coordinates of an elementary motion: 0, 1, 1, 3.
[[nodiscard]] int motion_dof(MotionKind kind);

/// Number of coordinates of a joint.
[[nodiscard]] int joint_dof(const JointKind& kind);

/// The joint's type as scene files spell it: "revolute", "free3d-exp", …
[[nodiscard]] std::string_view joint_type(const JointKind& kind);

/// Names of a joint's coordinates in order: {"theta"}, {"x", "y", "z", "rx", "ry", "rz"}, …
[[nodiscard]] std::vector<std::string> coordinate_names(const JointKind& kind);

/// Whether coordinate `i` of a joint is an angle (else it is a length).
[[nodiscard]] bool is_angle(const JointKind& kind, int i);

/// Springs that act outside an interval, which is the same for each coordinate of a joint.
struct JointLimits {
  double lower = 0.0;      ///< rad or length
  double upper = 0.0;      ///< rad or length, ≥ lower
  double stiffness = 0.0;  ///< force per displacement outside, ≥ 0
  friend bool operator==(const JointLimits&, const JointLimits&) = default;
};

/// A joint: the rest pose of its frame, how it moves, and its passive forces, −stiffness (q − rest)
/// − damping q̇ and the limit springs, per coordinate.
struct Joint {
  std::string name = {};
  JointKind kind = FixedJoint{};
  RigidTransform<double> X_PJ = {};  ///< joint frame at rest in the parent's joint frame
  double damping = 0.0;              ///< torque·time or force·time/length, ≥ 0
  double stiffness = 0.0;            ///< torque/rad or force/length, ≥ 0
  Eigen::VectorXd rest = {};         ///< rad or length; empty means zeros       [dof]
  std::optional<JointLimits> limits = {};

  friend bool operator==(const Joint& a, const Joint& b) {
    return a.name == b.name && a.kind == b.kind && a.X_PJ == b.X_PJ && a.damping == b.damping &&
           a.stiffness == b.stiffness && a.rest.size() == b.rest.size() && a.rest == b.rest &&
           a.limits == b.limits;
  }
};

}  // namespace hbar
