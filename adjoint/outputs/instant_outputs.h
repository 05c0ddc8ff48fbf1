#pragma once

#include "hbar/adjoint/outputs/end_effectors.h"
#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/contact/tactile.h"

namespace hbar {

/// Numbers that are read off an instant, or weights on them.
template <Scalar S>
struct OutputRows {
  VectorX<S> v;         ///< auxiliary variables, length                            [variables]
  VectorX<S> tactile;   ///< sensor readings, force                                 [readings]
  VectorX<S> measured;  ///< measurements                                           [measured]
};

/// Everything that objectives and constraints read of an instant besides coordinates, rates,
/// controls and parameters: end effectors, sensors and measurements, as one.
///
/// Borrows the model. Holds its workspace and belongs to one thread at a time.
template <Scalar S>
class InstantOutputs {
 public:
  /// @throws InvalidInput if the model cannot have the measurements
  InstantOutputs(const Model& model, const std::vector<Measurement>& measurements);

  /// Whether there is nothing to read.
  [[nodiscard]] bool empty() const;
  /// Names of the measured rows.
  [[nodiscard]] const std::vector<std::string>& measured_names() const {
    return measurements_.names();
  }
  /// Rows of the right sizes, all zero.
  [[nodiscard]] OutputRows<S> zero_rows() const;

  /// Poses and twists at an instant, for the two below; valid until the next call.
  ///
  /// @param q, qdot  coordinates and rates                                           [dof]
  const Motion<S>& motion_at(const Mechanism<S>& mechanism, const VectorView<S>& q,
                             const VectorView<S>& qdot);

  /// The rows at an instant.
  ///
  /// @param motion   poses and twists at (q, q̇)
  /// @param q, qdot  coordinates and rates                                           [dof]
  /// @param u        controls                                                   [controls]
  void read(const Mechanism<S>& mechanism, const Motion<S>& motion, const VectorView<S>& q,
            const VectorView<S>& qdot, const VectorView<S>& u, OutputRows<S>& out);

  /// Transposed derivative: weights y are added as gradients.
  ///
  /// @param p, by_p            values of, and gradient by, the set's parameters  [set.size()]
  /// @param by_q, by_qdot      gradients by coordinates and rates                [dof]
  /// @param by_u               gradient by the controls                          [controls]
  void pull_back(const Mechanism<S>& mechanism, const ParameterSet& set, const VectorView<S>& p,
                 const Motion<S>& motion, const VectorView<S>& q, const VectorView<S>& qdot,
                 const VectorView<S>& u, const OutputRows<S>& y, Eigen::Ref<VectorX<S>> by_q,
                 Eigen::Ref<VectorX<S>> by_qdot, Eigen::Ref<VectorX<S>> by_u,
                 Eigen::Ref<VectorX<S>> by_p);

 private:
  const Model& model_;
  Motion<S> motion_;
  EndEffectors<S> end_effectors_;
  TactileReadings<S> tactile_;
  Measurements<S> measurements_;
  VectorX<S> none_;  // accelerations, which nothing here reads
};

}  // namespace hbar
