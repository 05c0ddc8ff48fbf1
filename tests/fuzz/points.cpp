// Files of contact points and of the points of a tactile sensor.

#include "hbar/core/base/error.h"
#include "hbar/core/scene/read_points.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

void try_sensor(std::string_view input) {
  for (const scene::SensorPoint& point : scene::read_sensor_points_text(input, "sensor.txt")) {
    require(point.position.allFinite(), "a sensor point that is not finite");
    for (const Eigen::Vector3d& axis : {point.axis0, point.axis1}) {
      require(std::abs(axis.norm() - 1.0) < 1e-12, "an axis that is not a unit vector");
    }
  }
}

}  // namespace

void try_input(std::string_view input) {
  try {
    for (const Eigen::Vector3d& point : scene::read_contacts_text(input, "contacts.txt")) {
      require(point.allFinite(), "a contact point that is not finite");
    }
  } catch (const InvalidInput&) {
    try_sensor(input);  // no text but an empty list is both
  }
}

}  // namespace hbar::fuzz
