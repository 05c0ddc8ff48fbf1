#include "families.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/model/model_builder.h"

namespace hbar::solver_benchmark {
namespace {

constexpr double kGravity = 9.81;
constexpr double kRod = 0.1;      // length of a rod of chain and tree, m
constexpr double kBall = 0.03;    // radius of the ball in the hand, m
constexpr double kThick = 0.008;  // radius of a phalanx, m
constexpr double kFinger = 0.06;  // length of a finger, m
constexpr double kPalm = 0.042;   // distance of the fingers' feet from the palm's centre, m

RigidTransform<double> at(double x, double y, double z) {
  return {Eigen::Matrix3d::Identity(), {x, y, z}};
}

/// A rod that hangs from a hinge: about x, about y and about an axis in between, in turn.
int add_rod(ModelBuilder& builder, int parent, int i) {
  Joint joint{.name = concat("j", i), .damping = 0.03};
  joint.kind = RevoluteJoint{{i % 3 == 1 ? 0.0 : 1.0, i % 3 == 0 ? 0.0 : 1.0, 0.0}};
  joint.X_PJ = at(0.0, 0.0, parent < 0 ? 0.0 : -kRod);
  const int link = builder.add_link(
      parent, joint,
      solid_body(concat("b", i), Cuboid{{0.03, 0.03, kRod}}, 1000.0, at(0.0, 0.0, -0.5 * kRod)));
  builder.add_motor({.link = link, .kind = Motor::Kind::kForce});
  return link;
}

Model chain(int n) {
  ModelBuilder builder(concat("chain", n));
  builder.set_gravity({0.0, 0.0, -kGravity});
  int link = -1;
  for (int i = 0; i < n; ++i) {
    link = add_rod(builder, link, i);
  }
  builder.add_end_effector({.name = "tip", .link = link, .position = {0.0, 0.0, -kRod}});
  return builder.build();
}

/// Link i hangs from link (i − 1) / 2, so that every link carries two more.
Model tree(int n) {
  ModelBuilder builder(concat("tree", n));
  builder.set_gravity({0.0, 0.0, -kGravity});
  for (int i = 0; i < n; ++i) {
    add_rod(builder, i == 0 ? -1 : (i - 1) / 2, i);
  }
  for (int i = n / 2; i < n; ++i) {  // leaves
    builder.add_end_effector({.name = concat("tip", i), .link = i, .position = {0.0, 0.0, -kRod}});
  }
  return builder.build();
}

/// How far a straight finger leans inward so that it presses `depth` into the ball.
double lean(double depth) {
  return std::acos((kBall + kThick - depth) / std::hypot(kPalm, kBall)) - std::atan2(kBall, kPalm);
}

/// Adds a finger that stands on the palm; returns its phalanges.
std::vector<int> add_finger(ModelBuilder& builder, int palm, int finger, int fingers, int joints) {
  const double length = kFinger / joints;
  std::vector<int> links;
  int parent = palm;
  for (int i = 0; i < joints; ++i) {
    const std::string name = concat("finger", finger, ".", i);
    Joint joint{.name = name, .damping = 1e-3, .stiffness = 0.05};
    // Positive angles bend the finger inward, which is its frame's −x.
    joint.kind = RevoluteJoint{{0.0, -1.0, 0.0}};
    if (i == 0) {
      const double angle = 2.0 * std::numbers::pi * finger / fingers;
      joint.X_PJ.R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      joint.X_PJ.p = joint.X_PJ.R * Eigen::Vector3d(kPalm, 0.0, 0.0);
      // The spring at the foot presses the finger against the ball.
      joint.rest = Eigen::VectorXd::Constant(1, lean(0.0) + 0.3);
    } else {
      joint.X_PJ = at(0.0, 0.0, length);
    }
    Body body = solid_body(name, Capsule{kThick, length}, 1200.0, at(0.0, 0.0, 0.5 * length));
    constexpr int kPoints = 5;  // a line of them along the inner side
    body.contact_points.resize(3, kPoints);
    for (int k = 0; k < kPoints; ++k) {
      body.contact_points.col(k) << -kThick, 0.0, length * ((k + 0.5) / kPoints - 0.5);
    }
    parent = builder.add_link(parent, joint, body);
    builder.add_motor({.link = parent, .kind = Motor::Kind::kForce});
    links.push_back(parent);
  }
  builder.add_end_effector(
      {.name = concat("tip", finger), .link = parent, .position = {0, 0, length}});
  return links;
}

/// A palm that looks up, a ball that lies on it, and fingers of up to four joints that stand around
/// the ball and press against it.
Model hand(int n) {
  ModelBuilder builder(concat("hand", n));
  builder.set_gravity({0.0, 0.0, -kGravity});
  const int palm =
      builder.add_link(-1, {.name = "palm"},
                       solid_body("palm", Cuboid{{0.12, 0.12, 0.02}}, 1000.0, at(0, 0, -0.01)));
  const int fingers = std::max(3, (n + 3) / 4);
  std::vector<int> phalanges;
  for (int finger = 0; finger < fingers; ++finger) {
    const int joints = n / fingers + (finger < n % fingers ? 1 : 0);
    for (const int link : add_finger(builder, palm, finger, fingers, joints)) {
      phalanges.push_back(link);
    }
  }
  Joint free{.name = "ball", .kind = Free3dExpJoint{}};
  free.X_PJ = at(0.0, 0.0, kBall);
  const int ball = builder.add_link(-1, free, solid_body("ball", Sphere{kBall}, 400.0));
  builder.add_end_effector({.name = "ball", .link = ball});
  const ContactCoefficients rubber = {.kn = 2000.0, .kt = 20.0, .mu = 0.8, .damping = 2000.0};
  builder.add_contact({.link = ball, .other = palm, .coefficients = rubber});
  for (const int link : phalanges) {
    builder.add_contact({.link = link, .other = ball, .coefficients = rubber});
  }
  return builder.build();
}

}  // namespace

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {.name = "chain",
       .sentence = "a hanging chain of revolute joints with turning axes",
       .smallest = 1,
       .h = 0.01,
       .q0 = 0.1,
       .torque = 0.02,
       .make = chain},
      {.name = "tree",
       .sentence = "such joints where every link carries two more",
       .smallest = 1,
       .h = 0.01,
       .q0 = 0.1,
       .torque = 0.02,
       .make = tree},
      {.name = "hand",
       .sentence = "fingers of such joints that hold a free ball by contact (6 more coordinates)",
       .smallest = 3,
       .h = 0.005,
       .q0 = 0.0,
       .torque = 0.002,
       .make = hand},
  };
  return all;
}

const Family& find_family(std::string_view name) {
  std::vector<std::string> names;
  for (const Family& family : families()) {
    if (family.name == name) {
      return family;
    }
    names.push_back(family.name);
  }
  throw InvalidInput(concat("there is no family \"", name, "\"; ", unknown_name_hint(name, names)));
}

Model make_model(const Family& family, int joints) {
  if (joints < family.smallest) {
    throw InvalidInput(concat("family ", family.name, ": ", joints, " joints; at least ",
                              family.smallest, " are needed"));
  }
  return family.make(joints);
}

void set_swinging_controls(Inputs& inputs, double amplitude) {
  for (Eigen::Index k = 0; k < inputs.u.cols(); ++k) {
    for (Eigen::Index i = 0; i < inputs.u.rows(); ++i) {
      inputs.u(i, k) = amplitude * std::sin(0.1 * static_cast<double>(k) + static_cast<double>(i));
    }
  }
}

void set_gentle_motion(const Family& family, const Model& model, Inputs& inputs) {
  inputs.q0.setZero();
  inputs.qdot0.setZero();
  for (int i = 0; i < model.link_count(); ++i) {
    const CoordinateRange own = model.coordinates_of_link(i);
    if (joint_dof(model.link(i).joint.kind) != 1) {
      continue;
    }
    const bool foot = model.link(i).joint.rest.size() > 0;
    inputs.q0[own.begin] = foot ? lean(3e-4) : family.q0 * std::sin(own.begin + 1.0);
  }
  set_swinging_controls(inputs, family.torque);
}

}  // namespace hbar::solver_benchmark
