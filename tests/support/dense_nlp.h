#pragma once

#include <Eigen/Core>

#include "hbar/adjoint/programs/transcription.h"
#include "hbar/adjoint/terms/constraint.h"
#include "hbar/adjoint/terms/value_access.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/solvers/nlp/nlp.h"
#include "tests/support/random.h"

namespace hbar::testing {

/// The matrix of a pattern and its values.
[[nodiscard]] inline Eigen::MatrixXd dense_of(const solvers::SparsityPattern& pattern,
                                              const Eigen::VectorXd& values, Eigen::Index rows,
                                              Eigen::Index columns) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, columns);
  for (std::size_t i = 0; i < pattern.rows.size(); ++i) {
    out(pattern.rows[i], pattern.columns[i]) += values[static_cast<Eigen::Index>(i)];
  }
  return out;
}

/// 1 where a pattern has an entry.
[[nodiscard]] inline Eigen::MatrixXd places_of(const solvers::SparsityPattern& pattern,
                                               Eigen::Index rows, Eigen::Index columns) {
  const auto count = static_cast<Eigen::Index>(pattern.rows.size());
  return dense_of(pattern, Eigen::VectorXd::Ones(count), rows, columns).cwiseMin(1.0);
}

/// dc/dx.                                                                       [m x n]
[[nodiscard]] inline Eigen::MatrixXd dense_jacobian(solvers::Nlp& nlp, const Eigen::VectorXd& x) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(nlp.jacobian_pattern().rows.size()));
  nlp.constraint_jacobian(x, values);
  return dense_of(nlp.jacobian_pattern(), values, nlp.constraint_limits().lower.size(), x.size());
}

/// Both triangles of the Lagrangian's Hessian.                                  [n x n]
[[nodiscard]] inline Eigen::MatrixXd dense_hessian(solvers::Nlp& nlp, const Eigen::VectorXd& x,
                                                   double sigma, const Eigen::VectorXd& lambda,
                                                   solvers::HessianKind kind) {
  const solvers::SparsityPattern& pattern = nlp.hessian_pattern(kind);
  Eigen::VectorXd values(static_cast<Eigen::Index>(pattern.rows.size()));
  nlp.lagrangian_hessian(x, sigma, lambda, kind, values);
  const Eigen::MatrixXd lower = dense_of(pattern, values, x.size(), x.size());
  return lower.selfadjointView<Eigen::Lower>();
}

/// df/dx.                                                                       [n]
[[nodiscard]] inline Eigen::VectorXd gradient_of(solvers::Nlp& nlp, const Eigen::VectorXd& x) {
  Eigen::VectorXd g(x.size());
  nlp.objective_gradient(x, g);
  return g;
}

/// c(x).                                                                        [m]
[[nodiscard]] inline Eigen::VectorXd constraints_of(solvers::Nlp& nlp, const Eigen::VectorXd& x) {
  Eigen::VectorXd c(nlp.constraint_limits().lower.size());
  nlp.constraints(x, c);
  return c;
}

/// The start, each entry moved by up to `by` in units of its scale.             [n]
[[nodiscard]] inline Eigen::VectorXd near_start(const solvers::Nlp& nlp, double by, unsigned seed) {
  const solvers::NlpVariables& variables = nlp.variables();
  return variables.start + Random(seed)
                               .vector(variables.start.size(), by)
                               .cwiseProduct(variables.scale.cwiseMin(1.0));
}

/// A row for every number of a horizon's trajectories, which is that number, in the order of
/// all_places.
[[nodiscard]] inline ConstraintPointer every_number(const Horizon& horizon) {
  const std::vector<ValuePlace> all = all_places(value_shape(horizon));
  const auto count = static_cast<Eigen::Index>(all.size());
  ConstraintRows rows{
      {}, Eigen::VectorXd::Constant(count, -1e9), Eigen::VectorXd::Constant(count, 1e9)};
  std::vector<PartialPlace> places;
  for (const ValuePlace& place : all) {
    places.push_back({static_cast<int>(rows.names.size()), place.field, place.step, place.index});
    rows.names.push_back(place_name(place));
  }
  return linear_constraint(std::move(rows), std::move(places), Eigen::VectorXd::Ones(count));
}

}  // namespace hbar::testing
