#pragma once

#include "hbar/core/scene/description.h"
#include "hbar/core/scene/xml_element.h"

/// The parts of read_xml.cpp. All of them throw InvalidInput as XmlElement does.
namespace hbar::scene {

/// Checks and stores the attributes of the elements in a `<default>` block.
void read_defaults(const tinyxml2::XMLElement& block, ReadContext& context);

/// A link's parts, and a robot with all its links.
/// `<joint>`; its name is empty if it has none.
[[nodiscard]] Joint read_joint(XmlElement element);
/// `<body>` with its children; its name is empty if it has none.
[[nodiscard]] Body read_body(XmlElement element);
/// `<robot>`: its links in file order, nested and flat, all named.
[[nodiscard]] Robot read_robot(const tinyxml2::XMLElement& robot, ReadContext& context);

/// The other sections of a scene, each from its own element.
/// `<option>`.
[[nodiscard]] Options read_options(const XmlElement& element);
/// `<solver_option>`.
[[nodiscard]] SolverOptions read_solver_options(const XmlElement& element);
/// `<ground>`.
[[nodiscard]] Ground read_ground(const XmlElement& element);
/// `<motor>`.
[[nodiscard]] Motor read_motor(XmlElement element);
/// `<ground_contact>`, `<general_primitive_contact>` or `<cuboid_cuboid_contact>`.
[[nodiscard]] Contact read_contact(XmlElement element);
/// `<endeffector>`.
[[nodiscard]] EndEffector read_end_effector(const XmlElement& element);
/// `<tactile>`.
[[nodiscard]] TactileSensor read_tactile(XmlElement element);
/// `<virtual>`'s `<sphere>` or `<cuboid>`.
[[nodiscard]] VirtualShape read_virtual_shape(const XmlElement& element);

/// Checks that names are unique and references resolve.
///
/// @throws InvalidInput for the first that do not
void check_references(const Description& description, const ReadContext& context);

/// Notices what was given and has no effect, or is doubtful, for want of something else.
void notice_effects(const Description& description, ReadContext& context);

}  // namespace hbar::scene
