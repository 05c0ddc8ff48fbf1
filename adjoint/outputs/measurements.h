#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hbar/contact/contact_forces.h"
#include "hbar/core/model/measurement.h"
#include "hbar/core/parameters/link_pullback.h"

namespace hbar {

/// The declared measurements of a model at one instant: their rows, one after the other, and the
/// transposed derivative by everything they depend on. notation.md has the formulas.
///
/// Borrows the model. Sized once, reused; evaluations allocate nothing (ContactForces' limit on
/// points applies). Holds its workspace and belongs to one thread at a time.
template <Scalar S>
class Measurements {
 public:
  /// @throws InvalidInput as check_measurements
  Measurements(const Model& model, std::vector<Measurement> measurements);

  /// Rows of all measurements together.
  [[nodiscard]] int size() const { return static_cast<int>(names_.size()); }
  /// Names of the rows: "tip_speed.x", …                                             [size()]
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// @param motion   poses and twists at (q, q̇)                                (A is not read)
  /// @param q, qdot  coordinates and rates                                            [dof]
  /// @param u        controls                                                         [controls]
  /// @param out      rows                                                             [size()]
  void readings(const Mechanism<S>& mechanism, const Motion<S>& motion, const VectorView<S>& q,
                const VectorView<S>& qdot, const VectorView<S>& u, Eigen::Ref<VectorX<S>> out);

  /// Transposed derivative: weights y on the rows are added as gradients.
  ///
  /// @param p, grad_p              values of, and gradient by, the set's parameters    [set.size()]
  /// @param y                      weights                                             [size()]
  /// @param by_q, by_qdot, by_u    gradients by coordinates, rates and controls  [dof, dof,
  /// controls]
  void pull_back(const Mechanism<S>& mechanism, const ParameterSet& set, const VectorView<S>& p,
                 const Motion<S>& motion, const VectorView<S>& q, const VectorView<S>& qdot,
                 const VectorView<S>& u, const VectorView<S>& y, Eigen::Ref<VectorX<S>> by_q,
                 Eigen::Ref<VectorX<S>> by_qdot, Eigen::Ref<VectorX<S>> by_u,
                 Eigen::Ref<VectorX<S>> grad_p);

 private:
  using Rows = Eigen::Ref<VectorX<S>>;
  struct Instant;
  struct Gradients;

  // The rows of each kind.
  void read(const PointVelocity& m, const Instant& at, Rows out) const;
  void read(const Orientation& m, const Instant& at, Rows out) const;
  void read(const BodyDistance& m, const Instant& at, Rows out) const;
  void read(const ContactForce& m, const Instant& at, Rows out) const;
  void read(const MotorTorque& m, const Instant& at, Rows out) const;
  void read(const MotorPower& m, const Instant& at, Rows out) const;
  void read(const CentreOfMass& m, const Instant& at, Rows out) const;
  void read(const LinearMomentum& m, const Instant& at, Rows out) const;

  // Their transposes; y are the weights of the measurement's own rows.
  void weigh(const PointVelocity& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const Orientation& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const BodyDistance& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const ContactForce& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const MotorTorque& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const MotorPower& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const CentreOfMass& m, const Instant& at, const VectorView<S>& y, Gradients& out);
  void weigh(const LinearMomentum& m, const Instant& at, const VectorView<S>& y, Gradients& out);

  void weigh_velocity(const BodyMotion<S>& body, int link, const Vector3<S>& x,
                      const Vector3<S>& weight);
  void weigh_mass(int link, const Instant& at, const S& weight, Gradients& out) const;
  void weigh_contacts(const Instant& at, Gradients& out);
  void weigh_touch(const ActivePair<S>& pair, const TouchingPoint<S>& point,
                   const Eigen::Matrix<S, 4, 1>& weight);

  const Model& model_;
  std::vector<Measurement> measurements_;
  std::vector<int> first_;  // row of each measurement, and the end of the last
  std::vector<std::string> names_;
  LinkPullback<S> links_;
  std::optional<ContactForces<S>> contacts_;             // where a measurement asks for them
  std::vector<Eigen::Matrix<S, 4, 1>> contact_weights_;  // per contact
};

}  // namespace hbar
