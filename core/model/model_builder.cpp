#include "hbar/core/model/model_builder.h"

#include <limits>
#include <utility>

#include "hbar/core/base/error.h"
#include "hbar/core/base/unit_vector.h"
#include "hbar/core/model/moments.h"

namespace hbar {
namespace {

constexpr double kOrthonormal = 1e-9;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

bool is_pose(const RigidTransform<double>& X) {
  return X.p.allFinite() && X.R.allFinite() &&
         (X.R.transpose() * X.R - Eigen::Matrix3d::Identity()).norm() < kOrthonormal &&
         X.R.determinant() > 0.0;
}

void require(bool condition, const std::string& message) {
  if (!condition) {
    throw InvalidInput(message);
  }
}

void normalise(Eigen::Vector3d& axis, const std::string& where) {
  require(axis.allFinite() && !axis.isZero(0.0),
          concat(where, ": axis is (", listed(axis), "); it must be a non-zero vector"));
  axis = unit_vector(axis);
}

/// Normalises the axes of a joint, where it has any.
void normalise_axes(JointKind& kind, const std::string& where) {
  std::visit(
      [&where](auto& joint) {
        if constexpr (requires { joint.axis; }) {
          normalise(joint.axis, where);
        } else if constexpr (requires { joint.axis0; }) {
          normalise(joint.axis0, where);
          normalise(joint.axis1, where);
          require(joint.axis0.cross(joint.axis1).norm() > 1e-9,
                  concat(where, ": axis0 and axis1 are parallel; they must span a plane"));
        }
      },
      kind);
}

void check_joint(Joint& joint) {
  const std::string where = concat("joint '", joint.name, "'");
  normalise_axes(joint.kind, where);
  require(is_pose(joint.X_PJ), where + ": X_PJ must be a rotation matrix and a finite position");
  require(joint.damping >= 0.0 && std::isfinite(joint.damping),
          concat(where, ": damping is ", joint.damping, "; it must be ≥ 0"));
  require(joint.stiffness >= 0.0 && std::isfinite(joint.stiffness),
          concat(where, ": stiffness is ", joint.stiffness, "; it must be ≥ 0"));
  const int dof = joint_dof(joint.kind);
  if (joint.rest.size() == 0) {
    joint.rest = Eigen::VectorXd::Zero(dof);
  }
  require(joint.rest.size() == dof && joint.rest.allFinite(),
          concat(where, ": rest has ", joint.rest.size(), " entries; it must have ", dof,
                 " finite ones"));
  if (joint.limits) {
    const JointLimits& limits = *joint.limits;
    require(limits.lower <= limits.upper,
            concat(where, ": limits are [", limits.lower, ", ", limits.upper,
                   "]; the lower must not exceed the upper"));
    require(limits.stiffness >= 0.0 && std::isfinite(limits.stiffness),
            concat(where, ": limit stiffness is ", limits.stiffness, "; it must be ≥ 0"));
  }
}

void check_body(const Body& body) {
  const std::string where = concat("body '", body.name, "'");
  require(is_pose(body.X_JB), where + ": X_JB must be a rotation matrix and a finite position");
  require(body.mass > 0.0 && std::isfinite(body.mass),
          concat(where, ": mass is ", body.mass, "; it must be positive"));
  const Eigen::Vector3d& I = body.inertia;
  require(I.allFinite() && I.minCoeff() > 0.0,
          concat(where, ": principal moments are (", listed(I), "); they must be positive"));
  require(excess_of_moments(I) <= kRoundedMoments,
          concat(where, ": principal moments are (", listed(I),
                 "); none may exceed the sum of the other two, as one does by ",
                 excess_of_moments(I), " of it"));
  require(body.contact_points.allFinite(), where + ": its contact points must be finite");
}

void check_coefficients(const ContactCoefficients& c, const std::string& where) {
  for (const auto& [value, name] : {std::pair{c.kn, "kn"}, std::pair{c.kt, "kt"},
                                    std::pair{c.mu, "mu"}, std::pair{c.damping, "damping"}}) {
    require(value >= 0.0 && std::isfinite(value),
            concat(where, ": ", name, " is ", value, "; it must be ≥ 0 and finite"));
  }
}

void check_surface(const Model& model, const Contact& contact, const std::string& where) {
  using Field = std::shared_ptr<const DistanceField>;
  if (const auto* plane = std::get_if<Plane>(&contact.surface)) {
    require(plane->point.allFinite() && std::abs(plane->normal.norm() - 1.0) < 1e-9,
            where + ": a plane needs a finite point and a normal of length 1");
    return;
  }
  require(contact.other != -1, where + ": the world touches as a plane only");
  if (const auto* field = std::get_if<Field>(&contact.surface)) {
    require(*field != nullptr, where + ": the distance field is null");
    return;
  }
  const Body& other = model.link(contact.other).body;
  require(!std::holds_alternative<NoShape>(other.shape),
          concat(where, ": body '", other.name,
                 "' has no shape of its own; give a plane or a distance field"));
}

void check_contact(const Model& model, const Contact& contact) {
  const std::string where = concat("contact '", contact.name, "'");
  const Body& body = model.link(contact.link).body;
  require(contact.link != contact.other, where + ": a body cannot touch itself");
  check_surface(model, contact, where);
  require(body.contact_points.cols() > 0 || touches_as_ball(model, contact),
          concat(where, ": body '", body.name,
                 "' has no contact points (see surface_points; a ball needs none but against a "
                 "distance field)"));
  check_coefficients(contact.coefficients, where);
  require(contact.friction_law != FrictionLaw::kSmooth ||
              (contact.friction_width > 0.0 && std::isfinite(contact.friction_width)),
          concat(where, ": friction width is ", contact.friction_width,
                 "; the smooth law needs it > 0"));
}

void check_tactile_sensor(const TactileSensor& sensor) {
  const std::string where = concat("tactile sensor '", sensor.name, "'");
  const Eigen::Index count = sensor.points.cols();
  require(count > 0 && sensor.points.allFinite(), where + ": it needs points, all finite");
  for (const Eigen::Matrix3Xd* axes : {&sensor.axis0, &sensor.axis1}) {
    require(axes->cols() == count,
            concat(where, ": ", axes->cols(), " axes for ", count, " points"));
    require(axes->allFinite() && (axes->colwise().norm().array() - 1.0).abs().maxCoeff() < 1e-9,
            where + ": axes must have length 1");
  }
  check_coefficients(sensor.coefficients, where);
}

}  // namespace

ModelBuilder::ModelBuilder(std::string name, Units units) {
  model_.name_ = std::move(name);
  model_.units_ = units;
}

ModelBuilder& ModelBuilder::set_gravity(const Eigen::Vector3d& gravity) {
  require(gravity.allFinite(), "gravity must be finite");
  model_.gravity_ = gravity;
  return *this;
}

void ModelBuilder::check_link_index(int link, std::string_view what) const {
  require(link >= 0 && link < model_.link_count(),
          concat(what, ": link ", link, " does not exist; the model has ", model_.link_count(),
                 " links"));
}

int ModelBuilder::add_link(int parent, Joint joint, Body body, std::string name,
                           unsigned design_mask) {
  if (name.empty()) {
    name = !body.name.empty() ? body.name : joint.name;
  }
  require(!name.empty(), "add_link: the link, its joint or its body must have a name");
  if (joint.name.empty()) {
    joint.name = name;
  }
  if (body.name.empty()) {
    body.name = name;
  }
  if (parent != -1) {
    check_link_index(parent, concat("link '", name, "', parent"));
  }
  require(!model_.link_names_.contains(name), concat("link '", name, "': this name is taken"));
  require(!model_.joint_names_.contains(joint.name),
          concat("joint '", joint.name, "': this name is taken"));
  require(!model_.body_names_.contains(body.name),
          concat("body '", body.name, "': this name is taken"));
  require(design_mask <= kMaskAll, concat("link '", name, "': design mask is ", design_mask,
                                          "; it must be a sum of 1, 2, 4, 8, 16, 32"));
  check_joint(joint);
  check_body(body);
  model_.link_names_.add(name);
  model_.joint_names_.add(joint.name);
  model_.body_names_.add(body.name);
  const int index = model_.link_count();
  const int parent_node = parent == -1 ? -1 : model_.node_of_link(parent);
  model_.node_of_link_.push_back(model_.tree_.add_joint(joint.kind, parent_node, index));
  model_.point_clusters_.push_back(cluster_points(body.contact_points));
  model_.is_tested_.push_back(0);
  rest_poses_.push_back(parent == -1 ? joint.X_PJ : rest_pose(parent) * joint.X_PJ);
  model_.links_.push_back(
      {std::move(name), parent, std::move(joint), std::move(body), design_mask});
  return index;
}

int ModelBuilder::add_motor(const Motor& motor) {
  check_link_index(motor.link, "motor");
  const Link& link = model_.link(motor.link);
  const std::string where = concat("motor on joint '", link.joint.name, "'");
  const int dof = joint_dof(link.joint.kind);
  require(dof > 0, where + ": a fixed joint has no coordinate to drive");
  require(!driven_links_.contains(motor.link), where + ": this joint has a motor already");
  require(motor.lower <= motor.upper, concat(where, ": range is [", motor.lower, ", ", motor.upper,
                                             "]; the lower must not exceed the upper"));
  const bool limited = std::isfinite(motor.lower) && std::isfinite(motor.upper);
  require(limited || (motor.lower == -kUnlimited && motor.upper == kUnlimited),
          where + ": a range must have both ends or none");
  require(std::isfinite(motor.P) && motor.P >= 0.0 && std::isfinite(motor.D) && motor.D >= 0.0,
          concat(where, ": P is ", motor.P, " and D is ", motor.D, "; both must be ≥ 0"));
  model_.first_control_.push_back(model_.control_count_);
  model_.control_count_ += dof;
  model_.motors_.push_back(motor);
  driven_links_.insert(motor.link);
  return static_cast<int>(model_.motors_.size()) - 1;
}

int ModelBuilder::add_end_effector(EndEffector end_effector) {
  check_link_index(end_effector.link, "end effector");
  const std::size_t index = model_.end_effectors_.size();
  if (end_effector.name.empty()) {
    end_effector.name = concat("endeffector", index);
  }
  require(end_effector.position.allFinite(),
          concat("end effector '", end_effector.name, "': position must be finite"));
  model_.end_effectors_.push_back(std::move(end_effector));
  return static_cast<int>(index);
}

int ModelBuilder::add_contact(Contact contact) {
  check_link_index(contact.link, "contact, points");
  if (contact.other != -1) {
    check_link_index(contact.other, "contact, other body");
  }
  if (contact.name.empty()) {
    contact.name =
        concat(model_.link(contact.link).body.name, '-',
               contact.other == -1 ? std::string("ground") : model_.link(contact.other).body.name);
    const std::string base = contact.name;
    for (int& i = next_duplicate_.try_emplace(base, 2).first->second;
         model_.contact_names_.contains(contact.name); ++i) {
      contact.name = concat(base, '-', i);
    }
  }
  require(!model_.contact_names_.contains(contact.name),
          concat("contact '", contact.name, "': this name is taken"));
  check_contact(model_, contact);
  model_.contact_names_.add(contact.name);
  model_.is_tested_[static_cast<std::size_t>(contact.link)] = 1;
  model_.contacts_.push_back(std::move(contact));
  return model_.contact_count() - 1;
}

int ModelBuilder::add_tactile_sensor(TactileSensor sensor) {
  check_link_index(sensor.link, "tactile sensor");
  const std::size_t index = model_.tactile_sensors_.size();
  if (sensor.name.empty()) {
    sensor.name = concat("tactile", index);
  }
  check_tactile_sensor(sensor);
  model_.tactile_count_ += 3 * static_cast<int>(sensor.points.cols());
  model_.tactile_sensors_.push_back(std::move(sensor));
  return static_cast<int>(index);
}

RigidTransform<double> ModelBuilder::rest_pose(int link) const {
  check_link_index(link, "rest_pose");
  return rest_poses_[static_cast<std::size_t>(link)];
}

Model ModelBuilder::build() const& {
  require(!model_.links_.empty(), concat("model '", model_.name_, "' has no link"));
  return model_;
}

Model ModelBuilder::build() && {
  require(!model_.links_.empty(), concat("model '", model_.name_, "' has no link"));
  return std::move(model_);
}

Body solid_body(std::string name, const Shape& shape, double density,
                const RigidTransform<double>& X_JB) {
  const MassProperties properties = solid_mass_properties(shape, density);
  return {std::move(name), X_JB, properties.mass, properties.inertia, shape};
}

}  // namespace hbar
