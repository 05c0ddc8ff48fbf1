#include "hbar/core/scene/read_xml.h"

#include <tinyxml2.h>

#include <utility>

#include "hbar/core/files/text_file.h"
#include "hbar/core/scene/read_elements.h"
#include "hbar/core/scene/xml_document.h"

namespace hbar::scene {
namespace {

/// One reader per container: what its children are and where they go.
class SceneReader {
 public:
  SceneReader(ReadContext& context, Description& description)
      : context_(context), description_(description) {}

  void read_root(const tinyxml2::XMLElement& root) {
    description_.model = XmlElement(root, context_).text("model");
    const auto children = checked_children(root, context_);
    for (const tinyxml2::XMLElement* child : children) {
      if (std::string_view(child->Name()) == "default") {
        read_defaults(*child, context_);
      }
    }
    for (const tinyxml2::XMLElement* child : children) {
      read_section(*child);
    }
    notice_missing_ground();
  }

 private:
  void read_section(const tinyxml2::XMLElement& xml) {
    const XmlElement element(xml, context_);
    const std::string_view name = element.name();
    if (name == "option") {
      description_.options = read_options(element);
    } else if (name == "solver_option") {
      description_.solver_options = read_solver_options(element);
    } else if (name == "ground") {
      description_.ground = read_ground(element);
    } else if (name == "robot") {
      description_.robots.push_back(read_robot(xml, context_));
    } else if (name != "default") {
      read_list(xml, name);
    }
  }

  void read_list(const tinyxml2::XMLElement& xml, std::string_view section) {
    for (const tinyxml2::XMLElement* child : checked_children(xml, context_)) {
      const XmlElement element(*child, context_);
      if (section == "actuator") {
        description_.motors.push_back(read_motor(element));
      } else if (section == "contact") {
        description_.contacts.push_back(read_contact(element));
        notice_ground_damping(element, description_.contacts.back());
      } else if (section == "variable") {
        description_.end_effectors.push_back(read_end_effector(element));
      } else if (section == "sensor") {
        description_.tactile_sensors.push_back(read_tactile(element));
      } else {
        description_.virtual_shapes.push_back(read_virtual_shape(element));
      }
    }
  }

  void notice_ground_damping(const XmlElement& element, const Contact& contact) {
    const bool silent =
        contact.kind == ContactKind::kGround && contact.damping > 0.0 && !element.has("law");
    if (!silent) {
      return;
    }
    context_.notice(element.line(),
                    "<ground_contact>: damping without law is multiplied by the depth; "
                    "law=\"linear\" is what earlier readers of this format do");
  }

  /// A scene may omit its ground, but hardly on purpose if bodies touch it.
  void notice_missing_ground() {
    if (description_.ground) {
      return;
    }
    for (const Contact& contact : description_.contacts) {
      if (contact.kind != ContactKind::kGround) {
        continue;
      }
      context_.notice(contact.line.number,
                      "<ground_contact>: the scene has no <ground>, so it is the plane z = 0");
    }
  }

  ReadContext& context_;
  Description& description_;
};

}  // namespace

void read_defaults(const tinyxml2::XMLElement& block, ReadContext& context) {
  const XmlElement checked(block, context);
  for (const tinyxml2::XMLElement* child : checked_children(block, context)) {
    const XmlElement element(*child, context);
    if (const auto inner = checked_children(*child, context); !inner.empty()) {
      XmlElement(*inner.front(), context).fail("cannot be a default; only attributes can");
    }
    for (const auto* a = child->FirstAttribute(); a != nullptr; a = a->Next()) {
      element.check_any_type(a->Name());
      context.defaults[std::string(element.name())][a->Name()] = {a->Value(), a->GetLineNum(),
                                                                  true};
    }
  }
}

Scene read_scene_text(std::string_view text, const std::string& name,
                      const std::filesystem::path& folder) {
  ReadContext context{name, {}, {}};
  tinyxml2::XMLDocument document;
  const tinyxml2::XMLElement& root = parse_document(text, name, document);
  Scene scene;
  scene.file = name;
  scene.folder = folder;
  SceneReader(context, scene.description).read_root(root);
  std::size_t links = 0;
  for (const Robot& robot : scene.description.robots) {
    links += robot.links.size();
  }
  if (links == 0) {
    throw InvalidInput(element_place(context, root.GetLineNum(), "redmax") +
                       "the scene has no link; <robot> holds at least one <link>");
  }
  check_references(scene.description, context);
  scene.notices = std::move(context.notices);
  return scene;
}

Scene read_scene(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return read_scene_text(read_text_file(path), path.filename().string(), folder);
}

}  // namespace hbar::scene
