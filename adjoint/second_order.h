#pragma once

#include "hbar/adjoint/gradient.h"
#include "hbar/adjoint/value_access.h"

namespace hbar {

/// Second derivatives of a trajectory without a Hessian: tangent and second adjoint (formulation
/// §5), both by dual numbers of one direction,
///
///     H̄ δq̄ = −δḡ,     H̄ᵀ δz̄ = δȳ − (δH̄)ᵀ z̄,
///
/// stage by stage, contact included. Of a weighted sum Σ y·values it gives how its gradient moves
/// with the inputs, and with y where y moves too.
///
/// A point is set once; then each direction costs one push_forward and one product. Holds its
/// workspace for one simulator and belongs to one thread at a time.
class SecondOrderSweep {
 public:
  explicit SecondOrderSweep(Simulator& simulator);
  ~SecondOrderSweep();
  SecondOrderSweep(SecondOrderSweep&&) noexcept;
  SecondOrderSweep& operator=(SecondOrderSweep&&) noexcept;

  /// Takes a trajectory and weights y on its values: one adjoint sweep, and the factors of every
  /// stage's block.
  ///
  /// @param trajectory  whole, of this simulator; must outlive the products
  /// @returns           d(y·values)/d(inputs), without the value
  /// @throws NumericalFailure as AdjointSweep::pull_back
  const Gradient& set_point(const Trajectory& trajectory, const TrajectoryPartials& weights);

  /// Tangent of the trajectory's values along a direction of the inputs, which the next product
  /// takes too.
  ///
  /// @param direction  shaped like the inputs
  /// @returns          valid until the next call
  const ValueTangent& push_forward(const Inputs& direction);

  /// δ of d(y·values)/d(inputs) along the direction pushed forward last.
  ///
  /// @param weights_tangent  δy along it; null means that y is constant
  /// @returns                valid until the next call
  const Gradient& product(const TrajectoryPartials* weights_tangent = nullptr);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// Exact Hessian-vector products of one objective at one trajectory.
///
/// Belongs to one thread at a time.
class HessianProduct {
 public:
  /// @throws InvalidInput if a term of the objective has no second partials, naming it
  HessianProduct(Simulator& simulator, Objective objective);

  /// @param trajectory  whole, of this simulator; must outlive the products
  /// @returns           Ψ and its gradient there
  const Gradient& set_point(const Trajectory& trajectory);

  /// (d²Ψ/d(inputs)²) direction.
  ///
  /// @param direction  shaped like the inputs
  /// @returns          shaped like a gradient, value = ½ directionᵀ H direction; valid until the
  ///                   next call
  const Gradient& along(const Inputs& direction);

 private:
  Simulator& simulator_;
  Objective objective_;
  SecondOrderSweep sweep_;
  TrajectoryValues values_;
  Gradient gradient_;
  Gradient product_;
  std::vector<SecondPlace> places_;
  Eigen::VectorXd second_;
};

}  // namespace hbar
