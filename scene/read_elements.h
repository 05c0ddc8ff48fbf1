#pragma once

#include <vector>

#include "hbar/scene/description.h"
#include "hbar/scene/xml_element.h"

/// The parts read_xml.cpp is made of. All of them throw InvalidInput as XmlElement does.
namespace hbar::scene {

/// The child elements of an element, in file order, each known, in its place and not too often;
/// text between them is noticed and dropped.
[[nodiscard]] std::vector<const tinyxml2::XMLElement*> checked_children(
    const tinyxml2::XMLElement& parent, ReadContext& context);

/// Remembers the attributes of the elements in a `<default>` block, having checked their texts.
void read_defaults(const tinyxml2::XMLElement& block, ReadContext& context);

/// A link's parts, and a robot with all its links.
[[nodiscard]] Joint read_joint(XmlElement element);
[[nodiscard]] Body read_body(XmlElement element);
[[nodiscard]] Robot read_robot(const tinyxml2::XMLElement& robot, ReadContext& context);

/// The other sections of a scene, each from its own element.
[[nodiscard]] Options read_options(const XmlElement& element);
[[nodiscard]] SolverOptions read_solver_options(const XmlElement& element);
[[nodiscard]] Ground read_ground(const XmlElement& element);
[[nodiscard]] Motor read_motor(XmlElement element);
[[nodiscard]] Contact read_contact(const XmlElement& element);
[[nodiscard]] EndEffector read_end_effector(const XmlElement& element);
[[nodiscard]] TactileSensor read_tactile(XmlElement element);
[[nodiscard]] VirtualShape read_virtual_shape(const XmlElement& element);

/// Checks that names differ and references lead somewhere.
///
/// @throws InvalidInput for the first that do not
void check_references(const Description& description, const ReadContext& context);

}  // namespace hbar::scene
