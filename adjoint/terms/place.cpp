#include "hbar/adjoint/terms/place.h"

#include <algorithm>
#include <string>
#include <vector>

#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"

namespace hbar::place {
namespace {

int checked(int step) {
  if (step < 0) {
    throw InvalidInput(concat("place: step is ", step, "; it must be ≥ 0"));
  }
  return step;
}

/// Where `name` is among names, or InvalidInput.
int index_of(std::string_view name, const std::vector<std::string>& names, const char* kind) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InvalidInput(
        concat("the model has no ", kind, " '", name, "'; ", unknown_name_hint(name, names)));
  }
  return static_cast<int>(found - names.begin());
}

int coordinate_index(const Model& model, std::string_view name) {
  std::vector<std::string> names;
  for (int i = 0; i < model.dof(); ++i) {
    names.push_back(model.coordinate_name(i));
  }
  return index_of(name, names, "coordinate");
}

}  // namespace

ValuePlace parameter(const ParameterSet& set, std::string_view name) {
  return {ValueField::kP, 0, set.find(name)};
}

ValuePlace coordinate(const Model& model, std::string_view name, int step) {
  return {ValueField::kQ, checked(step), coordinate_index(model, name)};
}

ValuePlace rate(const Model& model, std::string_view coordinate, int step) {
  return {ValueField::kQdot, checked(step), coordinate_index(model, coordinate)};
}

ValuePlace control(const Model& model, std::string_view name, int step) {
  std::vector<std::string> names;
  for (int i = 0; i < model.control_count(); ++i) {
    names.push_back(model.control_name(i));
  }
  return {ValueField::kU, checked(step), index_of(name, names, "control")};
}

ValuePlace end_effector(const Model& model, std::string_view name, Axis axis, int step) {
  std::vector<std::string> names;
  for (const EndEffector& end_effector : model.end_effectors()) {
    names.push_back(end_effector.name);
  }
  // model_measurements begins with them.
  return {ValueField::kMeasured, checked(step), 3 * index_of(name, names, "end effector") + axis};
}

ValuePlace measured(const Horizon& horizon, std::string_view name, int step) {
  return {ValueField::kMeasured, checked(step), horizon.measured_index(name)};
}

}  // namespace hbar::place
