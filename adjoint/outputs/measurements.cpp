#include "hbar/adjoint/outputs/measurements.h"

#include <algorithm>

#include "hbar/contact/contact_parameters.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/rotation.h"
#include "hbar/core/dynamics/joint_forces.h"

namespace hbar {
namespace {

/// Velocity of a body's material at x.
template <Scalar S>
Vector3<S> velocity_at(const BodyMotion<S>& body, const Vector3<S>& x) {
  return body.V.template tail<3>() + Vector3<S>(body.V.template head<3>()).cross(x);
}

/// The surface of a BodyDistance with present sizes.
template <Scalar S>
SurfaceDistance<S> measured_surface(const Model& model, const Mechanism<S>& mechanism,
                                    const BodyDistance& m) {
  const int owner = std::max(m.other, 0);  // a plane reads neither shape nor sizes
  return {m.surface, model.link(owner).body.shape, mechanism.sizes.col(owner)};
}

/// Rotation from the wanted orientation to the body's.
template <Scalar S>
Matrix3<S> orientation_error(const Orientation& m, const BodyMotion<S>& body) {
  return m.R_0T.transpose().cast<S>() * body.X_WB.R;
}

/// Visits what a motor drives: visit(coordinate, control, MotorForce at the present state).
template <Scalar S, typename Visit>
void for_each_motor_force(const Model& model, const Mechanism<S>& mechanism, int motor,
                          const VectorView<S>& q, const VectorView<S>& qdot, const VectorView<S>& u,
                          const Visit& visit) {
  const CoordinateRange range =
      model.coordinates_of_link(model.motors()[static_cast<std::size_t>(motor)].link);
  for (int c = range.begin; c < range.end; ++c) {
    const int i = model.first_control(motor) + c - range.begin;
    visit(c, i, motor_force<S>(model, mechanism, motor, u[i], q[c], qdot[c]));
  }
}

}  // namespace

/// What rows are read from.
template <Scalar S>
struct Measurements<S>::Instant {
  const Mechanism<S>& mechanism;
  const Motion<S>& motion;
  const VectorView<S>& q;
  const VectorView<S>& qdot;
  const VectorView<S>& u;

  [[nodiscard]] BodyMotion<S> body(const Model& model, int link) const {
    return body_motion<S>(model, mechanism, motion, link);
  }
};

/// Where weights go.
template <Scalar S>
struct Measurements<S>::Gradients {
  const ParameterSet& set;
  const VectorView<S>& values;  ///< p
  Eigen::Ref<VectorX<S>>& by_q;
  Eigen::Ref<VectorX<S>>& by_qdot;
  Eigen::Ref<VectorX<S>>& by_u;
  Eigen::Ref<VectorX<S>>& by_p;

  void add_parameter(ParameterKind kind, int owner, int component, const S& gradient) {
    const int i = set.index(kind, owner, component);
    if (i >= 0) {
      by_p[i] += gradient;
    }
  }
  /// A motor's force on coordinate c, of control i, with a weight on it.
  void add_force(int motor, int c, int i, const MotorForce<S>& force, const S& weight) {
    by_q[c] += weight * force.by_q;
    by_qdot[c] += weight * force.by_qdot;
    by_u[i] += weight * force.by_u;
    add_parameter(ParameterKind::kMotorP, motor, 0, weight * force.by_P);
    add_parameter(ParameterKind::kMotorD, motor, 0, weight * force.by_D);
  }
};

template <Scalar S>
Measurements<S>::Measurements(const Model& model, std::vector<Measurement> measurements)
    : model_(model), measurements_(std::move(measurements)), links_(model) {
  check_measurements(model, measurements_);
  for (const Measurement& measurement : measurements_) {
    first_.push_back(size());
    const std::vector<std::string> rows = row_names(model, measurement);
    names_.insert(names_.end(), rows.begin(), rows.end());
    if (std::holds_alternative<ContactForce>(measurement) && !contacts_) {
      contacts_.emplace(model);
      contact_weights_.resize(model.contacts().size());
    }
  }
  first_.push_back(size());
}

template <Scalar S>
void Measurements<S>::readings(const Mechanism<S>& mechanism, const Motion<S>& motion,
                               const VectorView<S>& q, const VectorView<S>& qdot,
                               const VectorView<S>& u, Eigen::Ref<VectorX<S>> out) {
  if (contacts_) {
    contacts_->linearize(mechanism, motion);
  }
  const Instant at{mechanism, motion, q, qdot, u};
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    std::visit(
        [&](const auto& m) { read(m, at, out.segment(first_[i], first_[i + 1] - first_[i])); },
        measurements_[i]);
  }
}

template <Scalar S>
void Measurements<S>::pull_back(const Mechanism<S>& mechanism, const ParameterSet& set,
                                const VectorView<S>& p, const Motion<S>& motion,
                                const VectorView<S>& q, const VectorView<S>& qdot,
                                const VectorView<S>& u, const VectorView<S>& y,
                                Eigen::Ref<VectorX<S>> by_q, Eigen::Ref<VectorX<S>> by_qdot,
                                Eigen::Ref<VectorX<S>> by_u, Eigen::Ref<VectorX<S>> grad_p) {
  const Instant at{mechanism, motion, q, qdot, u};
  Gradients out{set, p, by_q, by_qdot, by_u, grad_p};
  links_.clear();
  for (Eigen::Matrix<S, 4, 1>& weight : contact_weights_) {
    weight.setZero();
  }
  for (std::size_t i = 0; i < measurements_.size(); ++i) {
    std::visit(
        [&](const auto& m) { weigh(m, at, y.segment(first_[i], first_[i + 1] - first_[i]), out); },
        measurements_[i]);
  }
  if (contacts_) {
    contacts_->linearize(mechanism, motion);
    weigh_contacts(at, out);
  }
  links_.sum();
  links_.add_coordinates(motion, by_q);
  links_.add_rates(motion, by_qdot);
  links_.add_frames(mechanism, set, p, motion, grad_p);
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
void Measurements<S>::read(const PointVelocity& m, const Instant& at, Rows out) const {
  const BodyMotion<S> body = at.body(model_, m.link);
  out = velocity_at<S>(body, body.X_WB.R * m.point.cast<S>() + body.X_WB.p);
}

template <Scalar S>
void Measurements<S>::weigh(const PointVelocity& m, const Instant& at, const VectorView<S>& y,
                            Gradients&) {
  const BodyMotion<S> body = at.body(model_, m.link);
  weigh_velocity(body, m.link, body.X_WB.R * m.point.cast<S>() + body.X_WB.p, y);
}

template <Scalar S>
void Measurements<S>::read(const Orientation& m, const Instant& at, Rows out) const {
  out = log_rotation(orientation_error<S>(m, at.body(model_, m.link)));
}

template <Scalar S>
void Measurements<S>::weigh(const Orientation& m, const Instant& at, const VectorView<S>& y,
                            Gradients&) {
  const Vector3<S> r = log_rotation(orientation_error<S>(m, at.body(model_, m.link)));
  // A turn by w of the body makes of exp([r]) exp([R_0Tᵀ w]) exp([r]): δr = J_r(r)⁻ᵀ R_0Tᵀ w.
  const Vector3<S> torque = m.R_0T.cast<S>() * (right_jacobian_inverse<S>(r) * y);
  links_.add_to_body(m.link, spatial<S>(torque, Vector3<S>::Zero()), Vector6<S>::Zero());
}

template <Scalar S>
void Measurements<S>::read(const BodyDistance& m, const Instant& at, Rows out) const {
  const RigidTransform<S> X_BA =
      inverse(at.body(model_, m.other).X_WB) * at.body(model_, m.link).X_WB;
  const Vector3<S> x_B = X_BA.R * m.point.cast<S>() + X_BA.p;
  out[0] = measured_surface<S>(model_, at.mechanism, m).sample(x_B).d - m.radius;
}

template <Scalar S>
void Measurements<S>::weigh(const BodyDistance& m, const Instant& at, const VectorView<S>& y,
                            Gradients& out) {
  const RigidTransform<S> X_WA = at.body(model_, m.link).X_WB;
  const RigidTransform<S> X_WB = at.body(model_, m.other).X_WB;
  const Vector3<S> x = X_WA.R * m.point.cast<S>() + X_WA.p;
  const Vector3<S> x_B = X_WB.R.transpose() * (x - X_WB.p);
  const SurfaceDistance<S> surface = measured_surface<S>(model_, at.mechanism, m);
  const Vector3<S> force = y[0] * (X_WB.R * surface.sample(x_B).gradient);
  const Vector6<S> by_displacement = spatial<S>(x.cross(force), force);
  links_.add_to_body(m.link, by_displacement, Vector6<S>::Zero());
  if (m.other >= 0) {
    links_.add_to_body(m.other, -by_displacement, Vector6<S>::Zero());
  }
  for (int k = 0; k < surface.size_count(); ++k) {
    out.add_parameter(ParameterKind::kSize, m.other, k, y[0] * surface.by_size(x_B, k).d);
  }
}

template <Scalar S>
void Measurements<S>::read(const ContactForce& m, const Instant&, Rows out) const {
  out.setZero();
  for (const ActivePair<S>& pair : contacts_->active()) {
    if (pair.contact == m.contact) {
      for (const TouchingPoint<S>& point : contacts_->points(pair)) {
        out[0] += point.force.normal;
        out.template tail<3>() += point.force.f;
      }
    }
  }
}

template <Scalar S>
void Measurements<S>::weigh(const ContactForce& m, const Instant&, const VectorView<S>& y,
                            Gradients&) {
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
    // Both bodies displaced alike turn f and leave f_n as it is.
    const Vector6<S> turned = spatial<S>(point.force.f.cross(fixed), Vector3<S>::Zero());
    Vector6<S> by_other_twist = -by_twist;
    if (contact.reaction == Reaction::kSurface) {
      by_other_twist.template head<3>() += (point.d * point.n).cross(by_u);
    }
    links_.add_to_body(contact.other, turned - by_displacement, by_other_twist);
  }
}

template <Scalar S>
void Measurements<S>::weigh_contacts(const Instant& at, Gradients& out) {
  for (const ActivePair<S>& pair : contacts_->active()) {
    const auto& weight = contact_weights_[static_cast<std::size_t>(pair.contact)];
    for (const TouchingPoint<S>& point : contacts_->points(pair)) {
      weigh_touch(pair, point, weight);
    }
  }
  for_each_point_change(
      *contacts_, at.mechanism, out.set,
      [&](int i, const ActivePair<S>& pair, const TouchingPoint<S>& point,
          const PointChange<S>& change) {
        const auto& weight = contact_weights_[static_cast<std::size_t>(pair.contact)];
        const Reaction reaction = model_.contact(pair.contact).reaction;
        const Vector3<S> f =
            wrench_change<S>(reaction, pair.motion, point, change).on_a.template tail<3>();
        const Vector3<S> n = point.dn_dx * change.x + change.n;
        out.by_p[i] +=
            f.dot(weight.template tail<3>()) + weight[0] * (f.dot(point.n) + point.force.f.dot(n));
      });
}

template <Scalar S>
void Measurements<S>::read(const MotorTorque& m, const Instant& at, Rows out) const {
  int row = 0;
  for_each_motor_force<S>(model_, at.mechanism, m.motor, at.q, at.qdot, at.u,
                          [&](int, int, const MotorForce<S>& force) { out[row++] = force.tau; });
}

template <Scalar S>
void Measurements<S>::weigh(const MotorTorque& m, const Instant& at, const VectorView<S>& y,
                            Gradients& out) {
  int row = 0;
  for_each_motor_force<S>(model_, at.mechanism, m.motor, at.q, at.qdot, at.u,
                          [&](int c, int i, const MotorForce<S>& force) {
                            out.add_force(m.motor, c, i, force, y[row++]);
                          });
}

template <Scalar S>
void Measurements<S>::read(const MotorPower& m, const Instant& at, Rows out) const {
  out[0] = S(0.0);
  for_each_motor_force<S>(
      model_, at.mechanism, m.motor, at.q, at.qdot, at.u,
      [&](int c, int, const MotorForce<S>& force) { out[0] += force.tau * at.qdot[c]; });
}

template <Scalar S>
void Measurements<S>::weigh(const MotorPower& m, const Instant& at, const VectorView<S>& y,
                            Gradients& out) {
  for_each_motor_force<S>(model_, at.mechanism, m.motor, at.q, at.qdot, at.u,
                          [&](int c, int i, const MotorForce<S>& force) {
                            out.by_qdot[c] += y[0] * force.tau;
                            out.add_force(m.motor, c, i, force, y[0] * at.qdot[c]);
                          });
}

/// What a weight on a link's mass means for the parameters that it follows.
template <Scalar S>
void Measurements<S>::weigh_mass(int link, const Instant& at, const S& weight,
                                 Gradients& out) const {
  const S& mass = at.mechanism.mass[link];
  const int nominal = out.set.index(ParameterKind::kMass, link, 0);
  if (nominal >= 0) {
    out.by_p[nominal] += weight * mass / out.values[nominal];
  }
  const Shape& shape = model_.link(link).body.shape;
  const Vector3<S> sizes = at.mechanism.sizes.col(link);
  for (int k = 0; k < size_count(shape); ++k) {
    const S growth = unit_solid_rate<S>(shape, sizes, k).mass / unit_solid<S>(shape, sizes).mass;
    out.add_parameter(ParameterKind::kSize, link, k, weight * mass * growth);
  }
}

template <Scalar S>
void Measurements<S>::read(const CentreOfMass&, const Instant& at, Rows out) const {
  out.setZero();
  for (int link = 0; link < model_.link_count(); ++link) {
    out += at.mechanism.mass[link] * at.body(model_, link).X_WB.p;
  }
  out /= at.mechanism.mass.sum();
}

template <Scalar S>
void Measurements<S>::weigh(const CentreOfMass& m, const Instant& at, const VectorView<S>& y,
                            Gradients& out) {
  Vector3<S> centre;
  read(m, at, centre);
  const Vector3<S> weight = y / at.mechanism.mass.sum();
  for (int link = 0; link < model_.link_count(); ++link) {
    const Vector3<S> x = at.body(model_, link).X_WB.p;
    const Vector3<S> force = at.mechanism.mass[link] * weight;
    links_.add_to_body(link, spatial<S>(x.cross(force), force), Vector6<S>::Zero());
    weigh_mass(link, at, weight.dot(x - centre), out);
  }
}

template <Scalar S>
void Measurements<S>::read(const LinearMomentum&, const Instant& at, Rows out) const {
  out.setZero();
  for (int link = 0; link < model_.link_count(); ++link) {
    const BodyMotion<S> body = at.body(model_, link);
    out += at.mechanism.mass[link] * velocity_at<S>(body, body.X_WB.p);
  }
}

template <Scalar S>
void Measurements<S>::weigh(const LinearMomentum&, const Instant& at, const VectorView<S>& y,
                            Gradients& out) {
  for (int link = 0; link < model_.link_count(); ++link) {
    const BodyMotion<S> body = at.body(model_, link);
    weigh_velocity(body, link, body.X_WB.p, at.mechanism.mass[link] * y);
    weigh_mass(link, at, y.dot(velocity_at<S>(body, body.X_WB.p)), out);
  }
}

template class Measurements<double>;
template class Measurements<Dual>;

}  // namespace hbar
