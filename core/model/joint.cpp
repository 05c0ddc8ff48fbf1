#include "hbar/core/model/joint.h"

namespace hbar {
namespace {

using Eigen::Vector3d;
using Motions = std::vector<ElementaryMotion>;

ElementaryMotion rotation(const Vector3d& axis) { return {MotionKind::kRotation, axis}; }
ElementaryMotion translation(const Vector3d& axis) { return {MotionKind::kTranslation, axis}; }
ElementaryMotion exponential() { return {MotionKind::kExponential, Vector3d::Zero()}; }

/// Names and elementary motions of a joint kind, in one place.
struct JointTraits {
  std::string_view type;
  Motions motions;
  std::vector<std::string> coordinates;
};

JointTraits traits(const FixedJoint&) { return {"fixed", {ElementaryMotion{}}, {}}; }
JointTraits traits(const RevoluteJoint& j) { return {"revolute", {rotation(j.axis)}, {"theta"}}; }
JointTraits traits(const PrismaticJoint& j) { return {"prismatic", {translation(j.axis)}, {"d"}}; }
JointTraits traits(const PlanarJoint& j) {
  return {"planar", {translation(j.axis0), translation(j.axis1)}, {"d0", "d1"}};
}
JointTraits traits(const TranslationalJoint&) {
  return {"translational",
          {translation(Vector3d::UnitX()), translation(Vector3d::UnitY()),
           translation(Vector3d::UnitZ())},
          {"x", "y", "z"}};
}
JointTraits traits(const Free2dJoint&) {
  return {
      "free2d",
      {translation(Vector3d::UnitX()), translation(Vector3d::UnitY()), rotation(Vector3d::UnitZ())},
      {"x", "y", "theta"}};
}
JointTraits traits(const SphericalEulerJoint&) {
  return {"spherical-euler",
          {rotation(Vector3d::UnitX()), rotation(Vector3d::UnitY()), rotation(Vector3d::UnitZ())},
          {"a", "b", "c"}};
}
JointTraits traits(const SphericalExpJoint&) {
  return {"spherical-exp", {exponential()}, {"rx", "ry", "rz"}};
}
JointTraits traits(const UniversalJoint& j) {
  return {"universal", {rotation(j.axis0), rotation(j.axis1)}, {"a", "b"}};
}

template <typename Rotation>
JointTraits translation_then(std::string_view type, const Rotation& rotation_joint) {
  JointTraits out = traits(TranslationalJoint{});
  const JointTraits turn = traits(rotation_joint);
  out.type = type;
  out.motions.insert(out.motions.end(), turn.motions.begin(), turn.motions.end());
  out.coordinates.insert(out.coordinates.end(), turn.coordinates.begin(), turn.coordinates.end());
  return out;
}
JointTraits traits(const Free3dEulerJoint&) {
  return translation_then("free3d-euler", SphericalEulerJoint{});
}
JointTraits traits(const Free3dExpJoint&) {
  return translation_then("free3d-exp", SphericalExpJoint{});
}

JointTraits traits_of(const JointKind& kind) {
  return std::visit([](const auto& joint) { return traits(joint); }, kind);
}

}  // namespace

Motions elementary_motions(const JointKind& kind) { return traits_of(kind).motions; }

int motion_dof(MotionKind kind) {
  switch (kind) {
    case MotionKind::kFixed:
      return 0;
    case MotionKind::kRotation:
    case MotionKind::kTranslation:
      return 1;
    case MotionKind::kExponential:
      return 3;
  }
  return 0;
}

int joint_dof(const JointKind& kind) { return static_cast<int>(coordinate_names(kind).size()); }

std::string_view joint_type(const JointKind& kind) { return traits_of(kind).type; }

std::vector<std::string> coordinate_names(const JointKind& kind) {
  return traits_of(kind).coordinates;
}

bool is_angle(const JointKind& kind, int i) {
  int first = 0;
  for (const ElementaryMotion& motion : elementary_motions(kind)) {
    first += motion_dof(motion.kind);
    if (i < first) {
      return motion.kind != MotionKind::kTranslation;
    }
  }
  return false;
}

}  // namespace hbar
