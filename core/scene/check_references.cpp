#include <algorithm>
#include <unordered_map>

#include "hbar/core/base/nearest_name.h"
#include "hbar/core/scene/read_elements.h"

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
    if (is_new) {
      return;
    }
    throw InvalidInput(attribute_place(context, what.line.number, element, "name", name) +
                       concat("the ", element, " of line ", place->second->line.number,
                              " has this name; names of ", plural(element), " must differ"));
  }

  /// @throws InvalidInput if there is no such name
  const T& find(const std::string& name, int line, std::string_view element,
                std::string_view attribute, std::string_view kind,
                const ReadContext& context) const {
    const auto place = by_name_.find(name);
    if (place != by_name_.end()) {
      return *place->second;
    }
    std::vector<std::string> names;
    for (const auto& [known, what] : by_name_) {
      names.push_back(known);
    }
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

/// Whether a body can be the one whose points are tested against another; a ball without points
/// touches with its deepest point, which mesh distances do not support.
bool has_contact_points(const Body& body, bool against_mesh) {
  if (const auto* ball = std::get_if<SphereBody>(&body.shape)) {
    return !against_mesh || ball->general_contact_resolution;
  }
  const auto* const abstract = std::get_if<AbstractBody>(&body.shape);
  return abstract == nullptr || abstract->contacts || abstract->collision;
}

/// Which attributes name a contact's bodies.
struct BodyNames {
  const char* first;
  const char* second;
};

BodyNames names_of_bodies(ContactKind kind) {
  if (kind == ContactKind::kGround) {
    return {"body", ""};
  }
  if (kind == ContactKind::kCuboidCuboid) {
    return {"body_a", "body_b"};
  }
  return {"general_body", "primitive_body"};
}

void check_points(const Contact& contact, const Body& body, bool against_mesh,
                  const ReadContext& context) {
  if (has_contact_points(body, against_mesh)) {
    return;
  }
  const bool ball = std::holds_alternative<SphereBody>(body.shape);
  throw InvalidInput(
      attribute_place(context, contact.line.number, contact_element(contact.kind),
                      names_of_bodies(contact.kind).first, body.name) +
      (ball ? "this ball has no contact points, which a mesh needs; give its <body> "
              "general_contact_resolution, or make it the primitive_body"
            : "this abstract body has no contact points; give its <body> contacts or a "
              "<collision>"));
}

void check_pair(const Contact& contact, const Body& a, const Body& b, const ReadContext& context) {
  const auto place = [&](const char* attribute, const Body& body) {
    return attribute_place(context, contact.line.number, contact_element(contact.kind), attribute,
                           body.name);
  };
  const auto [first, second] = names_of_bodies(contact.kind);
  if (&a == &b) {
    throw InvalidInput(place(second, b) + "a body does not touch itself; name two bodies");
  }
  if (contact.kind == ContactKind::kCuboidCuboid) {
    for (const Body* body : {&a, &b}) {
      if (std::holds_alternative<CuboidBody>(body->shape)) {
        continue;
      }
      throw InvalidInput(place(body == &a ? first : second, *body) +
                         "this body is not a cuboid; both must be");
    }
  }
  if (std::holds_alternative<AbstractBody>(b.shape)) {
    throw InvalidInput(place(second, b) +
                       "an abstract body has no distance; primitive_body names a cuboid, sphere, "
                       "cylinder, capsule or mesh");
  }
}

void check_contacts(const Description& description, const Names<Body>& bodies,
                    const ReadContext& context) {
  std::unordered_map<std::string, int> named;
  for (const Contact& contact : description.contacts) {
    const int line = contact.line.number;
    const std::string_view element = contact_element(contact.kind);
    const auto [first, second] = names_of_bodies(contact.kind);
    const Body& a = bodies.find(contact.body_a, line, element, first, "body", context);
    bool against_mesh = false;
    if (contact.kind != ContactKind::kGround) {
      const Body& b = bodies.find(contact.body_b, line, element, second, "body", context);
      check_pair(contact, a, b, context);
      against_mesh = std::holds_alternative<MeshBody>(b.shape);
    }
    check_points(contact, a, against_mesh, context);
    if (!contact.name) {
      continue;
    }
    const auto [other, is_new] = named.emplace(*contact.name, line);
    if (!is_new) {
      throw InvalidInput(attribute_place(context, line, element, "name", *contact.name) +
                         concat("the contact of line ", other->second,
                                " has this name; names of contacts must differ"));
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
