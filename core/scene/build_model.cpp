#include "hbar/core/scene/build_model.h"

#include <unordered_map>
#include <utility>

#include "hbar/core/base/error.h"
#include "hbar/core/base/stop_flag.h"
#include "hbar/core/model/model_builder.h"
#include "hbar/core/scene/build_bodies.h"
#include "hbar/core/scene/build_contacts.h"
#include "hbar/core/scene/build_tactile.h"
#include "hbar/core/scene/xml_element.h"

namespace hbar::scene {
namespace {

using Pose = RigidTransform<double>;

JointKind joint_kind(const Joint& joint) {
  // Axes of a WORLD joint are given in world axes; the joint frame's are R in them.
  const Eigen::Matrix3d R_JA = joint.frame == Frame::kWorld
                                   ? Eigen::Matrix3d(pose(joint.pos, joint.quat).R.transpose())
                                   : Eigen::Matrix3d::Identity();
  const auto axis = [&R_JA](const std::optional<Vec3>& given) {
    return Eigen::Vector3d(R_JA * vector(given.value_or(Vec3{})));
  };
  switch (joint.type) {
    case JointType::kFixed:
      return FixedJoint{};
    case JointType::kRevolute:
      return RevoluteJoint{axis(joint.axis)};
    case JointType::kPrismatic:
      return PrismaticJoint{axis(joint.axis)};
    case JointType::kPlanar:
      return PlanarJoint{axis(joint.axis0), axis(joint.axis1)};
    case JointType::kTranslational:
      return TranslationalJoint{};
    case JointType::kFree2d:
      return Free2dJoint{};
    case JointType::kSphericalEuler:
      return SphericalEulerJoint{};
    case JointType::kSphericalExp:
      return SphericalExpJoint{};
    case JointType::kFree3dEuler:
      return Free3dEulerJoint{};
    case JointType::kFree3dExp:
      return Free3dExpJoint{};
    case JointType::kUniversal:
      return UniversalJoint{axis(joint.axis0), axis(joint.axis1)};
  }
  throw InvalidInput(concat("joint '", joint.name, "': unknown type"));
}

hbar::Joint make_joint(const Joint& joint, const Pose& X_WP) {
  hbar::Joint made;
  made.name = joint.name;
  made.kind = joint_kind(joint);
  made.X_PJ = pose(joint.pos, joint.quat);
  if (joint.frame == Frame::kWorld) {
    made.X_PJ = inverse(X_WP) * made.X_PJ;
  }
  made.damping = joint.damping;
  made.stiffness = joint.stiffness;
  made.rest = Eigen::Map<const Eigen::VectorXd>(joint.rest.data(),
                                                static_cast<Eigen::Index>(joint.rest.size()));
  if (joint.lim && joint.type != JointType::kFixed) {
    made.limits = JointLimits{(*joint.lim)[0], (*joint.lim)[1], joint.lim_stiffness};
  }
  return made;
}

/// Adds the links of one robot; remembers which link carries which joint and which body.
void add_robot(const Scene& scene, const Robot& robot, const std::atomic<bool>* stop,
               ModelBuilder& builder, std::unordered_map<std::string, int>& link_of_joint,
               BuiltBodies& bodies) {
  std::vector<Pose> X_W;  // rest pose of each joint frame in the world
  std::vector<int> index;
  for (const Link& link : robot.links) {
    require_running(stop, scene.file, ": loading interrupted at link '", link.name, "'");
    const auto parent = static_cast<std::size_t>(link.parent);
    if (link.parent >= static_cast<int>(index.size())) {
      throw InvalidInput(concat("link '", link.name, "': its parent must come before it"));
    }
    const Pose X_WP = link.parent < 0 ? Pose{} : X_W[parent];
    hbar::Joint joint = make_joint(link.joint, X_WP);
    X_W.push_back(X_WP * joint.X_PJ);
    bodies.of_link.push_back(build_body(scene, link.body, X_W.back()));
    with_place(
        attribute_place({scene.file, {}, {}}, link.line.number, "link", "name", link.name), [&] {
          index.push_back(builder.add_link(link.parent < 0 ? -1 : index[parent], std::move(joint),
                                           std::move(bodies.of_link.back().body), link.name,
                                           static_cast<unsigned>(link.design_params)));
        });
    link_of_joint.emplace(link.joint.name, index.back());
    bodies.link_of.emplace(link.body.name, index.back());
  }
}

int link_of(const std::unordered_map<std::string, int>& link_of_joint, const std::string& joint) {
  const auto place = link_of_joint.find(joint);
  if (place == link_of_joint.end()) {
    throw InvalidInput(concat("no joint is named '", joint, "'"));
  }
  return place->second;
}

hbar::Motor make_motor(const Motor& motor, int link) {
  hbar::Motor made;
  made.link = link;
  if (motor.ctrl_range) {
    made.lower = (*motor.ctrl_range)[0];
    made.upper = (*motor.ctrl_range)[1];
  }
  if (motor.ctrl == Control::kPosition) {
    made.kind = hbar::Motor::Kind::kPosition;
    made.P = motor.P.value_or(0.0);
    made.D = motor.D;
    made.implicit = motor.implicit;
  }
  return made;
}

}  // namespace

Model build_model(const Scene& scene, std::vector<std::string>* notices,
                  const std::atomic<bool>* stop) {
  const Description& description = scene.description;
  const bool metres = description.options.unit == UnitSystem::kMKg;
  ModelBuilder builder(description.model, metres ? Units::kMetreKilogram : Units::kCentimetreGram);
  builder.set_gravity(vector(description.options.gravity));
  std::unordered_map<std::string, int> link_of_joint;
  BuiltBodies bodies;
  for (const Robot& robot : description.robots) {
    add_robot(scene, robot, stop, builder, link_of_joint, bodies);
  }
  for (const Motor& motor : description.motors) {
    builder.add_motor(make_motor(motor, link_of(link_of_joint, motor.joint)));
  }
  for (const EndEffector& point : description.end_effectors) {
    builder.add_end_effector(
        {point.name.value_or(""), link_of(link_of_joint, point.joint), vector(point.pos)});
  }
  add_contacts(scene, bodies, builder, stop);
  add_tactile_sensors(scene, bodies, builder);
  for (const BuiltBody& body : bodies.of_link) {
    if (notices != nullptr) {
      notices->insert(notices->end(), body.notices.begin(), body.notices.end());
    }
  }
  return std::move(builder).build();
}

}  // namespace hbar::scene
