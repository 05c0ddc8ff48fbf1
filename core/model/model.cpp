#include "hbar/core/model/model.h"

#include <algorithm>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"

namespace hbar {
namespace {

/// @throws InvalidInput naming the nearest name if there is none
template <typename Item, typename NameOf>
int find_by_name(const NameIndex& index, const std::vector<Item>& items, std::string_view name,
                 std::string_view what, const NameOf& name_of) {
  if (const std::optional<int> found = index.find(name)) {
    return *found;
  }
  std::vector<std::string> names;
  for (const Item& item : items) {
    names.push_back(name_of(item));
  }
  throw InvalidInput(
      concat("there is no ", what, " '", name, "'; ", unknown_name_hint(name, names)));
}

}  // namespace

CoordinateRange Model::coordinates_of_link(int link) const {
  const int last = node_of_link(link);
  int first = last;
  while (!tree_.node(first).first) {
    first = tree_.node(first).parent;
  }
  return {tree_.node(first).coordinates.begin, tree_.node(last).coordinates.end};
}

std::string Model::coordinate_name(int i) const {
  const Link& owner = link(tree_.node(tree_.node_of(i)).link);
  const std::vector<std::string> names = coordinate_names(owner.joint.kind);
  if (names.size() == 1) {
    return owner.joint.name;
  }
  const int first = coordinates_of_link(tree_.node(tree_.node_of(i)).link).begin;
  return concat(owner.joint.name, '.', names[static_cast<std::size_t>(i - first)]);
}

std::string Model::control_name(int i) const {
  const auto next = std::upper_bound(first_control_.begin(), first_control_.end(), i);
  if (i < control_count_ && next != first_control_.begin()) {
    const auto m = static_cast<std::size_t>(next - first_control_.begin()) - 1;
    return coordinate_name(coordinates_of_link(motors_[m].link).begin + i - first_control_[m]);
  }
  throw InvalidInput(concat("there is no control ", i, "; the model has ", control_count_));
}

int Model::find_link(std::string_view link) const {
  return find_by_name(link_names_, links_, link, "link", [](const Link& l) { return l.name; });
}

int Model::find_joint(std::string_view joint) const {
  return find_by_name(joint_names_, links_, joint, "joint",
                      [](const Link& l) { return l.joint.name; });
}

int Model::find_body(std::string_view body) const {
  return find_by_name(body_names_, links_, body, "body", [](const Link& l) { return l.body.name; });
}

int Model::find_contact(std::string_view contact) const {
  return find_by_name(contact_names_, contacts_, contact, "contact",
                      [](const Contact& c) { return c.name; });
}

bool touches_as_ball(const Model& model, const Contact& contact) {
  const Body& body = model.link(contact.link).body;
  const bool from_points =
      !std::holds_alternative<Plane>(contact.surface) &&
      (body.contact_points.cols() > 0 || !std::holds_alternative<OwnShape>(contact.surface));
  return std::holds_alternative<Sphere>(body.shape) && !from_points;
}

std::string_view length_unit(Units units) { return units == Units::kCentimetreGram ? "cm" : "m"; }

std::string_view mass_unit(Units units) { return units == Units::kCentimetreGram ? "g" : "kg"; }

}  // namespace hbar
