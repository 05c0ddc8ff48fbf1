#include "hbar/core/scene/write_xml.h"

#include <array>
#include <string_view>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/scene/read_xml.h"
#include "hbar/core/scene/vocabulary.h"

namespace hbar::scene {
namespace {

/// Deepest nesting of links; the reader accepts more, and other elements need some.
constexpr int kDeepestNesting = 40;

std::string escaped(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"\n\r\t";
  constexpr std::array kEscapes = {"&amp;", "&lt;", "&gt;", "&quot;", "&#10;", "&#13;", "&#9;"};
  static_assert(kSpecial.size() == kEscapes.size());
  std::string out;
  for (const char c : text) {
    const std::size_t i = kSpecial.find(c);
    if (i == std::string_view::npos) {
      out += c;
    } else {
      out += kEscapes[i];
    }
  }
  return out;
}

/// Writes elements, indented by depth.
class XmlWriter {
 public:
  /// Begins an element; attributes may follow.
  void open(std::string_view element) {
    end_tag();
    indent();
    text_ += concat("<", element);
    open_elements_.emplace_back(element);
    in_tag_ = true;
  }
  void close() {
    const std::string element = open_elements_.back();
    open_elements_.pop_back();
    if (in_tag_) {
      text_ += "/>\n";
      in_tag_ = false;
      return;
    }
    indent();
    text_ += concat("</", element, ">\n");
  }

  void put(std::string_view name, std::string_view value) {
    text_ += concat(" ", name, "=\"", escaped(value), "\"");
  }
  void put(std::string_view name, const std::string& value) { put(name, std::string_view(value)); }
  void put(std::string_view name, const char* value) { put(name, std::string_view(value)); }
  void put(std::string_view name, double value) { put(name, format_number(value)); }
  void put(std::string_view name, int value) { put(name, std::to_string(value)); }
  void put(std::string_view name, bool value) { put(name, value ? "true" : "false"); }
  template <typename T>
  void put(std::string_view name, const std::vector<T>& values) {
    std::string list;
    for (const T& value : values) {
      list += (list.empty() ? "" : " ") + number(value);
    }
    put(name, list);
  }
  template <typename T, std::size_t N>
  void put(std::string_view name, const std::array<T, N>& values) {
    put(name, std::vector<T>(values.begin(), values.end()));
  }
  template <typename T>
  void put(std::string_view name, const std::optional<T>& value) {
    if (value) {
      put(name, *value);
    }
  }
  /// A choice, spelled as the vocabulary does.
  template <typename Enum>
  void put_choice(std::string_view name, Enum value) {
    put(name, choice_name(open_elements_.back(), name, static_cast<std::size_t>(value)));
  }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  static std::string number(double value) { return format_number(value); }
  static std::string number(int value) { return std::to_string(value); }
  void end_tag() {
    if (in_tag_) {
      text_ += ">\n";
    }
    in_tag_ = false;
  }
  void indent() { text_.append(2 * open_elements_.size(), ' '); }

  std::string text_;
  std::vector<std::string> open_elements_;
  bool in_tag_ = false;
};

void write_joint(XmlWriter& out, const Joint& joint) {
  out.open("joint");
  out.put("name", joint.name);
  out.put_choice("type", joint.type);
  out.put_choice("frame", joint.frame);
  out.put("pos", joint.pos);
  out.put("quat", joint.quat);
  out.put("axis", joint.axis);
  out.put("axis0", joint.axis0);
  out.put("axis1", joint.axis1);
  out.put("damping", joint.damping);
  out.put("stiffness", joint.stiffness);
  if (!joint.rest.empty()) {
    out.put("rest", joint.rest);
  }
  out.put("lim", joint.lim);
  out.put("lim_stiffness", joint.lim_stiffness);
  out.close();
}

void write_shape(XmlWriter& out, const CuboidBody& body) {
  out.put("size", body.size);
  out.put("general_contact_resolution", body.general_contact_resolution);
}
void write_shape(XmlWriter& out, const SphereBody& body) {
  out.put("radius", body.radius);
  out.put("general_contact_resolution", body.general_contact_resolution);
}
void write_shape(XmlWriter& out, const CylinderBody& body) {
  out.put("radius", body.radius);
  out.put("length", body.length);
  out.put("general_contact_angle_resolution", body.general_contact_angle_resolution);
  out.put("general_contact_radius_resolution", body.general_contact_radius_resolution);
}
void write_shape(XmlWriter& out, const CapsuleBody& body) {
  out.put("radius", body.radius);
  out.put("length", body.length);
  out.put("general_contact_resolution", body.general_contact_resolution);
}
void write_shape(XmlWriter& out, const MeshBody& body) {
  out.put("filename", body.filename);
  out.put("scale", body.scale);
  out.put_choice("transform_type", body.transform_type);
  out.put("contacts", body.contacts);
  out.put("contact_count", body.contact_count);
  out.put("distance_cells", body.distance_cells);
}
void write_shape(XmlWriter& out, const AbstractBody& body) {
  out.put("mass", body.mass);
  out.put("inertia", body.inertia);
  out.put("mesh", body.mesh);
  out.put("contacts", body.contacts);
  out.put("scale", body.scale);
  if (body.visual) {
    out.open("visual");
    out.put("mesh", body.visual->mesh);
    out.put("pos", body.visual->pos);
    out.put("quat", body.visual->quat);
    out.close();
  }
  if (body.collision) {
    out.open("collision");
    out.put("contacts", body.collision->contacts);
    out.put("pos", body.collision->pos);
    out.put("quat", body.collision->quat);
    out.close();
  }
}

void write_body(XmlWriter& out, const Body& body) {
  out.open("body");
  out.put("name", body.name);
  out.put("type", choice_name("body", "type", body.shape.index()));
  out.put("pos", body.pos);
  out.put("quat", body.quat);
  if (!std::holds_alternative<AbstractBody>(body.shape)) {
    out.put("density", body.density);
  }
  out.put("rgba", body.rgba);
  out.put("texture", body.texture);
  std::visit([&out](const auto& shape) { write_shape(out, shape); }, body.shape);
  out.close();
}

/// Depth of each link, 1 at the root, or nothing if the order is not that of nested links.
std::vector<int> nesting(const Robot& robot) {
  std::vector<int> depth;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const int parent = robot.links[i].parent;
    int ancestor = static_cast<int>(i) - 1;
    while (ancestor >= 0 && ancestor != parent) {
      ancestor = robot.links[static_cast<std::size_t>(ancestor)].parent;
    }
    if (ancestor != parent) {
      return {};
    }
    depth.push_back(parent < 0 ? 1 : depth[static_cast<std::size_t>(parent)] + 1);
    if (depth.back() > kDeepestNesting) {
      return {};
    }
  }
  return depth;
}

void write_robot(XmlWriter& out, const Robot& robot) {
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const int parent = robot.links[i].parent;
    if (parent < -1 || parent >= static_cast<int>(i)) {
      throw InvalidInput(concat("write_scene: link '", robot.links[i].name, "' has parent ", parent,
                                "; a parent is -1 or a link before it"));
    }
  }
  const std::vector<int> depth = nesting(robot);
  out.open("robot");
  int open_links = 0;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Link& link = robot.links[i];
    const int enclosing = depth.empty() ? 0 : depth[i] - 1;
    for (; open_links > enclosing; --open_links) {
      out.close();
    }
    out.open("link");
    out.put("name", link.name);
    if (depth.empty() && link.parent >= 0) {
      out.put("parent", robot.links[static_cast<std::size_t>(link.parent)].name);
    }
    out.put("design_params", link.design_params);
    write_joint(out, link.joint);
    write_body(out, link.body);
    ++open_links;
  }
  for (; open_links > 0; --open_links) {
    out.close();
  }
  out.close();
}

void write_options(XmlWriter& out, const Description& description) {
  out.open("option");
  out.put_choice("integrator", description.options.integrator);
  out.put("timestep", description.options.timestep);
  out.put("gravity", description.options.gravity);
  out.put_choice("unit", description.options.unit);
  out.close();
  out.open("solver_option");
  out.put("tol", description.solver_options.tol);
  out.put("rtol", description.solver_options.rtol);
  out.put("max_iter", description.solver_options.max_iter);
  out.put("max_ls", description.solver_options.max_ls);
  out.put("linear_solver", description.solver_options.linear_solver);
  out.close();
  if (!description.ground) {
    return;
  }
  out.open("ground");
  out.put("pos", description.ground->pos);
  out.put("normal", description.ground->normal);
  out.close();
}

void write_one(XmlWriter& out, const Motor& motor) {
  out.open("motor");
  out.put("joint", motor.joint);
  out.put_choice("ctrl", motor.ctrl);
  out.put("ctrl_range", motor.ctrl_range);
  if (motor.ctrl == Control::kPosition) {
    out.put("P", motor.P);
    out.put("D", motor.D);
    out.put("implicit", motor.implicit);
  }
  out.close();
}

void write_one(XmlWriter& out, const Contact& contact) {
  const bool ground = contact.kind == ContactKind::kGround;
  const bool general = contact.kind == ContactKind::kGeneralPrimitive;
  out.open(contact_element(contact.kind));
  out.put(ground ? "body" : general ? "general_body" : "body_a", contact.body_a);
  if (!ground) {
    out.put(general ? "primitive_body" : "body_b", contact.body_b);
  }
  out.put("name", contact.name);
  out.put("kn", contact.kn);
  out.put("kt", contact.kt);
  out.put("mu", contact.mu);
  out.put("damping", contact.damping);
  out.put("render", contact.render);
  out.put_choice("law", contact.law);
  out.put_choice("friction", contact.friction);
  out.put("friction_width", contact.friction_width);
  out.put("adhesion", contact.adhesion);
  if (!ground) {
    out.put_choice("reaction", contact.reaction);
  }
  if (general) {
    out.put("caps", contact.caps);
  }
  out.close();
}

void write_one(XmlWriter& out, const EndEffector& point) {
  out.open("endeffector");
  out.put("joint", point.joint);
  out.put("pos", point.pos);
  out.put("radius", point.radius);
  out.put("name", point.name);
  out.put("rgba", point.rgba);
  out.close();
}

void write_one(XmlWriter& out, const TactileSensor& sensor) {
  out.open("tactile");
  out.put("body", sensor.body);
  out.put("name", sensor.name);
  out.put_choice("type", sensor.points.index());
  if (const auto* rect = std::get_if<RectArray>(&sensor.points)) {
    out.put("rect_pos0", rect->rect_pos0);
    out.put("rect_pos1", rect->rect_pos1);
    out.put("axis0", rect->axis0);
    out.put("axis1", rect->axis1);
    out.put("resolution", rect->resolution);
  } else if (const auto* list = std::get_if<PointList>(&sensor.points)) {
    out.put("spec", list->spec);
    out.put("pos", list->pos);
    out.put("quat", list->quat);
  }
  out.put("kn", sensor.kn);
  out.put("kt", sensor.kt);
  out.put("mu", sensor.mu);
  out.put("damping", sensor.damping);
  out.put("render", sensor.render);
  out.close();
}

void write_one(XmlWriter& out, const VirtualShape& shape) {
  const auto* const cuboid = std::get_if<VirtualCuboid>(&shape.shape);
  out.open(cuboid ? "cuboid" : "sphere");
  out.put("name", shape.name);
  out.put("pos", shape.pos);
  if (cuboid) {
    out.put("size", cuboid->size);
    out.put("quat", cuboid->quat);
  } else {
    out.put("radius", std::get<VirtualSphere>(shape.shape).radius);
  }
  out.put("rgba", shape.rgba);
  out.close();
}

template <typename T>
void write_all(XmlWriter& out, const char* section, const std::vector<T>& items) {
  if (items.empty()) {
    return;
  }
  out.open(section);
  for (const T& item : items) {
    write_one(out, item);
  }
  out.close();
}

}  // namespace

std::string write_scene_text(const Description& description) {
  XmlWriter out;
  out.open("redmax");
  out.put("model", description.model);
  write_options(out, description);
  for (const Robot& robot : description.robots) {
    write_robot(out, robot);
  }
  write_all(out, "actuator", description.motors);
  write_all(out, "contact", description.contacts);
  write_all(out, "variable", description.end_effectors);
  write_all(out, "sensor", description.tactile_sensors);
  write_all(out, "virtual", description.virtual_shapes);
  out.close();
  std::string text = out.take();
  if (read_scene_text(text, "write_scene").description != description) {
    throw InvalidInput(
        "write_scene: the description holds values its kinds of joints, bodies or motors do not "
        "have, or quaternions not of unit length; a file could not say them");
  }
  return text;
}

void write_scene(const std::filesystem::path& path, const Description& description) {
  write_file_atomically(path, write_scene_text(description));
}

}  // namespace hbar::scene
