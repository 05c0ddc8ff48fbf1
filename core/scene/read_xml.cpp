#include "hbar/core/scene/read_xml.h"

#include <tinyxml2.h>

#include <system_error>
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
  notice_effects(scene.description, context);
  scene.notices = std::move(context.notices);
  return scene;
}

std::filesystem::path Scene::find(const std::string& name) const {
  std::error_code code;
  const std::filesystem::path beside_target = target_folder / name;
  return !std::filesystem::exists(folder / name, code) && !target_folder.empty() &&
                 std::filesystem::exists(beside_target, code)
             ? beside_target
             : folder / name;
}

Scene read_scene(const std::filesystem::path& path) {
  const auto folder_of = [](const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  };
  Scene scene = read_scene_text(read_text_file(path), path.filename().string(), folder_of(path));
  std::error_code code;
  const std::filesystem::path target = std::filesystem::canonical(path, code);
  scene.target_folder = code ? scene.folder : folder_of(target);
  return scene;
}

}  // namespace hbar::scene
