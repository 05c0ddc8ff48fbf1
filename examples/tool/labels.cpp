#include "labels.h"

namespace hbar::tool {

std::vector<std::string> coordinate_names(const Model& model) {
  std::vector<std::string> names;
  for (int i = 0; i < model.dof(); ++i) {
    names.push_back(model.coordinate_name(i));
  }
  return names;
}

std::vector<std::string> coordinate_units(const Model& model) {
  std::vector<std::string> units;
  for (const Link& link : model.links()) {
    for (int i = 0; i < joint_dof(link.joint.kind); ++i) {
      units.emplace_back(is_angle(link.joint.kind, i) ? "rad" : length_unit(model.units()));
    }
  }
  return units;
}

std::vector<std::string> control_names(const Model& model) {
  std::vector<std::string> names;
  for (int i = 0; i < model.control_count(); ++i) {
    names.push_back(model.control_name(i));
  }
  return names;
}

std::vector<std::string> variable_names(const Model& model) {
  std::vector<std::string> names;
  for (const EndEffector& point : model.end_effectors()) {
    for (const char* axis : {".x", ".y", ".z"}) {
      names.push_back(point.name + axis);
    }
  }
  return names;
}

std::string unit_system(const Model& model) {
  return model.units() == Units::kCentimetreGram ? "cm-g" : "m-kg";
}

}  // namespace hbar::tool
