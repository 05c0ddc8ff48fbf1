#include "hbar/scene/build_model.h"

#include <Eigen/Geometry>
#include <unordered_map>
#include <utility>

#include "hbar/core/error.h"
#include "hbar/core/mesh.h"
#include "hbar/core/model_builder.h"
#include "hbar/scene/principal_axes.h"
#include "hbar/scene/read_obj.h"
#include "hbar/scene/xml_element.h"

namespace hbar::scene {
namespace {

using Pose = RigidTransform<double>;

Eigen::Vector3d vector(const Vec3& v) { return {v[0], v[1], v[2]}; }

Pose pose(const Vec3& pos, const Quat& quat) {
  const Eigen::Quaterniond rotation(quat[0], quat[1], quat[2], quat[3]);
  return {rotation.toRotationMatrix(), vector(pos)};
}

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
  if (joint.frame == Frame::kWorld) made.X_PJ = inverse(X_WP) * made.X_PJ;
  made.damping = joint.damping;
  made.stiffness = joint.stiffness;
  made.rest = Eigen::Map<const Eigen::VectorXd>(joint.rest.data(),
                                                static_cast<Eigen::Index>(joint.rest.size()));
  if (joint.lim && joint.type != JointType::kFixed) {
    made.limits = JointLimits{(*joint.lim)[0], (*joint.lim)[1], joint.lim_stiffness};
  }
  return made;
}

/// Makes the bodies of a scene; opens the files they name.
class BodyMaker {
 public:
  explicit BodyMaker(const Scene& scene) : scene_(scene) {}

  [[nodiscard]] hbar::Body make(const Body& body, const Pose& X_WJ) const {
    return std::visit([&](const auto& shape) { return make(body, shape, X_WJ); }, body.shape);
  }

 private:
  static hbar::Body make(const Body& body, const CuboidBody& shape, const Pose&) {
    return solid(body, Cuboid{vector(shape.size)});
  }
  static hbar::Body make(const Body& body, const SphereBody& shape, const Pose&) {
    return solid(body, Sphere{shape.radius});
  }
  static hbar::Body make(const Body& body, const CylinderBody& shape, const Pose&) {
    return solid(body, Cylinder{shape.radius, shape.length});
  }
  static hbar::Body make(const Body& body, const CapsuleBody& shape, const Pose&) {
    return solid(body, Capsule{shape.radius, shape.length});
  }
  static hbar::Body solid(const Body& body, const Shape& shape) {
    return solid_body(body.name, shape, body.density, pose(body.pos, body.quat));
  }

  static hbar::Body make(const Body& body, const AbstractBody& shape, const Pose&) {
    hbar::Body made{body.name, pose(body.pos, body.quat), shape.mass, {}, NoShape{}};
    if (shape.inertia.size() == 3) {
      made.inertia = Eigen::Vector3d(shape.inertia[0], shape.inertia[1], shape.inertia[2]);
      return made;
    }
    const PrincipalAxes principal = principal_axes(symmetric_matrix(shape.inertia));
    made.inertia = principal.moments;
    made.X_JB.R = made.X_JB.R * principal.axes;
    return made;
  }

  [[nodiscard]] hbar::Body make(const Body& body, const MeshBody& shape, const Pose& X_WJ) const {
    const SolidMoments moments = mesh_moments(body, shape);
    const PrincipalAxes principal = principal_axes(moments.inertia);
    const Pose X_OB = {principal.axes, moments.centre};  // in the OBJ's frame
    Pose X_JB = pose(body.pos, body.quat);
    if (shape.transform_type == MeshTransform::kObjToJoint) X_JB = X_JB * X_OB;
    if (shape.transform_type == MeshTransform::kObjToWorld) X_JB = inverse(X_WJ) * X_JB * X_OB;
    return {body.name, X_JB, body.density * moments.volume, body.density * principal.moments,
            NoShape{}};
  }

  [[nodiscard]] SolidMoments mesh_moments(const Body& body, const MeshBody& shape) const {
    const std::string place = attribute_place({scene_.file, {}, {}}, body.line.number, "body",
                                              "filename", shape.filename);
    try {
      TriangleMesh mesh = read_obj(scene_.folder / shape.filename);
      for (Eigen::Vector3d& point : mesh.vertices) {
        point = point.cwiseProduct(vector(shape.scale));
      }
      if (!is_closed(mesh)) mesh = merge_equal_vertices(mesh);
      check_solid(mesh);
      return solid_moments(mesh);
    } catch (const IoError& error) {
      throw IoError(place + error.what());
    } catch (const InvalidInput& error) {
      throw InvalidInput(place + error.what());
    }
  }

  const Scene& scene_;
};

/// Adds the links of one robot; remembers which link carries which joint.
void add_robot(const Scene& scene, const Robot& robot, ModelBuilder& builder,
               std::unordered_map<std::string, int>& link_of_joint) {
  const BodyMaker bodies(scene);
  std::vector<Pose> X_W;  // rest pose of each joint frame in the world
  std::vector<int> index;
  for (const Link& link : robot.links) {
    const auto parent = static_cast<std::size_t>(link.parent);
    if (link.parent >= static_cast<int>(index.size())) {
      throw InvalidInput(concat("link '", link.name, "': its parent must come before it"));
    }
    const Pose X_WP = link.parent < 0 ? Pose{} : X_W[parent];
    hbar::Joint joint = make_joint(link.joint, X_WP);
    X_W.push_back(X_WP * joint.X_PJ);
    hbar::Body body = bodies.make(link.body, X_W.back());
    try {
      index.push_back(builder.add_link(link.parent < 0 ? -1 : index[parent], std::move(joint),
                                       std::move(body), link.name,
                                       static_cast<unsigned>(link.design_params)));
    } catch (const InvalidInput& error) {
      throw InvalidInput(
          attribute_place({scene.file, {}, {}}, link.line.number, "link", "name", link.name) +
          error.what());
    }
    link_of_joint.emplace(link.joint.name, index.back());
  }
}

int link_of(const std::unordered_map<std::string, int>& link_of_joint, const std::string& joint) {
  const auto place = link_of_joint.find(joint);
  if (place == link_of_joint.end()) throw InvalidInput(concat("no joint is named '", joint, "'"));
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

Model build_model(const Scene& scene) {
  const Description& description = scene.description;
  const bool metres = description.options.unit == UnitSystem::kMKg;
  ModelBuilder builder(description.model, metres ? Units::kMetreKilogram : Units::kCentimetreGram);
  builder.set_gravity(vector(description.options.gravity));
  std::unordered_map<std::string, int> link_of_joint;
  for (const Robot& robot : description.robots) {
    add_robot(scene, robot, builder, link_of_joint);
  }
  for (const Motor& motor : description.motors) {
    builder.add_motor(make_motor(motor, link_of(link_of_joint, motor.joint)));
  }
  for (const EndEffector& point : description.end_effectors) {
    builder.add_end_effector(
        {point.name.value_or(""), link_of(link_of_joint, point.joint), vector(point.pos)});
  }
  return builder.build();
}

}  // namespace hbar::scene
