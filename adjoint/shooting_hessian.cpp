// The Hessian of the Lagrangian of Shooting.
#include <utility>

#include "hbar/adjoint/shooting.h"
#include "hbar/core/error.h"

namespace hbar {

Shooting::HessianPlan Shooting::make_plan(solvers::HessianKind kind) const {
  HessianPlan out = begin_plan(kind);
  if (kind == solvers::HessianKind::kExact) {
    for (const auto& segment : segments_) {
      const SegmentColumns& columns = segment->columns();
      for (Eigen::Index j = 0; j < columns.size(); ++j) {
        for (Eigen::Index i = j; i < columns.size(); ++i) {
          out.entries.add_lower(columns.place(i), columns.place(j));
        }
      }
    }
  }
  out.entries.finish();
  return out;
}

Shooting::HessianPlan& Shooting::plan(solvers::HessianKind kind) {
  std::optional<HessianPlan>& kept = kind == solvers::HessianKind::kExact ? exact_ : gauss_newton_;
  if (!kept) {
    kept = make_plan(kind);
  }
  return *kept;
}

const solvers::SparsityPattern& Shooting::hessian_pattern(solvers::HessianKind kind) {
  return plan(kind).entries.pattern();
}

/// How the numbers that the terms read bend with x: of each segment, weights being the terms'
/// partials and the multipliers of continuity.
void Shooting::put_curvature(double sigma, const Eigen::VectorXd& lambda, EntryPlan& entries) {
  const TrajectoryPartials partials = lagrangian_partials(values_, sigma, lambda);
  std::vector<Eigen::MatrixXd> curvatures(segments_.size());
  std::vector<Eigen::VectorXd> by_p(segments_.size());
  std::vector<TrajectoryPartials> shares;
  Eigen::Index first = own_rows();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    shares.push_back(share_of(*segments_[i], partials));
    if (i + 1 < segments_.size()) {
      const Eigen::Index dof = shares[i].q.rows();
      shares[i].q.rightCols<1>() += lambda.segment(first, dof);
      shares[i].qdot.rightCols<1>() += lambda.segment(first + dof, dof);
      first += 2 * dof;
    }
  }
  for_each_segment([&](std::size_t i) {
    curvatures[i] = segments_[i]->curvature(shares[i], map_jacobian_, by_p[i]);
  });
  for (std::size_t i = 1; i < segments_.size(); ++i) {
    by_p[0] += by_p[i];
  }
  const Eigen::Index designs = head_.design_count();
  if (designs > 0) {
    curvatures[0].topLeftCorner(designs, designs) += problem_.map->hessian(design(x_), by_p[0]);
  }
  for (const Eigen::MatrixXd& curvature : curvatures) {
    for (Eigen::Index j = 0; j < curvature.cols(); ++j) {
      for (Eigen::Index i = j; i < curvature.rows(); ++i) {
        entries.put(curvature(i, j));
      }
    }
  }
}

void Shooting::lagrangian_hessian(const Eigen::VectorXd& x, double sigma,
                                  const Eigen::VectorXd& lambda, solvers::HessianKind kind,
                                  Eigen::VectorXd& values) {
  const Stopwatch stopwatch(times_.hessian);
  ++times_.hessians;
  HessianPlan& at = plan(kind);
  differentiate(x);
  begin_values(at, values_, sigma, lambda, values);
  if (kind == solvers::HessianKind::kExact) {
    try {
      put_curvature(sigma, lambda, at.entries);
    } catch (const NumericalFailure& error) {
      throw solvers::EvaluationError(error.what());
    }
  }
}

}  // namespace hbar
