#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/adjoint/programs/all_at_once_hessian.h"
#include "hbar/adjoint/programs/formulation.h"
#include "hbar/adjoint/programs/transcription.h"
#include "hbar/adjoint/trajectory/trajectory_residual.h"
#include "hbar/adjoint/trajectory/value_reader.h"

namespace hbar {

/// All-at-once: x = [ InputVariables | q of stage 1 | q of stage 2 | … ], and after the problem's
/// own rows the residuals ḡ = 0 of every stage, each divided by the largest entry of its row of H̄
/// at the start. Nothing is simulated; the Jacobian is [∂ḡ/∂(d, u, q₀, q̇₀) H̄], sparse.
///
/// The Hessian of σΨ + λᵀ(c, ḡ) is exact and sparse as well: per stage, StageHessian contracted
/// with the multipliers and mapped to coordinates by the integrator's stencil.
///
/// Steps are never halved here, and exponential coordinates stay in the chart they start in.
class AllAtOnce final : public Transcription {
 public:
  /// @throws InvalidInput as transcribe, and if exponential coordinates change chart in the first
  ///         guess
  AllAtOnce(const TrajectoryProblem& problem, const TranscriptionOptions& options);

  [[nodiscard]] double objective(const Eigen::VectorXd& x) override;
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override;
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override;
  void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) override;
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd& lambda,
                          solvers::HessianKind kind, Eigen::VectorXd& values) override;
  /// The values of the coordinates in x, which need not satisfy ḡ = 0.
  [[nodiscard]] const TrajectoryValues& trajectory_values(const Eigen::VectorXd& x) override;

  /// ‖ḡ‖∞ at x, in the scaled rows.
  [[nodiscard]] double residual(const Eigen::VectorXd& x);

 private:
  void guess(const Eigen::MatrixXd& q_guess);
  void scale_rows(const Linearization& system);
  void lay_out_jacobian(const Linearization& system);
  void add_matrix(const solvers::SparseMatrix& matrix, Eigen::Index first_column);
  void put_matrix(const solvers::SparseMatrix& matrix);
  void move_to(const Eigen::VectorXd& x);
  void differentiate(const Eigen::VectorXd& x);

  [[nodiscard]] std::vector<Eigen::Index> columns_of(const ValuePlace& place) const override {
    return dependence_.columns_of(place);
  }
  void derivatives_of(const ValuePlace& place, std::vector<double>& out) override {
    dependence_.derivatives_of(place, out);
  }
  void add_curvature(EntryPlan& entries) const override { hessian_.add(entries); }

  Trajectory trajectory_;
  StageLayout layout_;
  ValueDependence dependence_;
  TrajectoryResidual residual_;
  Linearizer linearizer_;
  AllAtOnceHessian hessian_;
  ValueReader reader_;
  Eigen::VectorXd row_scale_;  // of ḡ's rows
  EntryPlan jacobian_;

  Eigen::VectorXd x_;  // the last point
  std::string failure_;
  bool differentiated_ = false;
  TrajectoryValues values_;
  Eigen::VectorXd g_bar_;
  Eigen::MatrixXd map_jacobian_;
};

}  // namespace hbar
