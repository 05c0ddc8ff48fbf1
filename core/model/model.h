#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/point_clusters.h"
#include "hbar/core/geometry/shape.h"
#include "hbar/core/model/contact.h"
#include "hbar/core/model/joint.h"
#include "hbar/core/model/name_index.h"
#include "hbar/core/model/tree.h"

namespace hbar {

/// The units of a scene. hbar computes in them and converts nothing.
enum class Units { kCentimetreGram, kMetreKilogram };

/// A rigid body. Its frame sits at the centre of mass along the principal axes.
struct Body {
  std::string name = {};
  RigidTransform<double> X_JB = {};                   ///< body frame in the joint frame
  double mass = 0.0;                                  ///< mass, > 0
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();  ///< principal moments, mass·length²  [3]
  Shape shape = NoShape{};
  Eigen::Matrix3Xd contact_points = {};  ///< in the body frame, length              [3 x points]

  friend bool operator==(const Body& a, const Body& b) {
    return a.name == b.name && a.X_JB == b.X_JB && a.mass == b.mass && a.inertia == b.inertia &&
           a.shape == b.shape && a.contact_points.cols() == b.contact_points.cols() &&
           a.contact_points == b.contact_points;
  }
};

/// Table II of the source named in doc/notation.md, as a bit mask over a link's parameters.
enum DesignMask : unsigned {
  kMaskJointTransform = 1,     ///< I
  kMaskBodyTransform = 2,      ///< II
  kMaskContactPoints = 4,      ///< III
  kMaskMassInertia = 8,        ///< IV
  kMaskStiffnessDamping = 16,  ///< V
  kMaskContactScale = 32,      ///< VI
  kMaskAll = 63
};

/// A joint and the body it carries.
struct Link {
  std::string name = {};
  int parent = -1;  ///< link, or −1 for the world; parent < this link
  Joint joint = {};
  Body body = {};
  unsigned design_mask = 0;  ///< DesignMask: the parameters a scene selects
  friend bool operator==(const Link&, const Link&) = default;
};

/// An actuator: one control per coordinate of its joint.
struct Motor {
  enum class Kind {
    kForce,    ///< u ∈ [−1, 1], clamped, mapped to [lower, upper]; without a range, u itself
    kPosition  ///< clamp(P (u − q) − D q̇, lower, upper)
  };
  int link = 0;  ///< the link whose joint it drives
  Kind kind = Kind::kForce;
  double lower = -std::numeric_limits<double>::infinity();  ///< generalised force
  double upper = std::numeric_limits<double>::infinity();   ///< generalised force
  double P = 0.0;                                           ///< force per displacement
  double D = 0.0;                                           ///< force·time per displacement
  bool implicit = false;  ///< position motors: q, q̇ at the end of the step, not at its start
  friend bool operator==(const Motor&, const Motor&) = default;
};

/// A point fixed in a link's joint frame whose world position is an auxiliary variable v.
struct EndEffector {
  std::string name = {};
  int link = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< in the joint frame, length    [3]
  friend bool operator==(const EndEffector& a, const EndEffector& b) {
    return a.name == b.name && a.link == b.link && a.position == b.position;
  }
};

/// A model: trees of links, motors, contacts, end effectors, sensors. Immutable; made by
/// ModelBuilder.
///
/// Thread-safe: every member function is const.
class Model {
 public:
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Units units() const { return units_; }
  [[nodiscard]] const Eigen::Vector3d& gravity() const { return gravity_; }  ///< length/time² [3]
  [[nodiscard]] const std::vector<Link>& links() const { return links_; }
  [[nodiscard]] const std::vector<Motor>& motors() const { return motors_; }
  [[nodiscard]] const std::vector<EndEffector>& end_effectors() const { return end_effectors_; }
  [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }
  /// @throws InvalidInput for an index that no contact has
  [[nodiscard]] const Contact& contact(int i) const {
    require_index("contact", i, contact_count());
    return contacts_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const std::vector<TactileSensor>& tactile_sensors() const {
    return tactile_sensors_;
  }
  [[nodiscard]] const Tree& tree() const { return tree_; }

  [[nodiscard]] int dof() const { return tree_.dof(); }               ///< n_r, coordinates
  [[nodiscard]] int control_count() const { return control_count_; }  ///< n_u
  [[nodiscard]] int variable_count() const {  ///< n_v, three per end effector
    return 3 * static_cast<int>(end_effectors_.size());
  }
  [[nodiscard]] int tactile_count() const { return tactile_count_; }  ///< three per sensor point
  [[nodiscard]] int contact_count() const { return static_cast<int>(contacts_.size()); }
  [[nodiscard]] int link_count() const { return static_cast<int>(links_.size()); }
  /// @throws InvalidInput for an index that no link has
  [[nodiscard]] const Link& link(int i) const {
    require_index("link", i, link_count());
    return links_[static_cast<std::size_t>(i)];
  }

  /// The contact points of a link's body in groups.
  [[nodiscard]] const PointClusters& point_clusters(int link) const {
    return point_clusters_[static_cast<std::size_t>(link)];
  }

  /// Whether a contact tests the points of a link's body.
  [[nodiscard]] bool is_tested(int link) const {
    return is_tested_[static_cast<std::size_t>(link)] != 0;
  }

  /// The last node of a link's joint: the one that carries its body.
  [[nodiscard]] int node_of_link(int link) const {
    return node_of_link_[static_cast<std::size_t>(link)];
  }
  /// The coordinates of a link's joint.
  [[nodiscard]] CoordinateRange coordinates_of_link(int link) const;
  /// First control of a motor; its joint's coordinates follow in order.
  [[nodiscard]] int first_control(int motor) const {
    return first_control_[static_cast<std::size_t>(motor)];
  }

  /// Name of coordinate i: the joint's name, and the coordinate's if there are several.
  [[nodiscard]] std::string coordinate_name(int i) const;
  /// Name of control i: the motor's joint, and the coordinate's if there are several.
  [[nodiscard]] std::string control_name(int i) const;

  /// Index of the link, joint, body or contact of that name.
  /// @throws InvalidInput naming the nearest existing name
  [[nodiscard]] int find_link(std::string_view link) const;
  [[nodiscard]] int find_joint(std::string_view joint) const;
  [[nodiscard]] int find_body(std::string_view body) const;
  [[nodiscard]] int find_contact(std::string_view contact) const;

  friend bool operator==(const Model& a, const Model& b) {
    return a.name_ == b.name_ && a.units_ == b.units_ && a.gravity_ == b.gravity_ &&
           a.links_ == b.links_ && a.motors_ == b.motors_ && a.end_effectors_ == b.end_effectors_ &&
           a.contacts_ == b.contacts_ && a.tactile_sensors_ == b.tactile_sensors_;
  }

 private:
  friend class ModelBuilder;

  std::string name_;
  Units units_ = Units::kMetreKilogram;
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
  std::vector<Link> links_;
  std::vector<PointClusters> point_clusters_;  // per link
  std::vector<char> is_tested_;                // per link
  std::vector<Motor> motors_;
  std::vector<EndEffector> end_effectors_;
  std::vector<Contact> contacts_;
  std::vector<TactileSensor> tactile_sensors_;
  Tree tree_;
  std::vector<int> node_of_link_;
  std::vector<int> first_control_;
  NameIndex link_names_;
  NameIndex joint_names_;
  NameIndex body_names_;
  NameIndex contact_names_;
  int control_count_ = 0;
  int tactile_count_ = 0;
};

/// Whether a contact acts at a ball's deepest point.
[[nodiscard]] bool touches_as_ball(const Model& model, const Contact& contact);

/// Units of length and mass in a unit system, in words: "m", "kg", ….
[[nodiscard]] std::string_view length_unit(Units units);
[[nodiscard]] std::string_view mass_unit(Units units);

}  // namespace hbar
