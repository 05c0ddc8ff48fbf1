#include "tests/benchmarks/hinges.h"

#include <iomanip>
#include <sstream>

#include "hbar/core/base/error.h"
#include "hbar/core/model/model_builder.h"

namespace hbar::benchmarks {
namespace {

constexpr double kGravity = 9.81;

/// A rod of length l hanging from its hinge.
HingedBody hanging_rod(int parent, const Eigen::Vector3d& axis, const Eigen::Vector3d& offset,
                       double l) {
  const double mass = 2.0 * l;
  const double across = mass * l * l / 12.0 + 1e-5;
  return {parent, axis.normalized(), offset, {0.0, 0.0, -0.5 * l}, mass, {across, across, 2e-5}};
}

/// Hinges about x, about y and about an axis in between, in turn.
Eigen::Vector3d turning_axis(int i) {
  const double x = i % 3 == 1 ? 0.0 : 1.0;
  const double y = i % 3 == 0 ? 0.0 : 1.0;
  return {x, y, 0.0};
}

std::ostream& operator<<(std::ostream& out, const Eigen::Vector3d& v) {
  return out << '"' << v[0] << ' ' << v[1] << ' ' << v[2] << '"';
}

/// A body, and below it those whose parent it is.
void write_body(const HingeModel& hinges, int i, std::ostream& out) {
  const HingedBody& body = hinges.bodies[static_cast<std::size_t>(i)];
  out << "<body name=\"b" << i << "\" pos=" << body.offset << "><joint name=\"j" << i
      << "\" type=\"hinge\" axis=" << body.axis << "/><inertial pos=" << body.center << " mass=\""
      << body.mass << "\" diaginertia=" << body.inertia << "/>\n";
  for (std::size_t k = 0; k < hinges.bodies.size(); ++k) {
    if (hinges.bodies[k].parent == i) {
      write_body(hinges, static_cast<int>(k), out);
    }
  }
  out << "</body>\n";
}

}  // namespace

HingeModel serial_chain(int n) {
  HingeModel hinges{concat("chain", n), {}, {n - 1}};
  const double l = 0.1;
  for (int i = 0; i < n; ++i) {
    hinges.bodies.push_back(hanging_rod(i - 1, turning_axis(i), {0.0, 0.0, i == 0 ? 0.0 : -l}, l));
  }
  return hinges;
}

HingeModel hand() {
  HingeModel hinges{"hand23", {}, {}};
  const double l = 0.05;
  for (int i = 0; i < 3; ++i) {
    hinges.bodies.push_back(
        hanging_rod(i - 1, Eigen::Vector3d::Unit(i), {0.0, 0.0, i == 0 ? 0.0 : -l}, l));
  }
  for (int finger = 0; finger < 5; ++finger) {
    for (int i = 0; i < 4; ++i) {
      const auto parent = i == 0 ? 2 : static_cast<int>(hinges.bodies.size()) - 1;
      const Eigen::Vector3d offset(0.0, i == 0 ? 0.02 * (finger - 2) : 0.0, -l);
      hinges.bodies.push_back(hanging_rod(parent, turning_axis(i == 0 ? 0 : 1), offset, l));
    }
    hinges.tips.push_back(static_cast<int>(hinges.bodies.size()) - 1);
  }
  return hinges;
}

std::vector<HingeModel> all_models() {
  return {serial_chain(4), serial_chain(8),  serial_chain(16),
          hand(),          serial_chain(32), serial_chain(64)};
}

Model build_model(const HingeModel& hinges) {
  ModelBuilder builder(hinges.name);
  builder.set_gravity({0.0, 0.0, -kGravity});
  for (std::size_t i = 0; i < hinges.bodies.size(); ++i) {
    const HingedBody& hinged = hinges.bodies[i];
    Joint joint;
    joint.name = concat("j", i);
    joint.kind = RevoluteJoint{hinged.axis};
    joint.X_PJ.p = hinged.offset;
    Body body;
    body.name = concat("b", i);
    body.X_JB.p = hinged.center;
    body.mass = hinged.mass;
    body.inertia = hinged.inertia;
    const int link = builder.add_link(hinged.parent, joint, body);
    builder.add_motor({.link = link, .kind = Motor::Kind::kForce});
  }
  for (const int tip : hinges.tips) {
    const HingedBody& body = hinges.bodies[static_cast<std::size_t>(tip)];
    builder.add_end_effector({.name = "", .link = tip, .position = 2.0 * body.center});
  }
  return builder.build();
}

std::string build_mjcf(const HingeModel& hinges, double h) {
  std::ostringstream out;
  out << std::setprecision(17) << "<mujoco model=\"" << hinges.name
      << "\"><compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n<option timestep=\"" << h
      << "\" integrator=\"Euler\" gravity=\"0 0 " << -kGravity
      << "\"><flag contact=\"disable\" constraint=\"disable\"/></option>\n<worldbody>\n";
  for (std::size_t i = 0; i < hinges.bodies.size(); ++i) {
    if (hinges.bodies[i].parent < 0) {
      write_body(hinges, static_cast<int>(i), out);
    }
  }
  out << "</worldbody><actuator>\n";
  for (std::size_t i = 0; i < hinges.bodies.size(); ++i) {
    out << "<motor joint=\"j" << i << "\"/>\n";
  }
  out << "</actuator></mujoco>\n";
  return out.str();
}

}  // namespace hbar::benchmarks
