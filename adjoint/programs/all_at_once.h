#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "hbar/adjoint/derivatives/linearization.h"
#include "hbar/adjoint/derivatives/stage_hessian.h"
#include "hbar/adjoint/programs/transcription.h"
#include "hbar/adjoint/trajectory/flat_stencil.h"
#include "hbar/adjoint/trajectory/trajectory_residual.h"
#include "hbar/adjoint/trajectory/value_reader.h"

namespace hbar {

/// All-at-once: x = [ InputVariables | q of stage 1 | q of stage 2 | … ], and after the problem's
/// own rows the residuals ḡ = 0 of every stage, each divided by the largest entry that its row of H̄
/// has at the start. Nothing is simulated; the Jacobian is [∂ḡ/∂(d, u, q₀, q̇₀)  H̄], sparse.
///
/// The Hessian of σΨ + λᵀ(c, ḡ) is exact and sparse, too: per stage, StageHessian contracted with
/// the multipliers and brought to coordinates by the integrator's stencil.
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
  /// Of the coordinates in x, which need not be a motion.
  [[nodiscard]] const TrajectoryValues& trajectory_values(const Eigen::VectorXd& x) override;

  /// ‖ḡ‖∞ at x, in the scaled rows.
  [[nodiscard]] double residual(const Eigen::VectorXd& x);

 private:
  /// How a stage's q̇, q̈ and step start depend on one run of x.
  struct StageEntry {
    Eigen::Index place = 0;  // of its first coordinate
    double q = 0.0;
    double qdot = 0.0;
    double a = 0.0;
    double start_q = 0.0;
    double start_qdot = 0.0;
  };

  /// What an output's row may change with at its instant, each ascending.
  struct OutputReads {
    std::vector<int> q;         // coordinates
    std::vector<int> qdot;      // coordinates whose rates are read
    std::vector<int> controls;  // of the step that ends
  };

  void guess(const Eigen::MatrixXd& q_guess);
  void lay_out_stages();
  void scale_rows(const Linearization& system);
  void lay_out_jacobian(const Linearization& system);
  void add_matrix(const solvers::SparseMatrix& matrix, Eigen::Index first_column);
  void put_matrix(const solvers::SparseMatrix& matrix);
  void move_to(const Eigen::VectorXd& x);
  void differentiate(const Eigen::VectorXd& x);

  [[nodiscard]] std::vector<Eigen::Index> columns_of(const ValuePlace& place) const override;
  void derivatives_of(const ValuePlace& place, std::vector<double>& out) override;
  void lay_out_outputs();
  void lay_out_pairs();
  [[nodiscard]] const std::vector<int>& pairs_of(const StageEntry& a, const StageEntry& b,
                                                 int coordinate) const;
  [[nodiscard]] const OutputReads& reads_of(const ValuePlace& place) const;
  [[nodiscard]] static bool depends(const OutputReads& reads, const StageEntry& entry,
                                    int coordinate);
  void differentiate_output(const ValuePlace& place);

  void add_curvature(EntryPlan& entries) const override;
  void add_stage(int stage, EntryPlan& entries) const;
  void put_stage(int stage, EntryPlan& entries) const;
  [[nodiscard]] OutputRows<double> output_weights(const TrajectoryPartials& partials, int k) const;
  /// Place in x of a stage's first coordinate; −1 for stage 0 if that is no variable.
  [[nodiscard]] Eigen::Index stage_place(int stage) const;
  /// The step that a stage ends, or −1.
  [[nodiscard]] int step_ended_by(int stage) const;

  std::vector<std::vector<StageEntry>> stages_;     // per stage: what it depends on
  std::vector<std::vector<int>> pairs_;             // per coordinate: those it bends numbers with
  std::vector<std::vector<int>> own_pairs_;         // and where neither moves by its rate
  std::vector<OutputReads> variable_reads_;         // per end effector
  std::vector<OutputReads> measured_reads_;         // per measured row
  OutputReads tactile_reads_;                       // of every reading
  std::vector<std::pair<int, int>> control_rates_;  // (control, coordinate) of measured powers
  std::vector<std::pair<Eigen::Index, int>> gain_controls_;  // (design variable, control)
  TrajectoryResidual residual_;
  Linearizer linearizer_;
  StageHessian hessian_;
  ValueReader reader_;
  InstantOutputs<double> outputs_;
  Eigen::VectorXd row_scale_;  // of ḡ's rows
  EntryPlan jacobian_;

  Eigen::VectorXd x_;  // the last point
  std::string failure_;
  bool differentiated_ = false;
  Trajectory trajectory_;
  TrajectoryValues values_;
  Eigen::VectorXd g_bar_;
  Eigen::MatrixXd map_jacobian_;
  // Derivatives of one output row by its own instant.
  Eigen::VectorXd by_q_, by_qdot_, by_u_, by_p_;
};

}  // namespace hbar
