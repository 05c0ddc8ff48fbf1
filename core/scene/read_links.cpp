#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <unordered_map>

#include "hbar/core/base/error.h"
#include "hbar/core/base/unit_vector.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/moments.h"
#include "hbar/core/scene/principal_axes.h"
#include "hbar/core/scene/read_elements.h"

namespace hbar::scene {
namespace {

/// Sine of the angle below which two axes count as parallel.
constexpr double kParallel = 1e-9;

JointType joint_type(std::size_t choice) {
  constexpr std::size_t kSpherical = 11;  // the two short spellings follow the canonical ones
  constexpr std::size_t kFree3d = 12;
  if (choice == kSpherical) {
    return JointType::kSphericalEuler;
  }
  if (choice == kFree3d) {
    return JointType::kFree3dEuler;
  }
  return static_cast<JointType>(choice);
}

Eigen::Vector3d direction(const Vec3& v) { return unit_vector({v[0], v[1], v[2]}); }

void check_limits(const XmlElement& element, const Joint& joint) {
  if (!joint.lim || joint.type == JointType::kFixed) {
    return;
  }
  if ((*joint.lim)[0] <= 0.0 && (*joint.lim)[1] >= 0.0) {
    return;
  }
  const std::string name = joint.name.empty() ? "" : concat(" name=\"", joint.name, "\"");
  element.context().notice(
      element.line(),
      concat("<joint", name, ">: the limits exclude the start configuration 0; ",
             joint.lim_stiffness > 0.0 ? "their spring pulls it" : "give a start inside them"));
}

/// Damping by default is meant for a robot's joints; it reaches what flies and falls, too.
void notice_default_damping(const XmlElement& element, const Joint& joint) {
  const bool is_free = joint.type == JointType::kFree2d || joint.type == JointType::kFree3dEuler ||
                       joint.type == JointType::kFree3dExp;
  if (is_free && joint.damping > 0.0 && element.is_by_default("damping")) {
    element.context().notice(
        element.line(), concat("<joint", joint.name.empty() ? "" : " name=\"" + joint.name + '"',
                               ">: the default damping ", joint.damping,
                               " slows this free body, too; damping=\"0\" leaves it free"));
  }
}

/// Refuses more contact points than a body may have.
void limit_points(const XmlElement& element, std::string_view attribute, const Shape& kind,
                  const SurfaceResolution& resolution) {
  const double count = surface_point_count(kind, resolution);
  if (count > kMaxContactPoints) {
    element.fail(attribute, concat("that makes ", count, " contact points"),
                 concat("a body has at most ", kMaxContactPoints));
  }
}

CuboidBody read_cuboid(const XmlElement& element) {
  CuboidBody body{element.numbers<3>("size"), element.integers<3>("general_contact_resolution")};
  limit_points(element, "general_contact_resolution", Cuboid(),
               {.cuboid = body.general_contact_resolution});
  return body;
}

SphereBody read_sphere(const XmlElement& element) {
  SphereBody body{element.number("radius"), {}};
  if (element.has("general_contact_resolution")) {
    body.general_contact_resolution = element.integers<2>("general_contact_resolution");
    limit_points(element, "general_contact_resolution", Sphere(),
                 {.sphere = *body.general_contact_resolution});
  }
  return body;
}

CylinderBody read_cylinder(const XmlElement& element) {
  CylinderBody body{element.number("radius"), element.number("length"),
                    element.integer("general_contact_angle_resolution"),
                    element.integer("general_contact_radius_resolution")};
  limit_points(element, "general_contact_angle_resolution", Cylinder(),
               {.cylinder = {body.general_contact_angle_resolution,
                             body.general_contact_radius_resolution}});
  return body;
}

CapsuleBody read_capsule(const XmlElement& element) {
  CapsuleBody body{element.number("radius"), element.number("length"),
                   element.integers<2>("general_contact_resolution")};
  limit_points(element, "general_contact_resolution", Capsule(),
               {.capsule = body.general_contact_resolution});
  return body;
}

MeshBody read_mesh(const XmlElement& element) {
  return {element.text("filename"),
          element.numbers<3>("scale"),
          static_cast<MeshTransform>(element.choice("transform_type")),
          element.optional_text("contacts"),
          element.integer("contact_count"),
          element.integer("distance_cells")};
}

void check_inertia(const XmlElement& element, const std::vector<double>& inertia) {
  const bool full = inertia.size() == 6;
  const Eigen::Vector3d moments = full ? principal_axes(symmetric_matrix(inertia)).moments
                                       : Eigen::Vector3d(inertia[0], inertia[1], inertia[2]);
  const std::string hint = concat(full ? "the principal moments" : "principal moments",
                                  " are > 0 and none is above the sum of the other two");
  if (!(moments.minCoeff() > 0.0)) {
    element.fail("inertia", "a moment is not positive", hint);
  }
  const double excess = excess_of_moments(moments);
  const std::string reason =
      concat("one moment is above the sum of the other two, by ", excess, " of it");
  if (excess > kRoundedMoments) {
    element.fail("inertia", reason, hint);
  }
  if (excess > 0.0) {
    element.context().notice(element.line(),
                             concat("<body>: inertia: ", reason, ": taken as rounded"));
  }
}

AbstractBody read_abstract(const XmlElement& element) {
  AbstractBody body;
  body.mass = element.number("mass");
  body.inertia = element.list("inertia");
  check_inertia(element, body.inertia);
  body.mesh = element.optional_text("mesh");
  body.contacts = element.optional_text("contacts");
  body.scale = element.numbers<3>("scale");
  return body;
}

BodyShape read_shape(const XmlElement& element, std::size_t type) {
  switch (type) {
    case 0:
      return read_cuboid(element);
    case 1:
      return read_sphere(element);
    case 2:
      return read_cylinder(element);
    case 3:
      return read_capsule(element);
    case 4:
      return read_mesh(element);
    default:
      return read_abstract(element);
  }
}

void read_body_children(const XmlElement& element, Body& body) {
  for (const tinyxml2::XMLElement* xml : checked_children(element.xml(), element.context())) {
    const XmlElement child(*xml, element.context());
    auto* const abstract = std::get_if<AbstractBody>(&body.shape);
    if (abstract == nullptr) {
      child.fail("stands in a body that is not abstract; only those have it");
    }
    if (child.name() == "visual") {
      abstract->visual =
          Visual{child.text("mesh"), child.numbers<3>("pos"), child.quaternion("quat")};
    } else {
      abstract->collision = Collision{child.text("contacts"),
                                      child.numbers<3>("pos"),
                                      child.quaternion("quat"),
                                      {child.line()}};
    }
  }
}

/// Reads the links of one robot, nested and flat, in file order.
class RobotReader {
 public:
  explicit RobotReader(ReadContext& context) : context_(context) {}

  void read_link(const tinyxml2::XMLElement& xml, int enclosing) {
    const XmlElement element(xml, context_);
    const std::size_t index = robot_.links.size();
    robot_.links.emplace_back();
    Link link;
    link.line = {element.line()};
    link.parent = parent_of(element, enclosing);
    link.design_params = element.integer("design_params");
    std::vector<const tinyxml2::XMLElement*> nested;
    bool has_joint = false;
    bool has_body = false;
    for (const tinyxml2::XMLElement* child : checked_children(xml, context_)) {
      const std::string_view name = child->Name();
      if (name == "joint") {
        link.joint = read_joint(XmlElement(*child, context_));
        has_joint = true;
      } else if (name == "body") {
        link.body = read_body(XmlElement(*child, context_));
        has_body = true;
      } else {
        nested.push_back(child);
      }
    }
    if (!has_joint || !has_body) {
      element.fail(concat("has no <", has_joint ? "body" : "joint",
                          ">; a link has one <joint> and one <body>"));
    }
    name_link(element, link);
    by_name_.emplace(link.name, static_cast<int>(index));
    robot_.links[index] = std::move(link);
    for (const tinyxml2::XMLElement* child : nested) {
      read_link(*child, static_cast<int>(index));
    }
  }

  [[nodiscard]] Robot take() { return std::move(robot_); }

 private:
  int parent_of(const XmlElement& element, int enclosing) const {
    if (!element.has("parent")) {
      return enclosing;
    }
    if (enclosing >= 0) {
      element.fail("parent", "this link is nested", "only links written under <robot> have parent");
    }
    const std::string name = element.text("parent");
    const auto parent = by_name_.find(name);
    if (parent != by_name_.end()) {
      return parent->second;
    }
    element.fail("parent", "no link of this name comes before in this robot",
                 "parent names an earlier link of the same robot");
  }

  static void name_link(const XmlElement& element, Link& link) {
    std::string& name = link.name;
    if (element.has("name")) {
      name = element.text("name");
    }
    if (name.empty()) {
      name = link.body.name.empty() ? link.joint.name : link.body.name;
    }
    if (name.empty()) {
      element.fail("attribute name is missing; name the link, its joint or its body");
    }
    if (link.joint.name.empty()) {
      link.joint.name = name;
    }
    if (link.body.name.empty()) {
      link.body.name = name;
    }
  }

  ReadContext& context_;
  Robot robot_;
  std::unordered_map<std::string, int> by_name_;
};

}  // namespace

Joint read_joint(XmlElement element) {
  Joint joint;
  joint.line = {element.line()};
  joint.type = joint_type(element.read_type("type"));
  joint.name = element.optional_text("name").value_or("");
  joint.frame = static_cast<Frame>(element.choice("frame"));
  joint.pos = element.numbers<3>("pos");
  joint.quat = element.quaternion("quat");
  if (element.applies("axis")) {
    joint.axis = element.numbers<3>("axis");
  }
  if (element.applies("axis0")) {
    joint.axis0 = element.numbers<3>("axis0");
    joint.axis1 = element.numbers<3>("axis1");
    const double sine = direction(*joint.axis0).cross(direction(*joint.axis1)).norm();
    if (sine < kParallel) {
      element.fail("axis1", "parallel to axis0", "the two axes must not be parallel");
    }
  }
  joint.damping = element.number("damping");
  notice_default_damping(element, joint);
  joint.stiffness = element.number("stiffness");
  const auto dof = static_cast<std::size_t>(coordinate_count(joint.type));
  joint.rest.assign(dof, 0.0);
  if (element.has("rest") && dof > 0) {
    joint.rest = element.list("rest", dof);
  }
  joint.lim = element.optional_numbers<2>("lim");
  joint.lim_stiffness = element.number("lim_stiffness");
  check_limits(element, joint);
  return joint;
}

Body read_body(XmlElement element) {
  Body body;
  body.line = {element.line()};
  const std::size_t type = element.read_type("type");
  body.name = element.optional_text("name").value_or("");
  body.shape = read_shape(element, type);
  body.pos = element.numbers<3>("pos");
  body.quat = element.quaternion("quat");
  if (element.applies("density")) {
    body.density = element.number("density");
  }
  body.rgba = element.optional_numbers<4>("rgba");
  body.texture = element.optional_text("texture");
  read_body_children(element, body);
  return body;
}

Robot read_robot(const tinyxml2::XMLElement& robot, ReadContext& context) {
  const XmlElement checked(robot, context);
  RobotReader reader(context);
  for (const tinyxml2::XMLElement* link : checked_children(robot, context)) {
    reader.read_link(*link, -1);
  }
  return reader.take();
}

}  // namespace hbar::scene
