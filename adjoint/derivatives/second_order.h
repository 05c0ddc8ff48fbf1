#pragma once

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/terms/value_access.h"
#include "hbar/adjoint/trajectory/inputs.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/owned.h"
#include "hbar/solvers/nlp/nlp.h"

namespace hbar {

/// Second derivatives of a trajectory without forming a Hessian: the tangent and the second adjoint
/// (doc/formulations.md), both by dual numbers along one direction,
///
///     H̄ δq̄ = −δḡ,     H̄ᵀ δz̄ = δȳ − (δH̄)ᵀ z̄,
///
/// stage by stage, contact included. For a weighted sum Σ y·values they give how its gradient
/// changes with the inputs, and with y if y changes too.
///
/// Set the point once; each direction then costs one push_forward and one product. Holds its
/// workspace for one horizon and belongs to one thread at a time.
class SecondOrderSweep {
 public:
  explicit SecondOrderSweep(const Horizon& horizon);
  ~SecondOrderSweep();
  SecondOrderSweep(SecondOrderSweep&&) noexcept;
  SecondOrderSweep& operator=(SecondOrderSweep&&) noexcept;

  /// Takes a trajectory and weights y on its values. Costs one adjoint sweep and a factorisation of
  /// every stage's block.
  ///
  /// @param trajectory  complete, of this horizon; copied
  /// @returns           d(y·values)/d(inputs), without the value
  /// @throws InvalidInput, NumericalFailure as AdjointSweep::pull_back
  const Gradient& set_point(const Trajectory& trajectory, const TrajectoryPartials& weights);

  /// Tangent of the trajectory's values along a direction of the inputs; the next product uses the
  /// same direction.
  ///
  /// @param direction  shaped like the inputs
  /// @returns          valid until the next call
  /// @throws InvalidInput without a point, or for a direction of another shape
  const ValueTangent& push_forward(const Inputs& direction);

  /// Change of d(y·values)/d(inputs) along the direction of the last push_forward.
  ///
  /// @param weights_tangent  δy along that direction; null means that y is constant
  /// @returns                valid until the next call
  /// @throws InvalidInput without a point or a direction
  const Gradient& product(const TrajectoryPartials* weights_tangent = nullptr);

  /// That of the last set_point.
  /// @throws InvalidInput if there was none
  [[nodiscard]] const Trajectory& trajectory() const;

 private:
  struct Workspace;
  Owned<Workspace> work_;
};

/// Hessian-vector products, exact or Gauss-Newton, of one objective at one trajectory.
///
/// Belongs to one thread at a time.
class HessianProduct {
 public:
  /// @throws InvalidInput if a term of the objective has no second partials, naming it
  HessianProduct(const Horizon& horizon, Objective objective);

  /// @param trajectory  complete, of this horizon; copied
  /// @returns           Ψ and its gradient there
  const Gradient& set_point(const Trajectory& trajectory);

  /// (d²Ψ/d(inputs)²) direction, or without the curvature of the trajectory: Vᵀ (∂²Ψ/∂values²) V
  /// direction with V = d(values)/d(inputs), positive semidefinite for sums of squares.
  ///
  /// @param direction  shaped like the inputs
  /// @param kind       kExact or kGaussNewton
  /// @returns          shaped like a gradient, value = ½ directionᵀ H direction; valid until the
  ///                   next call
  /// @throws InvalidInput for a direction of another shape, kLimitedMemory, or without a point
  const Gradient& along(const Inputs& direction,
                        solvers::HessianKind kind = solvers::HessianKind::kExact);

 private:
  ValueReader reader_;
  Objective objective_;
  SecondOrderSweep sweep_;
  AdjointSweep adjoint_;  // of products without curvature
  TrajectoryValues values_;
  Gradient gradient_;
  Gradient product_;
  std::vector<SecondPlace> places_;
  Eigen::VectorXd second_;
};

}  // namespace hbar
