#include "hbar/core/joint_forces.h"

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
void drive_by_force(const Motor& motor, int c, int i, const S& u, JointForces<S>& forces) {
  if (!std::isfinite(motor.lower)) {
    forces.tau[c] += u;
    forces.by_u[i] = 1.0;
    return;
  }
  const double half = 0.5 * (motor.upper - motor.lower);
  const double middle = 0.5 * (motor.upper + motor.lower);
  const bool inside = u >= -1.0 && u <= 1.0;
  const S clamped = inside ? u : S(u < -1.0 ? -1.0 : 1.0);
  forces.tau[c] += middle + half * clamped;
  forces.by_u[i] = inside ? half : 0.0;
}

template <Scalar S>
void drive_to_position(const Motor& motor, const S& P, const S& D, int c, int i, const S& u,
                       const S& q, const S& qdot, JointForces<S>& forces) {
  const S wanted = P * (u - q) - D * qdot;
  if (wanted < motor.lower || wanted > motor.upper) {
    forces.tau[c] += wanted < motor.lower ? motor.lower : motor.upper;
    return;
  }
  forces.tau[c] += wanted;
  forces.by_u[i] = P;
  forces.by_P[i] = u - q;
  forces.by_D[i] = -qdot;
  (motor.implicit ? forces.by_q : forces.by_start_q)[c] -= P;
  (motor.implicit ? forces.by_qdot : forces.by_start_qdot)[c] -= D;
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
      if (motor.kind == Motor::Kind::kForce) {
        drive_by_force<S>(motor, c, i, u[i], forces);
      } else {
        const S& q_used = motor.implicit ? q[c] : start.q[c];
        const S& qdot_used = motor.implicit ? qdot[c] : start.qdot[c];
        drive_to_position<S>(motor, mechanism.motor_P[m], mechanism.motor_D[m], c, i, u[i], q_used,
                             qdot_used, forces);
      }
    }
  }
}

template struct JointForces<double>;
template struct JointForces<Dual>;
template void compute_joint_forces(const Model&, const Mechanism<double>&,
                                   const VectorView<double>&, const VectorView<double>&,
                                   const VectorView<double>&, const StepStart<double>&,
                                   JointForces<double>&);
template void compute_joint_forces(const Model&, const Mechanism<Dual>&, const VectorView<Dual>&,
                                   const VectorView<Dual>&, const VectorView<Dual>&,
                                   const StepStart<Dual>&, JointForces<Dual>&);

}  // namespace hbar
