#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/outputs/instant.h"
#include "hbar/contact/tactile.h"
#include "hbar/core/model/measurement.h"
#include "hbar/core/parameters/link_pullback.h"

namespace hbar {

/// Measurements of a model at one instant: their rows, one after the other, and the transposed
/// derivative with respect to everything they depend on. doc/notation.md has the formulas.
///
/// Borrows the model. Sized once, reused; evaluations allocate nothing (ContactForces' limit on
/// points applies). Holds its workspace and belongs to one thread at a time.
template <Scalar S>
class Measurements {
 public:
  /// @param measurements  measurements that the model can have (check_measurements)
  Measurements(const Model& model, std::vector<Measurement> measurements);

  /// Rows of all measurements together.
  [[nodiscard]] int size() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] bool empty() const { return names_.empty(); }
  /// Names of the rows: "tip_speed.x", …                                             [size()]
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

  /// Whether any row reads contact forces; instants must then have them.
  [[nodiscard]] bool reads_contacts() const { return reads_contacts_; }

  /// Finds what the tactile sensors touch. Call it once per instant, before the functions below.
  void linearize(const Instant<S>& at);

  /// @param out  rows                                                                  [size()]
  void read(const Instant<S>& at, Eigen::Ref<VectorX<S>> out) const;

  /// Transposed derivative: adds the gradient of y·rows to `out`. Rows of weight zero cost nothing;
  /// any number of pull-backs may follow one linearize().
  ///
  /// @param y  weights                                                                 [size()]
  void pull_back(const Instant<S>& at, const VectorView<S>& y, InstantGradient<S>& out);

 private:
  using Rows = Eigen::Ref<VectorX<S>>;
  using At = const Instant<S>&;
  using Weights = const VectorView<S>&;
  using Out = InstantGradient<S>&;

  // The rows of each kind.
  void read(const PointVelocity& m, At at, Rows out) const;
  void read(const Orientation& m, At at, Rows out) const;
  void read(const BodyDistance& m, At at, Rows out) const;
  void read(const ContactForce& m, At at, Rows out) const;
  void read(const MotorTorque& m, At at, Rows out) const;
  void read(const MotorPower& m, At at, Rows out) const;
  void read(const CentreOfMass& m, At at, Rows out) const;
  void read(const LinearMomentum& m, At at, Rows out) const;
  void read(const EndEffectorPosition& m, At at, Rows out) const;
  void read(const TactileReading& m, At at, Rows out) const;

  // Their transposes; y are the weights of the measurement's own rows.
  void weigh(const PointVelocity& m, At at, Weights y, Out out);
  void weigh(const Orientation& m, At at, Weights y, Out out);
  void weigh(const BodyDistance& m, At at, Weights y, Out out);
  void weigh(const ContactForce& m, At at, Weights y, Out out);
  void weigh(const MotorTorque& m, At at, Weights y, Out out);
  void weigh(const MotorPower& m, At at, Weights y, Out out);
  void weigh(const CentreOfMass& m, At at, Weights y, Out out);
  void weigh(const LinearMomentum& m, At at, Weights y, Out out);
  void weigh(const EndEffectorPosition& m, At at, Weights y, Out out);
  void weigh(const TactileReading& m, At at, Weights y, Out out);

  void weigh_velocity(const BodyMotion<S>& body, int link, const Vector3<S>& x,
                      const Vector3<S>& weight);
  template <typename Weight>
  void weigh_masses(At at, const Weight& weight, Out out) const;
  void weigh_contacts(At at, Out out);
  void weigh_touch(const ActivePair<S>& pair, const TouchingPoint<S>& point,
                   const Eigen::Matrix<S, 4, 1>& weight);

  const Model& model_;
  std::vector<Measurement> measurements_;
  std::vector<int> first_;  // row of each measurement, and the end of the last
  std::vector<std::string> names_;
  LinkPullback<S> links_;
  TactileReadings<S> tactile_;
  std::vector<Eigen::Matrix<S, 4, 1>> contact_weights_;  // per contact, if forces are read
  bool reads_contacts_ = false;
};

}  // namespace hbar
