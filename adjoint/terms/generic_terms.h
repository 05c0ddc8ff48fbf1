#pragma once

#include <concepts>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "hbar/adjoint/terms/constraint.h"
#include "hbar/adjoint/terms/separable_term.h"
#include "hbar/core/base/hyper_dual.h"
#include "hbar/core/base/scalar.h"

namespace hbar {

/// A custom formula of some numbers, written once for double, Dual and HyperDual; its derivatives
/// follow from the formula alone.
///
/// Made from any callable `T f(std::span<const T> x)` that accepts each T, such as a generic
/// lambda:
///
///     [](auto x) { return sqrt(x[0] * x[0] + x[1] * x[1]); }
///
/// Elementary functions are called without `std::`, so that those of the number's own type are
/// found; `using std::sqrt;` inside the formula serves double.
class GenericFormula {
 public:
  template <typename F>
  requires(!std::same_as<std::remove_cvref_t<F>, GenericFormula>)
      GenericFormula(F&& f)  // NOLINT: a formula is what it is made from
      : calls_(std::make_shared<const CallsOf<std::remove_cvref_t<F>>>(std::forward<F>(f))) {}

  /// The formula's value, with the derivatives that the number type carries.
  [[nodiscard]] double operator()(std::span<const double> x) const { return calls_->call(x); }
  [[nodiscard]] Dual operator()(std::span<const Dual> x) const { return calls_->call(x); }
  [[nodiscard]] HyperDual operator()(std::span<const HyperDual> x) const { return calls_->call(x); }

 private:
  struct Calls {
    virtual ~Calls() = default;
    virtual double call(std::span<const double> x) const = 0;
    virtual Dual call(std::span<const Dual> x) const = 0;
    virtual HyperDual call(std::span<const HyperDual> x) const = 0;
  };
  template <typename F>
  struct CallsOf final : Calls {
    explicit CallsOf(F callable) : f(std::move(callable)) {}
    double call(std::span<const double> x) const override { return f(x); }
    Dual call(std::span<const Dual> x) const override { return f(x); }
    HyperDual call(std::span<const HyperDual> x) const override { return f(x); }
    F f;
  };

  std::shared_ptr<const Calls> calls_;
};

/// f of the numbers at some places, as a term: partials from Dual, second partials from HyperDual
/// for each pair of places.
///
/// @param places  arguments of f, each once
/// @throws InvalidInput if a place is named twice
[[nodiscard]] TermPointer generic_term(std::string name, std::vector<ValuePlace> places,
                                       GenericFormula f);

/// Σ weight f(numbers at a group of places), for example one formula at every step.
///
/// @param groups   each the arguments of f; no place twice within a group
/// @param weights  one per group; empty: ones                                       [groups]
/// @throws InvalidInput if the sizes differ, or a group names a place twice
[[nodiscard]] TermPointer generic_sum(std::string name, std::vector<std::vector<ValuePlace>> groups,
                                      GenericFormula f,
                                      Eigen::VectorXd weights = Eigen::VectorXd());

/// One row of a generic_constraint.
struct GenericRow {
  std::string name;
  double lower = 0.0;  ///< − infinity if there is no bound
  double upper = 0.0;  ///< + infinity if there is no bound
  std::vector<ValuePlace> places;
  GenericFormula f;
};

/// Rows lower ≤ f(numbers at the row's places) ≤ upper, each with its own formula.
/// @throws InvalidInput as ConstraintTerm's constructor, or if a row names a place twice
[[nodiscard]] ConstraintPointer generic_constraint(std::vector<GenericRow> rows);

/// The same with one formula for all rows.
///
/// @param places  of each row, the arguments of f                                      [rows]
[[nodiscard]] ConstraintPointer generic_constraint(
    const ConstraintRows& rows, const std::vector<std::vector<ValuePlace>>& places,
    const GenericFormula& f);

}  // namespace hbar
