#include "hbar/core/dynamics/joint_forces.h"

namespace hbar {
namespace {

template <Scalar S>
void add_passive(const Model& model, const Mechanism<S>& mechanism, const VectorView<S>& q,
                 const VectorView<S>& qdot, JointForces<S>& forces) {
  for (int i = 0; i < model.link_count(); ++i) {
    const Joint& joint = model.link(i).joint;
    const CoordinateRange range = model.coordinates_of_link(i);
    const S& stiffness = mechanism.stiffness[i];
    const S& damping = mechanism.damping[i];
    for (int c = range.begin; c < range.end; ++c) {
      const S stretch = q[c] - joint.rest[c - range.begin];
      forces.by_stiffness[c] = -stretch;
      forces.by_damping[c] = -qdot[c];
      forces.tau[c] = -stiffness * stretch - damping * qdot[c];
      forces.by_q[c] = -stiffness;
      forces.by_qdot[c] = -damping;
      if (joint.limits) {
        const JointLimits& limits = *joint.limits;
        if (q[c] < limits.lower || q[c] > limits.upper) {
          const double limit = q[c] < limits.lower ? limits.lower : limits.upper;
          forces.tau[c] += limits.stiffness * (limit - q[c]);
          forces.by_q[c] -= limits.stiffness;
        }
      }
    }
  }
}

template <Scalar S>
MotorForce<S> drive_by_force(const Motor& motor, const S& u) {
  MotorForce<S> out;
  if (!std::isfinite(motor.lower)) {
    out.tau = u;
    out.by_u = S(1.0);
    return out;
  }
  const double half = 0.5 * (motor.upper - motor.lower);
  const double middle = 0.5 * (motor.upper + motor.lower);
  const bool inside = u >= -1.0 && u <= 1.0;
  const S clamped = inside ? u : S(u < -1.0 ? -1.0 : 1.0);
  out.tau = middle + half * clamped;
  out.by_u = S(inside ? half : 0.0);
  return out;
}

template <Scalar S>
MotorForce<S> drive_to_position(const Motor& motor, const S& P, const S& D, const S& u, const S& q,
                                const S& qdot) {
  MotorForce<S> out;
  const S wanted = P * (u - q) - D * qdot;
  if (wanted < motor.lower || wanted > motor.upper) {
    out.tau = S(wanted < motor.lower ? motor.lower : motor.upper);
    return out;
  }
  out.tau = wanted;
  out.by_u = P;
  out.by_P = u - q;
  out.by_D = -qdot;
  out.by_q = -P;
  out.by_qdot = -D;
  return out;
}

}  // namespace

template <Scalar S>
JointForces<S>::JointForces(const Model& model) {
  for (VectorX<S>* per_coordinate :
       {&tau, &by_q, &by_qdot, &by_start_q, &by_start_qdot, &by_stiffness, &by_damping}) {
    *per_coordinate = VectorX<S>::Zero(model.dof());
  }
  for (VectorX<S>* per_control : {&by_u, &by_P, &by_D}) {
    *per_control = VectorX<S>::Zero(model.control_count());
  }
}

int coordinate_of_control(const Model& model, int motor, int control) {
  const int link = model.motors()[static_cast<std::size_t>(motor)].link;
  return model.coordinates_of_link(link).begin + control - model.first_control(motor);
}

template <Scalar S>
MotorForce<S> motor_force(const Model& model, const Mechanism<S>& mechanism, int motor, const S& u,
                          const S& q, const S& qdot) {
  const Motor& driven = model.motors()[static_cast<std::size_t>(motor)];
  return driven.kind == Motor::Kind::kForce
             ? drive_by_force<S>(driven, u)
             : drive_to_position<S>(driven, mechanism.motor_P[motor], mechanism.motor_D[motor], u,
                                    q, qdot);
}

template <Scalar S>
void compute_joint_forces(const Model& model, const Mechanism<S>& mechanism, const VectorView<S>& q,
                          const VectorView<S>& qdot, const VectorView<S>& u,
                          const StepStart<S>& start, JointForces<S>& forces) {
  forces.by_start_q.setZero();
  forces.by_start_qdot.setZero();
  forces.by_u.setZero();
  forces.by_P.setZero();
  forces.by_D.setZero();
  add_passive<S>(model, mechanism, q, qdot, forces);
  for (int m = 0; m < static_cast<int>(model.motors().size()); ++m) {
    const Motor& motor = model.motors()[static_cast<std::size_t>(m)];
    const CoordinateRange range = model.coordinates_of_link(motor.link);
    for (int c = range.begin; c < range.end; ++c) {
      const int i = model.first_control(m) + c - range.begin;
      const bool at_start = motor.kind == Motor::Kind::kPosition && !motor.implicit;
      const MotorForce<S> force =
          motor_force<S>(model, mechanism, m, u[i], at_start ? start.q[c] : q[c],
                         at_start ? start.qdot[c] : qdot[c]);
      forces.tau[c] += force.tau;
      forces.by_u[i] = force.by_u;
      forces.by_P[i] = force.by_P;
      forces.by_D[i] = force.by_D;
      (at_start ? forces.by_start_q : forces.by_q)[c] += force.by_q;
      (at_start ? forces.by_start_qdot : forces.by_qdot)[c] += force.by_qdot;
    }
  }
}

template struct JointForces<double>;
template struct JointForces<Dual>;
template MotorForce<double> motor_force(const Model&, const Mechanism<double>&, int, const double&,
                                        const double&, const double&);
template MotorForce<Dual> motor_force(const Model&, const Mechanism<Dual>&, int, const Dual&,
                                      const Dual&, const Dual&);
template void compute_joint_forces(const Model&, const Mechanism<double>&,
                                   const VectorView<double>&, const VectorView<double>&,
                                   const VectorView<double>&, const StepStart<double>&,
                                   JointForces<double>&);
template void compute_joint_forces(const Model&, const Mechanism<Dual>&, const VectorView<Dual>&,
                                   const VectorView<Dual>&, const VectorView<Dual>&,
                                   const StepStart<Dual>&, JointForces<Dual>&);

}  // namespace hbar
