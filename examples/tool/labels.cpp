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

std::vector<std::string> contact_names(const Model& model) {
  std::vector<std::string> names;
  for (const Contact& contact : model.contacts()) {
    names.push_back(contact.name);
  }
  return names;
}

std::vector<std::string> tactile_names(const Model& model) {
  std::vector<std::string> names;
  for (const TactileSensor& sensor : model.tactile_sensors()) {
    for (Eigen::Index i = 0; i < sensor.points.cols(); ++i) {
      for (const char* reading : {".shear0", ".shear1", ".normal"}) {
        names.push_back(concat(sensor.name, '.', i, reading));
      }
    }
  }
  return names;
}

std::string unit_system(const Model& model) {
  return model.units() == Units::kCentimetreGram ? "cm-g" : "m-kg";
}

std::string_view force_unit(const Model& model) {
  return model.units() == Units::kCentimetreGram ? "dyn" : "N";
}

const std::vector<std::string>& objective_names() {
  static const std::vector<std::string> names = {"variables", "final-position", "tactile"};
  return names;
}

const std::string& objective_name(ObjectiveChoice choice) {
  return objective_names().at(static_cast<std::size_t>(choice));
}

}  // namespace hbar::tool
