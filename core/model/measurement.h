#pragma once

#include <string>
#include <variant>
#include <vector>

#include "hbar/core/model/model.h"

namespace hbar {

/// Velocity of a point of a body, in the world. Rows x, y, z.
struct PointVelocity {
  std::string name = {};
  int link = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< in the body frame, length         [3]
};

/// Rotation vector log(R_0Tᵀ R_0B) from a desired orientation T to that of a body B, rad, in the
/// axes of T. Rows x, y, z. Smooth as long as the angle stays below π.
struct Orientation {
  std::string name = {};
  int link = 0;
  Eigen::Matrix3d R_0T = Eigen::Matrix3d::Identity();  ///< axes of T in the world     [3 x 3]
};

/// Signed distance between a ball on one body and the surface of another, or of the world; negative
/// where they overlap. One row. Has the kinks of the surface distance (contact/surface_distance.h).
struct BodyDistance {
  std::string name = {};
  int link = 0;                                     ///< carries the ball
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< its centre in the body frame  [3]
  double radius = 0.0;                              ///< of the ball, length, ≥ 0; not a parameter
  int other = -1;                                   ///< whose surface; −1 is the world
  ContactSurface surface = OwnShape{};              ///< as in Contact; the world's is a Plane
};

/// Force of a declared contact on the body whose points touch: Σ f_n over the points, and the world
/// components of the total force. Rows normal, x, y, z. Has the kinks of the contact's law; zero
/// where nothing touches.
struct ContactForce {
  std::string name = {};
  int contact = 0;  ///< index; Model::find_contact
};

/// Generalised force that a motor applies to each coordinate of its joint, from the control of the
/// step and the state at its end, even where the simulation treats a position motor explicitly. One
/// row per coordinate.
struct MotorTorque {
  std::string name = {};
  int motor = 0;
};

/// Power that a motor delivers to its joint: Σ of its MotorTorque times q̇. One row.
struct MotorPower {
  std::string name = {};
  int motor = 0;
};

/// Centre of mass of all links, in the world, length. Rows x, y, z.
struct CentreOfMass {
  std::string name = {};
};

/// Linear momentum of all links, in the world, mass·length/time. Rows x, y, z.
struct LinearMomentum {
  std::string name = {};
};

/// Position of an end effector of the model, in the world, length: three of the auxiliary variables
/// v (doc/notation.md). Rows x, y, z.
struct EndEffectorPosition {
  std::string name = {};
  int end_effector = 0;  ///< index
};

/// Readings of a tactile sensor of the model, force. Rows 0.shear0, 0.shear1, 0.normal, 1.shear0,
/// …: for each point in order, the contact force on it along its two shear directions, and opposite
/// to their cross product.
struct TactileReading {
  std::string name = {};
  int sensor = 0;  ///< index
};

/// A function of one instant (q, q̇, u, p) whose values constraints and objectives read.
using Measurement =
    std::variant<PointVelocity, Orientation, BodyDistance, ContactForce, MotorTorque, MotorPower,
                 CentreOfMass, LinearMomentum, EndEffectorPosition, TactileReading>;

/// The measurements built into a model: every end effector, then every tactile sensor, under their
/// own names.
[[nodiscard]] std::vector<Measurement> model_measurements(const Model& model);

/// Names of a measurement's rows: its own, followed by ".x" and the like where there are several.
[[nodiscard]] std::vector<std::string> row_names(const Model& model,
                                                 const Measurement& measurement);

/// Refuses measurements that a model cannot have in addition to its built-in ones.
///
/// @throws InvalidInput naming the measurement, what was found and what is allowed: an empty or
///         repeated name, an index out of range, a number that is not finite, a negative radius, a
///         matrix that is not a rotation, a surface that the other body does not have
void check_measurements(const Model& model, const std::vector<Measurement>& measurements);

}  // namespace hbar
