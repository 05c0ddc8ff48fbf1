#include <Eigen/Geometry>
#include <cmath>

#include "hbar/core/base/unit_vector.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/scene/read_elements.h"

namespace hbar::scene {
namespace {

/// How far the corners of a sensor's rectangle may be out of the plane of its axes, relative to
/// their distance.
constexpr double kOutOfPlane = 1e-6;
/// Sine of the angle below which two axes count as parallel.
constexpr double kLeastSine = 1e-9;

Eigen::Vector3d vector(const Vec3& v) { return {v[0], v[1], v[2]}; }

RectArray read_rect_array(const XmlElement& element) {
  const RectArray points{element.numbers<3>("rect_pos0"), element.numbers<3>("rect_pos1"),
                         element.numbers<3>("axis0"), element.numbers<3>("axis1"),
                         element.integers<2>("resolution")};
  const double count = static_cast<double>(points.resolution[0]) * points.resolution[1];
  if (count > kMaxContactPoints) {
    element.fail("resolution", concat("that makes ", count, " points"),
                 concat("a sensor has at most ", kMaxContactPoints));
  }
  const Eigen::Vector3d normal =
      unit_vector(vector(points.axis0)).cross(unit_vector(vector(points.axis1)));
  if (normal.norm() < kLeastSine) {
    element.fail("axis1", "parallel to axis0", "the two axes must not be parallel");
  }
  const Eigen::Vector3d diagonal = vector(points.rect_pos1) - vector(points.rect_pos0);
  if (std::abs(diagonal.dot(normal)) > kOutOfPlane * diagonal.norm() * normal.norm()) {
    element.fail("rect_pos1", "the axes do not reach from rect_pos0 to here",
                 "rect_pos1 - rect_pos0 is a combination of axis0 and axis1");
  }
  return points;
}

ContactKind contact_kind(std::string_view name) {
  if (name == contact_element(ContactKind::kGround)) {
    return ContactKind::kGround;
  }
  return name == contact_element(ContactKind::kGeneralPrimitive) ? ContactKind::kGeneralPrimitive
                                                                 : ContactKind::kCuboidCuboid;
}

}  // namespace

Options read_options(const XmlElement& element) {
  Options options;
  if (element.has("integrator")) {
    const std::string method = element.text("integrator");
    if (method == "rk4" || method == "RK4" || method == "euler" || method == "Euler") {
      element.fail("integrator", "explicit integrators are not supported");
    }
  }
  options.integrator = static_cast<Integrator>(element.choice("integrator"));
  options.timestep = element.number("timestep");
  options.gravity = element.numbers<3>("gravity");
  options.unit = static_cast<UnitSystem>(element.choice("unit"));
  if (options.unit == UnitSystem::kMKg && !element.has("gravity")) {
    element.context().notice(element.line(),
                             "<option unit=\"m-kg\">: gravity is not given, so it is 0 0 -980 "
                             "metres per second squared");
  }
  return options;
}

SolverOptions read_solver_options(const XmlElement& element) {
  return {element.number("tol"), element.optional_number("rtol"), element.integer("max_iter"),
          element.integer("max_ls"),
          choice_name("solver_option", "linear_solver", element.choice("linear_solver"))};
}

Ground read_ground(const XmlElement& element) {
  return {element.numbers<3>("pos"), element.numbers<3>("normal"), {element.line()}};
}

Motor read_motor(XmlElement element) {
  Motor motor;
  motor.line = {element.line()};
  motor.joint = element.text("joint");
  motor.ctrl = static_cast<Control>(element.read_type("ctrl"));
  motor.ctrl_range = element.optional_numbers<2>("ctrl_range");
  if (motor.ctrl == Control::kPosition) {
    motor.P = element.number("P");
    motor.D = element.number("D");
    motor.implicit = element.flag("implicit");
  }
  return motor;
}

Contact read_contact(XmlElement element) {
  Contact contact;
  contact.line = {element.line()};
  contact.kind = contact_kind(element.name());
  switch (contact.kind) {
    case ContactKind::kGround:
      contact.body_a = element.text("body");
      break;
    case ContactKind::kGeneralPrimitive:
      contact.body_a = element.text("general_body");
      contact.body_b = element.text("primitive_body");
      contact.caps = element.flag("caps");
      break;
    case ContactKind::kCuboidCuboid:
      contact.body_a = element.text("body_a");
      contact.body_b = element.text("body_b");
      break;
  }
  contact.name = element.optional_text("name");
  contact.kn = element.number("kn");
  contact.kt = element.number("kt");
  contact.mu = element.number("mu");
  contact.damping = element.number("damping");
  contact.render = element.optional_flag("render");
  contact.law = static_cast<ContactLaw>(element.choice("law"));
  contact.friction = static_cast<Friction>(element.read_type("friction"));
  if (contact.friction == Friction::kSmooth) {
    contact.friction_width = element.number("friction_width");
  }
  contact.adhesion = element.flag("adhesion");
  if (element.applies("reaction")) {
    contact.reaction = static_cast<Reaction>(element.choice("reaction"));
  }
  return contact;
}

EndEffector read_end_effector(const XmlElement& element) {
  return {element.text("joint"),
          element.numbers<3>("pos"),
          element.optional_number("radius"),
          element.optional_text("name"),
          element.optional_numbers<4>("rgba"),
          {element.line()}};
}

TactileSensor read_tactile(XmlElement element) {
  TactileSensor sensor;
  sensor.line = {element.line()};
  sensor.body = element.text("body");
  sensor.name = element.optional_text("name").value_or(sensor.body);
  if (element.read_type("type") == 0) {
    sensor.points = read_rect_array(element);
  } else {
    sensor.points =
        PointList{element.text("spec"), element.numbers<3>("pos"), element.quaternion("quat")};
  }
  sensor.kn = element.number("kn");
  sensor.kt = element.number("kt");
  sensor.mu = element.number("mu");
  sensor.damping = element.number("damping");
  sensor.render = element.optional_flag("render");
  return sensor;
}

VirtualShape read_virtual_shape(const XmlElement& element) {
  VirtualShape shape;
  shape.name = element.optional_text("name");
  shape.pos = element.numbers<3>("pos");
  shape.rgba = element.optional_numbers<4>("rgba");
  if (element.name() == "sphere") {
    shape.shape = VirtualSphere{element.number("radius")};
  } else {
    shape.shape = VirtualCuboid{element.numbers<3>("size"), element.quaternion("quat")};
  }
  return shape;
}

}  // namespace hbar::scene
