#include <algorithm>
#include <unordered_map>

#include "hbar/core/nearest_name.h"
#include "hbar/scene/read_elements.h"

namespace hbar::scene {
namespace {

/// Names of one kind, with where each was declared.
template <typename T>
class Names {
 public:
  /// @throws InvalidInput if the name is taken
  void declare(const std::string& name, const T& what, std::string_view element,
               const ReadContext& context) {
    const auto [place, is_new] = by_name_.emplace(name, &what);
    if (is_new) return;
    throw InvalidInput(attribute_place(context, what.line.number, element, "name", name) +
                       concat("the ", element, " of line ", place->second->line.number,
                              " has this name; names of ", plural(element), " must differ"));
  }

  /// @throws InvalidInput if there is no such name
  const T& find(const std::string& name, int line, std::string_view element,
                std::string_view attribute, std::string_view kind,
                const ReadContext& context) const {
    const auto place = by_name_.find(name);
    if (place != by_name_.end()) return *place->second;
    std::vector<std::string> names;
    for (const auto& [known, what] : by_name_) names.push_back(known);
    std::sort(names.begin(), names.end());
    throw InvalidInput(attribute_place(context, line, element, attribute, name) +
                       concat("no ", kind, " has this name; ") + unknown_name_hint(name, names));
  }

 private:
  static std::string plural(std::string_view element) {
    return element == "body" ? "bodies" : std::string(element) + "s";
  }
  std::unordered_map<std::string, const T*> by_name_;
};

void check_motors(const Description& description, const Names<Joint>& joints,
                  const ReadContext& context) {
  std::unordered_map<std::string, int> driven;
  for (const Motor& motor : description.motors) {
    const int line = motor.line.number;
    const Joint& joint = joints.find(motor.joint, line, "motor", "joint", "joint", context);
    const std::string place = attribute_place(context, line, "motor", "joint", motor.joint);
    if (joint.type == JointType::kFixed) {
      throw InvalidInput(place + "this joint is fixed; motors drive joints that move");
    }
    const auto [other, is_new] = driven.emplace(motor.joint, line);
    if (!is_new) {
      throw InvalidInput(place + concat("the motor of line ", other->second,
                                        " drives this joint; a joint has at most one motor"));
    }
  }
}

void check_contacts(const Description& description, const Names<Body>& bodies,
                    const ReadContext& context) {
  for (const Contact& contact : description.contacts) {
    const int line = contact.line.number;
    if (contact.kind == ContactKind::kGround) {
      bodies.find(contact.body_a, line, "ground_contact", "body", "body", context);
      continue;
    }
    const bool cuboids = contact.kind == ContactKind::kCuboidCuboid;
    const char* const element = cuboids ? "cuboid_cuboid_contact" : "general_primitive_contact";
    const char* const first = cuboids ? "body_a" : "general_body";
    const char* const second = cuboids ? "body_b" : "primitive_body";
    const Body& a = bodies.find(contact.body_a, line, element, first, "body", context);
    const Body& b = bodies.find(contact.body_b, line, element, second, "body", context);
    const std::string place = attribute_place(context, line, element, second, contact.body_b);
    if (&a == &b) throw InvalidInput(place + "a body does not touch itself; name two bodies");
    for (const Body* body : {&a, &b}) {
      if (cuboids && !std::holds_alternative<CuboidBody>(body->shape)) {
        throw InvalidInput(
            attribute_place(context, line, element, body == &a ? first : second, body->name) +
            "this body is not a cuboid; both must be");
      }
    }
  }
}

}  // namespace

void check_references(const Description& description, const ReadContext& context) {
  Names<Link> links;
  Names<Joint> joints;
  Names<Body> bodies;
  for (const Robot& robot : description.robots) {
    for (const Link& link : robot.links) {
      links.declare(link.name, link, "link", context);
      joints.declare(link.joint.name, link.joint, "joint", context);
      bodies.declare(link.body.name, link.body, "body", context);
    }
  }
  check_motors(description, joints, context);
  check_contacts(description, bodies, context);
  for (const EndEffector& point : description.end_effectors) {
    joints.find(point.joint, point.line.number, "endeffector", "joint", "joint", context);
  }
  Names<TactileSensor> sensors;
  for (const TactileSensor& sensor : description.tactile_sensors) {
    bodies.find(sensor.body, sensor.line.number, "tactile", "body", "body", context);
    sensors.declare(sensor.name, sensor, "tactile", context);
  }
}

}  // namespace hbar::scene
