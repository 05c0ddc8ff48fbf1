#pragma once

#include <memory>
#include <vector>

#include "hbar/adjoint/programs/formulation.h"
#include "hbar/adjoint/programs/shooting_segment.h"
#include "hbar/adjoint/programs/transcription.h"

namespace hbar {

/// Single and multiple shooting: the horizon is split into segments (single shooting has one), each
/// simulated from its first state. x = [ InputVariables | q, q̇ at the start of the second segment
/// | … ], and after the problem's own rows come those that make each segment's end equal the next
/// one's start.
///
/// Segments are evaluated in parallel threads. The gradient is an adjoint sweep, the Jacobian a
/// tangent sweep with one direction per variable of the segment, the exact Hessian one
/// Hessian-vector product per such variable. A row that reads step k depends only on the variables
/// of k's segment, and among its controls only on those up to k.
///
/// At a step where segments meet, the values are those of the segment that ends there.
class Shooting final : public Transcription {
 public:
  /// @throws InvalidInput as transcribe
  Shooting(const TrajectoryProblem& problem, const TranscriptionOptions& options);

  [[nodiscard]] double objective(const Eigen::VectorXd& x) override;
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override;
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override;
  void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) override;
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd& lambda,
                          solvers::HessianKind kind, Eigen::VectorXd& values) override;
  [[nodiscard]] const TrajectoryValues& trajectory_values(const Eigen::VectorXd& x) override;

  [[nodiscard]] int segment_count() const { return static_cast<int>(segments_.size()); }

 private:
  void lay_out_segments(const TranscriptionOptions& options);
  void lay_out_jacobian();
  [[nodiscard]] ShootingSegment& segment_of(int step) const;
  [[nodiscard]] std::vector<Eigen::Index> columns_of(const ValuePlace& place) const override;
  void derivatives_of(const ValuePlace& place, std::vector<double>& out) override;
  [[nodiscard]] Inputs inputs_of(const ShootingSegment& segment, const Eigen::VectorXd& x,
                                 const Inputs& whole) const;
  [[nodiscard]] TrajectoryPartials share_of(const ShootingSegment& segment,
                                            const TrajectoryPartials& partials) const;
  void for_each_segment(const std::function<void(std::size_t)>& f);
  void gather_values(const Inputs& whole);
  void move_to(const Eigen::VectorXd& x);
  void differentiate(const Eigen::VectorXd& x);
  // Numbers of the trajectory depend on nearly all variables of a segment: their second partials
  // are summed as dense matrices, one block for each two segments that a pair reads.
  void add_second_places(const std::vector<SecondPlace>& places, EntryPlan& entries) const override;
  void put_second_partials(const std::vector<SecondPlace>& places, const Eigen::VectorXd& second,
                           EntryPlan& entries) override;
  [[nodiscard]] int segment_index(const ValuePlace& place) const;
  [[nodiscard]] Eigen::RowVectorXd tangent_of(const ValuePlace& place) const;
  void add_curvature(EntryPlan& entries) const override;
  void put_curvature(double sigma, const Eigen::VectorXd& lambda, EntryPlan& entries);

  int threads_ = 1;
  std::vector<char> reads_controls_;  // per measured row
  std::vector<std::unique_ptr<ShootingSegment>> segments_;
  EntryPlan jacobian_;

  Eigen::VectorXd x_;  // the last point
  bool differentiated_ = false;
  Eigen::MatrixXd map_jacobian_;
  TrajectoryValues values_;
};

}  // namespace hbar
