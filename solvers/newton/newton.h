#pragma once

#include <string_view>

#include "hbar/core/base/scalar.h"

namespace hbar::solvers {

/// A nonlinear system g(x) = 0, as Newton's method uses it.
class NewtonSystem {
 public:
  NewtonSystem() = default;
  NewtonSystem(const NewtonSystem&) = delete;
  NewtonSystem& operator=(const NewtonSystem&) = delete;
  virtual ~NewtonSystem() = default;

  /// g(x); entries that are not finite shorten the step.
  virtual void residual(const Eigen::VectorXd& x, Eigen::VectorXd& g) = 0;
  /// g(x) and factors of its Jacobian there, which solve() then uses.
  virtual void factorize(const Eigen::VectorXd& x, Eigen::VectorXd& g) = 0;
  /// dx = J⁻¹ g with the last factors; entries that are not finite mean that J is singular.
  virtual void solve(const Eigen::VectorXd& g, Eigen::VectorXd& dx) = 0;
};

/// When Newton's method stops. Corrections are measured as max_i |dx_i| / (1 + |x_i|).
struct NewtonOptions {
  double tol = 1e-9;    ///< on ‖g‖₂, unit of g
  double rtol = 1e-12;  ///< on the next correction, relative
  int max_iter = 100;   ///< corrections
  int max_ls = 20;      ///< shortenings of one correction
};

/// Why Newton's method stopped.
enum class NewtonStatus {
  kConverged,       ///< ‖g‖₂ ≤ tol and the next correction ≤ rtol
  kRounding,        ///< converged as far as rounding allows: corrections no longer shrink
  kIterationLimit,  ///< max_iter corrections did not suffice
  kLineSearch,      ///< no acceptable step after max_ls shortenings
  kSingular,        ///< the Jacobian is singular
  kNotFinite,       ///< g is not finite at the start
  kStrayed          ///< converged, but the caller found the solution implausible
};

/// Why Newton's method stopped, in words.
[[nodiscard]] std::string_view describe(NewtonStatus status);

/// A report on one solve.
struct NewtonReport {
  NewtonStatus status = NewtonStatus::kNotFinite;
  int iterations = 0;      ///< corrections applied
  int factorizations = 0;  ///< Jacobians evaluated
  double residual = 0.0;  ///< ‖g‖₂ where it was last evaluated (one more correction may follow)
  double correction = 0.0;  ///< last correction, relative
  int worst = 0;            ///< index of the largest entry of the last correction

  [[nodiscard]] bool converged() const {
    return status == NewtonStatus::kConverged || status == NewtonStatus::kRounding;
  }
};

/// Damped Newton with the natural monotonicity test: a step λ dx is accepted if the simplified
/// correction J⁻¹ g(x + λ dx) is shorter than dx. Invariant under scaling of the residual, so that
/// torques and forces may be mixed. Reuses a Jacobian while corrections shrink fast.
///
/// Workspace for one size; one object per thread. solve() allocates nothing.
///
/// Source: P. Deuflhard, Newton Methods for Nonlinear Problems (2004), algorithm NLEQ-ERR.
class Newton {
 public:
  /// @param size  number of unknowns
  explicit Newton(Eigen::Index size);

  /// @param x  start; the solution, or the last accepted iterate            [size]
  [[nodiscard]] NewtonReport solve(NewtonSystem& system, const NewtonOptions& options,
                                   Eigen::VectorXd& x);

 private:
  enum class Search { kAccepted, kFailed };

  Search search(NewtonSystem& system, const NewtonOptions& options, const Eigen::VectorXd& x,
                NewtonReport& report, double& lambda);
  /// Cheap corrections with the present factors; true when done.
  bool polish(NewtonSystem& system, const NewtonOptions& options, Eigen::VectorXd& x,
              NewtonReport& report);
  double measure(const Eigen::VectorXd& dx, const Eigen::VectorXd& x, int* worst) const;

  Eigen::VectorXd g_;
  Eigen::VectorXd dx_;
  Eigen::VectorXd next_;            // x + λ dx
  Eigen::VectorXd simplified_;      // −J⁻¹ g(next_)
  double length_ = 0.0;             // of dx_
  double simplified_length_ = 0.0;  // of simplified_
};

}  // namespace hbar::solvers
