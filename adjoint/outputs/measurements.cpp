#include "hbar/adjoint/outputs/measurements.h"

#include <algorithm>
#include <utility>

#include "hbar/contact/contact_parameters.h"
#include "hbar/core/base/rotation.h"
#include "hbar/core/dynamics/joint_forces.h"
#include "hbar/core/model/drives.h"
#include "hbar/core/parameters/parameter_kinds.h"

namespace hbar {
namespace {

template <Scalar S>
BodyMotion<S> body_at(const Model& model, const Instant<S>& at, int link) {
  return body_motion<S>(model, at.applied.mechanism, at.motion, link);
}

/// Velocity of a body's material at x.
template <Scalar S>
Vector3<S> velocity_at(const BodyMotion<S>& body, const Vector3<S>& x) {
  return body.V.template tail<3>() + Vector3<S>(body.V.template head<3>()).cross(x);
}

/// The surface of a BodyDistance with current sizes.
template <Scalar S>
SurfaceDistance<S> measured_surface(const Model& model, const Mechanism<S>& mechanism,
                                    const BodyDistance& m) {
  const int owner = std::max(m.other, 0);  // a plane reads neither shape nor sizes
  return {m.surface, model.link(owner).body.shape, mechanism.sizes.col(owner)};
}

/// Rotation from the desired orientation to the body's.
template <Scalar S>
Matrix3<S> orientation_error(const Orientation& m, const BodyMotion<S>& body) {
  return m.R_0T.transpose().cast<S>() * body.X_WB.R;
}

/// Where an end effector is.
template <Scalar S>
Vector3<S> position_of(const Model& model, const Instant<S>& at, const EndEffectorPosition& m) {
  const EndEffector& point = model.end_effectors()[static_cast<std::size_t>(m.end_effector)];
  const NodeMotion<S>& node = at.motion.at(model.node_of_link(point.link));
  return node.p + node.R * point.position.cast<S>();
}

/// Visits what a motor drives: visit(coordinate, control, MotorForce at the present state).
template <Scalar S, typename Visit>
void for_each_motor_force(const Model& model, const Instant<S>& at, int motor, const Visit& visit) {
  for_each_drive(model, motor, [&](int c, int i) {
    visit(c, i, motor_force<S>(model, at.applied.mechanism, motor, at.u[i], at.q[c], at.qdot[c]));
  });
}

template <Scalar S>
void add_parameter(const Instant<S>& at, ParameterKind kind, int owner, int component,
                   const S& gradient, InstantGradient<S>& out) {
  const int i = at.applied.set.index(kind, owner, component);
  if (i >= 0) {
    out.p[i] += gradient;
  }
}

/// A motor's force on coordinate c, of control i, with a weight on it.
template <Scalar S>
void add_force(const Instant<S>& at, int motor, int c, int i, const MotorForce<S>& force,
               const S& weight, InstantGradient<S>& out) {
  out.q[c] += weight * force.by_q;
  out.qdot[c] += weight * force.by_qdot;
  out.u[i] += weight * force.by_u;
  add_parameter<S>(at, ParameterKind::kMotorP, motor, 0, weight * force.by_P, out);
  add_parameter<S>(at, ParameterKind::kMotorD, motor, 0, weight * force.by_D, out);
}

/// Whether weights have any effect; dual weights count even if only their slope is non-zero.
template <Scalar S, typename Weights>
bool counts(const Weights& weights) {
  return std::any_of(weights.begin(), weights.end(), [](const S& weight) {
    if constexpr (std::same_as<S, Dual>) {
      return weight.value != 0.0 || weight.slope != 0.0;
    } else {
      return weight != 0.0;
    }
  });
}

}  // namespace

template <Scalar S>
Measurements<S>::Measurements(const Model& model, std::vector<Measurement> measurements)
    : model_(model), measurements_(std::move(measurements)), links_(model), tactile_(model) {
  for (const Measurement& measurement : measurements_) {
    first_.push_back(size());
    const std::vector<std::string> rows = row_names(model, measurement);
    names_.insert(names_.end(), rows.begin(), rows.end());
    reads_contacts_ = reads_contacts_ || std::holds_alternative<ContactForce>(measurement);
  }
  first_.push_back(size());
  contact_weights_.resize(reads_contacts_ ? model.contacts().size() : 0);
}

template <Scalar S>
void Measurements<S>::linearize(const Instant<S>& at) {
  if (!model_.tactile_sensors().empty()) {
    tactile_.linearize(at.applied.mechanism, at.motion);
  }
}

template <Scalar S>
void Measurements<S>::read(const Instant<S>& at, Eigen::Ref<VectorX<S>> out) const {
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    std::visit(
        [&](const auto& m) { read(m, at, out.segment(first_[i], first_[i + 1] - first_[i])); },
        measurements_[i]);
  }
}

template <Scalar S>
void Measurements<S>::pull_back(const Instant<S>& at, const VectorView<S>& y,
                                InstantGradient<S>& out) {
  links_.clear();
  for (Eigen::Matrix<S, 4, 1>& weight : contact_weights_) {
    weight.setZero();
  }
  bool any = false;
  bool any_contact = false;
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    const auto weights = y.segment(first_[i], first_[i + 1] - first_[i]);
    if (counts<S>(weights)) {
      any = true;
      any_contact = any_contact || std::holds_alternative<ContactForce>(measurements_[i]);
      std::visit([&](const auto& m) { weigh(m, at, weights, out); }, measurements_[i]);
    }
  }
  if (!any) {
    return;
  }
  if (any_contact) {
    weigh_contacts(at, out);
  }
  links_.sum();
  links_.add_coordinates(at.motion, out.q);
  links_.add_rates(at.motion, out.qdot);
  links_.add_frames(at.applied, at.motion, out.p);
}

template <Scalar S>
void Measurements<S>::weigh_velocity(const BodyMotion<S>& body, int link, const Vector3<S>& x,
                                     const Vector3<S>& weight) {
  // δ(ν + ω × x) = δν + δω × x + ω × δx.
  const Vector3<S> by_x = weight.cross(Vector3<S>(body.V.template head<3>()));
  const Vector6<S> by_twist = spatial<S>(x.cross(weight), weight);
  links_.add_to_body(
      link, sum<S>(spatial<S>(x.cross(by_x), by_x), cross_wrench<S>(body.V, by_twist)), by_twist);
}

template <Scalar S>
void Measurements<S>::read(const PointVelocity& m, At at, Rows out) const {
  const BodyMotion<S> body = body_at<S>(model_, at, m.link);
  out = velocity_at<S>(body, body.X_WB.R * m.point.cast<S>() + body.X_WB.p);
}

template <Scalar S>
void Measurements<S>::weigh(const PointVelocity& m, At at, Weights y, Out) {
  const BodyMotion<S> body = body_at<S>(model_, at, m.link);
  weigh_velocity(body, m.link, body.X_WB.R * m.point.cast<S>() + body.X_WB.p, y);
}

template <Scalar S>
void Measurements<S>::read(const Orientation& m, At at, Rows out) const {
  out = log_rotation(orientation_error<S>(m, body_at<S>(model_, at, m.link)));
}

template <Scalar S>
void Measurements<S>::weigh(const Orientation& m, At at, Weights y, Out) {
  const Vector3<S> r = log_rotation(orientation_error<S>(m, body_at<S>(model_, at, m.link)));
  // Rotating the body by w turns exp([r]) into exp([R_0Tᵀ w]) exp([r]): δr = J_r(r)⁻ᵀ R_0Tᵀ w.
  const Vector3<S> torque = m.R_0T.cast<S>() * (right_jacobian_inverse<S>(r) * y);
  links_.add_to_body(m.link, spatial<S>(torque, Vector3<S>::Zero()), Vector6<S>::Zero());
}

template <Scalar S>
void Measurements<S>::read(const BodyDistance& m, At at, Rows out) const {
  const RigidTransform<S> X_BA =
      inverse(body_at<S>(model_, at, m.other).X_WB) * body_at<S>(model_, at, m.link).X_WB;
  const Vector3<S> x_B = X_BA.R * m.point.cast<S>() + X_BA.p;
  out[0] = measured_surface<S>(model_, at.applied.mechanism, m).sample(x_B).d - m.radius;
}

template <Scalar S>
void Measurements<S>::weigh(const BodyDistance& m, At at, Weights y, Out out) {
  const RigidTransform<S> X_WA = body_at<S>(model_, at, m.link).X_WB;
  const RigidTransform<S> X_WB = body_at<S>(model_, at, m.other).X_WB;
  const Vector3<S> x = X_WA.R * m.point.cast<S>() + X_WA.p;
  const Vector3<S> x_B = X_WB.R.transpose() * (x - X_WB.p);
  const SurfaceDistance<S> surface = measured_surface<S>(model_, at.applied.mechanism, m);
  const Vector3<S> force = y[0] * (X_WB.R * surface.sample(x_B).gradient);
  const Vector6<S> by_displacement = spatial<S>(x.cross(force), force);
  links_.add_to_body(m.link, by_displacement, Vector6<S>::Zero());
  if (m.other >= 0) {
    links_.add_to_body(m.other, -by_displacement, Vector6<S>::Zero());
  }
  for (int k = 0; k < surface.size_count(); ++k) {
    add_parameter<S>(at, ParameterKind::kSize, m.other, k, y[0] * surface.by_size(x_B, k).d, out);
  }
}

template <Scalar S>
void Measurements<S>::read(const ContactForce& m, At at, Rows out) const {
  out.setZero();
  for (const ActivePair<S>& pair : at.contacts->active()) {
    if (pair.contact == m.contact) {
      for (const TouchingPoint<S>& point : at.contacts->points(pair)) {
        out[0] += point.force.normal;
        out.template tail<3>() += point.force.f;
      }
    }
  }
}

template <Scalar S>
void Measurements<S>::weigh(const ContactForce& m, At, Weights y, Out) {
  contact_weights_[static_cast<std::size_t>(m.contact)] += y;
}

/// Covectors of w₀ f_n + w·f on both bodies. Friction is across the normal, so that f_n = n·f.
template <Scalar S>
void Measurements<S>::weigh_touch(const ActivePair<S>& pair, const TouchingPoint<S>& point,
                                  const Eigen::Matrix<S, 4, 1>& weight) {
  const Contact& contact = model_.contact(pair.contact);
  const Vector3<S> fixed = weight.template tail<3>();
  const Vector3<S> by_force = fixed + weight[0] * point.n;
  const Matrix3<S> force_slope = point_slopes<S>(contact.reaction, pair.motion, point).force;
  const Vector3<S> by_lever =
      force_slope.transpose() * by_force + point.dn_dx.transpose() * (weight[0] * point.force.f);
  const Vector3<S> by_u = point.law.by_u.transpose() * by_force;
  const Vector6<S> by_twist = spatial<S>(point.x.cross(by_u), by_u);
  const Vector6<S> by_displacement = sum<S>(spatial<S>(point.lever.cross(by_lever), by_lever),
                                            cross_wrench<S>(pair.motion.a.V, by_twist));
  links_.add_to_body(contact.link, by_displacement, by_twist);
  if (contact.other >= 0) {
    // Displacing both bodies alike rotates f and leaves f_n unchanged.
    const Vector6<S> turned = spatial<S>(point.force.f.cross(fixed), Vector3<S>::Zero());
    Vector6<S> by_other_twist = -by_twist;
    if (contact.reaction == Reaction::kSurface) {
      by_other_twist.template head<3>() += (point.d * point.n).cross(by_u);
    }
    links_.add_to_body(contact.other, turned - by_displacement, by_other_twist);
  }
}

template <Scalar S>
void Measurements<S>::weigh_contacts(At at, Out out) {
  for (const ActivePair<S>& pair : at.contacts->active()) {
    const auto& weight = contact_weights_[static_cast<std::size_t>(pair.contact)];
    for (const TouchingPoint<S>& point : at.contacts->points(pair)) {
      weigh_touch(pair, point, weight);
    }
  }
  for_each_point_change(
      *at.contacts, at.applied,
      [&](int i, const ActivePair<S>& pair, const TouchingPoint<S>& point,
          const PointChange<S>& change) {
        const auto& weight = contact_weights_[static_cast<std::size_t>(pair.contact)];
        const Reaction reaction = model_.contact(pair.contact).reaction;
        const Vector3<S> f =
            wrench_change<S>(reaction, pair.motion, point, change).on_a.template tail<3>();
        const Vector3<S> n = point.dn_dx * change.x + change.n;
        out.p[i] +=
            f.dot(weight.template tail<3>()) + weight[0] * (f.dot(point.n) + point.force.f.dot(n));
      });
}

template <Scalar S>
void Measurements<S>::read(const MotorTorque& m, At at, Rows out) const {
  int row = 0;
  for_each_motor_force<S>(model_, at, m.motor,
                          [&](int, int, const MotorForce<S>& force) { out[row++] = force.tau; });
}

template <Scalar S>
void Measurements<S>::weigh(const MotorTorque& m, At at, Weights y, Out out) {
  int row = 0;
  for_each_motor_force<S>(model_, at, m.motor, [&](int c, int i, const MotorForce<S>& force) {
    add_force<S>(at, m.motor, c, i, force, y[row++], out);
  });
}

template <Scalar S>
void Measurements<S>::read(const MotorPower& m, At at, Rows out) const {
  out[0] = S(0.0);
  for_each_motor_force<S>(model_, at, m.motor, [&](int c, int, const MotorForce<S>& force) {
    out[0] += force.tau * at.qdot[c];
  });
}

template <Scalar S>
void Measurements<S>::weigh(const MotorPower& m, At at, Weights y, Out out) {
  for_each_motor_force<S>(model_, at, m.motor, [&](int c, int i, const MotorForce<S>& force) {
    out.qdot[c] += y[0] * force.tau;
    add_force<S>(at, m.motor, c, i, force, y[0] * at.qdot[c], out);
  });
}

/// The effect of weights on the links' masses on the parameters that determine these masses.
///
/// @param weight  weight(link)
template <Scalar S>
template <typename Weight>
void Measurements<S>::weigh_masses(At at, const Weight& weight, Out out) const {
  for (const ParameterBlock& block : at.applied.set.blocks()) {
    const ParameterKindRow& kind = row_of(block.kind);
    if (kind.effect != ParameterEffect::kInertia) {
      continue;
    }
    const S by_mass = weight(block.owner);
    for (int i = block.first; i < block.first + block.size; ++i) {
      const InertiaRate<S> rate =
          kind.actions<S>().inertia_rate(model_, at.applied.mechanism, block.owner,
                                         {at.applied.set[i].component, at.applied.p[i]});
      out.p[i] += by_mass * rate.mass;
    }
  }
}

template <Scalar S>
void Measurements<S>::read(const CentreOfMass&, At at, Rows out) const {
  out.setZero();
  for (int link = 0; link < model_.link_count(); ++link) {
    out += at.applied.mechanism.mass[link] * body_at<S>(model_, at, link).X_WB.p;
  }
  out /= at.applied.mechanism.mass.sum();
}

template <Scalar S>
void Measurements<S>::weigh(const CentreOfMass& m, At at, Weights y, Out out) {
  Vector3<S> centre;
  read(m, at, centre);
  const Vector3<S> weight = y / at.applied.mechanism.mass.sum();
  const auto place = [&](int link) -> Vector3<S> { return body_at<S>(model_, at, link).X_WB.p; };
  for (int link = 0; link < model_.link_count(); ++link) {
    const Vector3<S> force = at.applied.mechanism.mass[link] * weight;
    links_.add_to_body(link, spatial<S>(place(link).cross(force), force), Vector6<S>::Zero());
  }
  weigh_masses(
      at, [&](int link) -> S { return weight.dot(place(link) - centre); }, out);
}

template <Scalar S>
void Measurements<S>::read(const LinearMomentum&, At at, Rows out) const {
  out.setZero();
  for (int link = 0; link < model_.link_count(); ++link) {
    const BodyMotion<S> body = body_at<S>(model_, at, link);
    out += at.applied.mechanism.mass[link] * velocity_at<S>(body, body.X_WB.p);
  }
}

template <Scalar S>
void Measurements<S>::weigh(const LinearMomentum&, At at, Weights y, Out out) {
  for (int link = 0; link < model_.link_count(); ++link) {
    const BodyMotion<S> body = body_at<S>(model_, at, link);
    weigh_velocity(body, link, body.X_WB.p, at.applied.mechanism.mass[link] * y);
  }
  const auto speed = [&](int link) -> S {
    const BodyMotion<S> body = body_at<S>(model_, at, link);
    return y.dot(velocity_at<S>(body, body.X_WB.p));
  };
  weigh_masses(at, speed, out);
}

template <Scalar S>
void Measurements<S>::read(const EndEffectorPosition& m, At at, Rows out) const {
  out = position_of<S>(model_, at, m);
}

template <Scalar S>
void Measurements<S>::weigh(const EndEffectorPosition& m, At at, Weights y, Out) {
  const Vector3<S> force = y;
  const EndEffector& point = model_.end_effectors()[static_cast<std::size_t>(m.end_effector)];
  links_.add_to_joint(point.link, spatial<S>(position_of<S>(model_, at, m).cross(force), force));
}

template <Scalar S>
void Measurements<S>::read(const TactileReading& m, At, Rows out) const {
  tactile_.read(m.sensor, out);
}

template <Scalar S>
void Measurements<S>::weigh(const TactileReading& m, At at, Weights y, Out out) {
  tactile_.pull_back(m.sensor, y, at.applied, links_, out.p);
}

template class Measurements<double>;
template class Measurements<Dual>;

}  // namespace hbar
