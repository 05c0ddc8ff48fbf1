#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "hbar/core/model/model.h"

namespace hbar {

/// Builds a Model in code.
///
/// ```cpp
/// hbar::ModelBuilder builder("pendulum", hbar::Units::kMetreKilogram);
/// builder.set_gravity({0.0, 0.0, -9.81});
/// hbar::Joint hinge{.name = "hinge", .kind = hbar::RevoluteJoint{{0.0, 1.0, 0.0}}};
/// builder.add_link(-1, hinge, hbar::solid_body("rod", hbar::Cuboid{{1.0, 0.1, 0.1}}, 800.0));
/// const hbar::Model model = builder.build();
/// ```
///
/// Every call checks its arguments and throws InvalidInput that names the link, joint or body, the
/// value found and what is allowed.
class ModelBuilder {
 public:
  explicit ModelBuilder(std::string name, Units units = Units::kMetreKilogram);

  /// @param gravity  acceleration of free fall in the world frame, length/time²      [3]
  ModelBuilder& set_gravity(const Eigen::Vector3d& gravity);

  /// Adds a link below `parent` (a link's index, or −1 for the world) and returns its index.
  ///
  /// Axes are normalised. An empty link name becomes the body's name, or the joint's; empty joint
  /// and body names become the link's.
  int add_link(int parent, Joint joint, Body body, std::string name = "", unsigned design_mask = 0);

  /// Adds a motor on the joint of link `motor.link`; returns its index.
  int add_motor(const Motor& motor);

  /// Adds an end effector; returns its index. An empty name becomes "endeffector<index>".
  int add_end_effector(EndEffector end_effector);

  /// Declares a contact; returns its index. An empty name becomes "POINTS_BODY-OTHER_BODY"
  /// ("-ground" for the world), numbered where that is taken.
  int add_contact(Contact contact);

  /// Adds a tactile sensor; returns its index. An empty name becomes "tactile<index>".
  int add_tactile_sensor(TactileSensor sensor);

  /// Pose of a link's joint frame in the world when every coordinate is zero.
  [[nodiscard]] RigidTransform<double> rest_pose(int link) const;

  /// @throws InvalidInput if the model has no link
  [[nodiscard]] Model build() const&;
  /// The same without a copy, where the builder is not needed any more: std::move(builder).build().
  [[nodiscard]] Model build() &&;

 private:
  void check_link_index(int link, std::string_view what) const;

  Model model_;
  std::vector<RigidTransform<double>> rest_poses_;       // per link
  std::unordered_set<int> driven_links_;                 // those whose joints have a motor
  std::unordered_map<std::string, int> next_duplicate_;  // of a contact's name: number to try next
};

/// A homogeneous solid body.
///
/// @param density  mass per volume, > 0
/// @param X_JB     body frame (centre of mass, principal axes) in the joint frame
/// @throws InvalidInput as solid_mass_properties
[[nodiscard]] Body solid_body(std::string name, const Shape& shape, double density,
                              const RigidTransform<double>& X_JB = {});

}  // namespace hbar
