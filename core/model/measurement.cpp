#include "hbar/core/model/measurement.h"

#include <cmath>
#include <set>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// Tolerance on the orthonormality of a rotation and on the unit length of a normal.
constexpr double kUnitTolerance = 1e-9;

std::string name_of_measurement(const Measurement& measurement) {
  return std::visit([](const auto& m) { return m.name; }, measurement);
}

/// What is wrong with one measurement; empty if nothing is.
class MeasurementCheck {
 public:
  explicit MeasurementCheck(const Model& model) : model_(model) {}

  std::string operator()(const PointVelocity& m) const {
    return first_of(index("link", m.link, model_.link_count()), finite("point", m.point));
  }
  std::string operator()(const Orientation& m) const {
    const std::string wrong = index("link", m.link, model_.link_count());
    const Eigen::Matrix3d excess = m.R_0T.transpose() * m.R_0T - Eigen::Matrix3d::Identity();
    if (!wrong.empty() ||
        (excess.cwiseAbs().maxCoeff() <= kUnitTolerance && m.R_0T.determinant() > 0.0)) {
      return wrong;
    }
    return "R_0T is no rotation; its columns must be orthonormal and right-handed";
  }
  std::string operator()(const BodyDistance& m) const {
    std::string wrong =
        first_of(index("link", m.link, model_.link_count()), finite("point", m.point));
    if (wrong.empty() && !(m.radius >= 0.0 && std::isfinite(m.radius))) {
      wrong = concat("radius is ", m.radius, "; it must be ≥ 0");
    }
    if (wrong.empty() && m.other == m.link) {
      wrong = concat("other is ", m.other, ", the link itself; it must be another one, or −1");
    }
    if (wrong.empty() && m.other != -1) {
      wrong = index("other", m.other, model_.link_count());
    }
    return wrong.empty() ? surface(m) : wrong;
  }
  std::string operator()(const ContactForce& m) const {
    return index("contact", m.contact, model_.contact_count());
  }
  std::string operator()(const MotorTorque& m) const { return motor(m.motor); }
  std::string operator()(const MotorPower& m) const { return motor(m.motor); }
  std::string operator()(const CentreOfMass&) const { return {}; }
  std::string operator()(const LinearMomentum&) const { return {}; }
  std::string operator()(const EndEffectorPosition& m) const {
    return index("end effector", m.end_effector, static_cast<int>(model_.end_effectors().size()));
  }
  std::string operator()(const TactileReading& m) const {
    return index("sensor", m.sensor, static_cast<int>(model_.tactile_sensors().size()));
  }

 private:
  static std::string first_of(std::string a, std::string b) { return a.empty() ? b : a; }

  static std::string index(const char* what, int value, int count) {
    if (value >= 0 && value < count) {
      return {};
    }
    return concat(what, " is ", value, "; ",
                  count == 0 ? "the model has none" : concat("it must be 0 … ", count - 1));
  }
  std::string motor(int value) const {
    return index("motor", value, static_cast<int>(model_.motors().size()));
  }
  static std::string finite(const char* what, const Eigen::Vector3d& value) {
    return value.allFinite() ? std::string()
                             : concat(what, " is (", value[0], ", ", value[1], ", ", value[2],
                                      "); it must be finite");
  }
  std::string surface(const BodyDistance& m) const {
    if (const auto* plane = std::get_if<Plane>(&m.surface)) {
      const bool unit = std::abs(plane->normal.norm() - 1.0) <= kUnitTolerance;
      return first_of(finite("the plane's point", plane->point),
                      unit ? std::string()
                           : concat("the plane's normal has length ", plane->normal.norm(),
                                    "; it must have length 1"));
    }
    if (const auto* field = std::get_if<std::shared_ptr<const DistanceField>>(&m.surface)) {
      if (*field == nullptr) {
        return "the distance field is missing";
      }
      return m.other >= 0 ? std::string() : "a distance field needs another body; other is −1";
    }
    if (m.other < 0) {
      return "other is −1, the world, which has no shape of its own; its surface must be a plane";
    }
    if (std::holds_alternative<NoShape>(model_.link(m.other).body.shape)) {
      return concat("body '", model_.link(m.other).body.name,
                    "' has no shape; take a plane or a distance field");
    }
    return {};
  }

  const Model& model_;
};

}  // namespace

std::vector<Measurement> model_measurements(const Model& model) {
  std::vector<Measurement> out;
  for (std::size_t i = 0; i < model.end_effectors().size(); ++i) {
    out.emplace_back(EndEffectorPosition{model.end_effectors()[i].name, static_cast<int>(i)});
  }
  for (std::size_t i = 0; i < model.tactile_sensors().size(); ++i) {
    out.emplace_back(TactileReading{model.tactile_sensors()[i].name, static_cast<int>(i)});
  }
  return out;
}

std::vector<std::string> row_names(const Model& model, const Measurement& measurement) {
  const std::string name = name_of_measurement(measurement);
  if (std::holds_alternative<BodyDistance>(measurement) ||
      std::holds_alternative<MotorPower>(measurement)) {
    return {name};
  }
  if (const auto* torque = std::get_if<MotorTorque>(&measurement)) {
    const int link = model.motors()[static_cast<std::size_t>(torque->motor)].link;
    std::vector<std::string> names = coordinate_names(model.link(link).joint.kind);
    for (std::string& coordinate : names) {
      coordinate = names.size() == 1 ? name : concat(name, '.', coordinate);
    }
    return names;
  }
  if (const auto* reading = std::get_if<TactileReading>(&measurement)) {
    const auto& sensor = model.tactile_sensors()[static_cast<std::size_t>(reading->sensor)];
    std::vector<std::string> names;
    for (Eigen::Index i = 0; i < sensor.points.cols(); ++i) {
      for (const char* row : {".shear0", ".shear1", ".normal"}) {
        names.push_back(concat(name, '.', i, row));
      }
    }
    return names;
  }
  std::vector<std::string> names = {name + ".x", name + ".y", name + ".z"};
  if (std::holds_alternative<ContactForce>(measurement)) {
    names.insert(names.begin(), name + ".normal");
  }
  return names;
}

void check_measurements(const Model& model, const std::vector<Measurement>& measurements) {
  std::set<std::string> taken;
  for (const Measurement& own : model_measurements(model)) {
    const std::vector<std::string> rows = row_names(model, own);
    taken.insert(rows.begin(), rows.end());
  }
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const std::string name = name_of_measurement(measurements[i]);
    if (name.empty()) {
      throw InvalidInput(concat("measurement ", i, " has no name; each must have one"));
    }
    const std::string wrong = std::visit(MeasurementCheck(model), measurements[i]);
    if (!wrong.empty()) {
      throw InvalidInput(concat("measurement '", name, "': ", wrong));
    }
    // Names of rows, so that what finds a row finds one.
    for (const std::string& row : row_names(model, measurements[i])) {
      if (!taken.insert(row).second) {
        throw InvalidInput(concat("measurement '", name, "': its row '", row,
                                  "' has the name of another; names must differ"));
      }
    }
  }
}

}  // namespace hbar
