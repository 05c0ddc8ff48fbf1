#pragma once

#include <vector>

#include "hbar/adjoint/derivatives/block_matrix.h"
#include "hbar/core/base/owned.h"

namespace hbar {

class Horizon;
struct Trajectory;

/// The trajectory's linear system: ḡ(q̄, p, u, q₀, q̇₀) = 0 differentiated, as compressed sparse
/// columns. Row block s − 1 and column block s − 1 of H belong to stage s.
struct Linearization {
  BlockMatrix H;                ///< H̄ = ∂ḡ/∂q̄, block lower triangular     [m x m]
  solvers::SparseMatrix dg_dp;  ///< ∂ḡ/∂p                                  [m x parameters]
  solvers::SparseMatrix dg_du;  ///< ∂ḡ/∂u, columns step by step            [m x controls·steps]
  BlockMatrix dg_dq0;           ///< ∂ḡ/∂q₀                                 [m x dof]
  BlockMatrix dg_dqdot0;        ///< ∂ḡ/∂q̇₀                                 [m x dof]
  std::vector<int> block_sizes;  ///< dof, once per stage                    [stages − 1]
};

/// Assembles Linearizations of one horizon's trajectories. Patterns are laid out once per
/// timeline (in practice: once); then only values are overwritten.
class Linearizer {
 public:
  explicit Linearizer(const Horizon& horizon);
  ~Linearizer();
  Linearizer(Linearizer&&) noexcept;
  Linearizer& operator=(Linearizer&&) noexcept;

  /// @param trajectory  complete, of this horizon
  /// @returns  valid until the next call
  const Linearization& linearize(const Trajectory& trajectory);

  /// How often patterns were laid out.
  [[nodiscard]] int pattern_count() const;

 private:
  struct Workspace;
  Owned<Workspace> work_;
};

}  // namespace hbar
