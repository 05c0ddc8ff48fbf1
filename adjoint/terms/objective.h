#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hbar/adjoint/trajectory/trajectory_values.h"
#include "hbar/adjoint/trajectory/value_place.h"
#include "hbar/core/base/error.h"

namespace hbar {

/// Partial derivatives ∂Ψ/∂(q̄, q̇̄, measured, u, p), shaped like TrajectoryValues.
struct TrajectoryPartials : Measured {
  explicit TrajectoryPartials(const TrajectoryValues& shape);

  Eigen::MatrixXd q;     ///<                                             [dof x N+1]
  Eigen::MatrixXd qdot;  ///<                                             [dof x N+1]
  Eigen::MatrixXd u;     ///<                                             [controls x N]
  Eigen::VectorXd p;     ///<                                             [parameters]
};

/// One summand of an objective Ψ(p, q̄, v̄) (15).
class ObjectiveTerm {
 public:
  ObjectiveTerm() = default;
  ObjectiveTerm(const ObjectiveTerm&) = delete;
  ObjectiveTerm& operator=(const ObjectiveTerm&) = delete;
  virtual ~ObjectiveTerm() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// The term's value.
  [[nodiscard]] virtual double value(const TrajectoryValues& values) const = 0;
  /// Adds the term's partials to `partials`.
  virtual void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const = 0;
  /// The pairs of numbers in which the term has second partials (`row` is 0).
  ///
  /// @param shape  sized as the values will be
  /// @throws InvalidInput if the term has no second partials (as this default does)
  [[nodiscard]] virtual std::vector<SecondPlace> second_places(const TrajectoryValues& shape) const;
  /// Writes the second partial of each of second_places(values).            [second places]
  virtual void second_partials(const TrajectoryValues& values,
                               Eigen::Ref<Eigen::VectorXd> second) const;
};

/// A sum of terms.
class Objective {
 public:
  Objective() = default;
  /// @throws InvalidInput for a null pointer, as add
  explicit Objective(std::shared_ptr<const ObjectiveTerm> term) { add(std::move(term)); }

  /// @throws InvalidInput for a null pointer
  Objective& add(std::shared_ptr<const ObjectiveTerm> term) {
    require_given("objective", "term", term);
    terms_.push_back(std::move(term));
    return *this;
  }
  [[nodiscard]] double value(const TrajectoryValues& values) const;
  [[nodiscard]] TrajectoryPartials partials(const TrajectoryValues& values) const;
  /// The second places of all terms, term by term: a pair may occur once per term, and its
  /// contributions add up.
  ///
  /// @param shape  sized as the values will be
  /// @throws InvalidInput naming the term that has no second partials
  [[nodiscard]] std::vector<SecondPlace> second_places(const TrajectoryValues& shape) const;
  /// The second partial of each of second_places(values).                   [second places]
  /// @throws NumericalFailure naming the term whose second partial is not finite
  [[nodiscard]] Eigen::VectorXd second_partials(const TrajectoryValues& values) const;
  [[nodiscard]] const std::vector<std::shared_ptr<const ObjectiveTerm>>& terms() const {
    return terms_;
  }

 private:
  std::vector<std::shared_ptr<const ObjectiveTerm>> terms_;
};

}  // namespace hbar
