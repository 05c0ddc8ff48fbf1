#pragma once

#include <concepts>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hbar/adjoint/design/design_map.h"
#include "hbar/core/base/hyper_dual.h"
#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// Parameters by name, for a formula to set. Those it does not set keep their nominal values.
class NamedParameters {
 public:
  explicit NamedParameters(const ParameterSet& set);

  /// @throws InvalidInput naming the nearest parameter if the set has none of that name
  [[nodiscard]] HyperDual& operator[](std::string_view name);

  [[nodiscard]] const std::vector<HyperDual>& values() const { return values_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, int, std::less<>> places_;
  std::vector<HyperDual> values_;   // in the set's order
  std::vector<std::string> names_;  // in the same
};

namespace detail {

/// Writes p(d), in the set's order.
using MapFormula = std::function<void(std::span<const HyperDual> d, std::vector<HyperDual>& p)>;

[[nodiscard]] DesignMapPointer make_formula_map(DesignVariables variables, MapFormula formula,
                                                std::vector<std::string> parameter_names = {});

}  // namespace detail

/// A map given by a formula, with exact first and second derivatives: d is evaluated with
/// hyper-dual numbers.
///
/// The formula takes d and returns all parameters in the set's order, as an array or a vector:
///
///     formula_map(variables, [](auto d) { return std::array{d[0], 0.5 * d[0] * d[1]}; })
///
/// Elementary functions are called without `std::`. Which parameters depend on which variables is
/// determined at the start values; dependences in a branch that is not taken there are not found.
///
/// @throws InvalidInput if the formula's result is not finite at the start; later, if it has
///         another size or depends on a variable that it did not depend on at the start
template <std::invocable<std::span<const HyperDual>> Formula>
[[nodiscard]] DesignMapPointer formula_map(DesignVariables variables, Formula formula) {
  return detail::make_formula_map(
      std::move(variables),
      [formula = std::move(formula)](std::span<const HyperDual> d, std::vector<HyperDual>& p) {
        const auto result = formula(d);
        p.assign(std::begin(result), std::end(result));
      });
}

/// The same with parameters by name:
///
///     formula_map(set, variables, [](auto d, auto& p) {
///       p["body.rod.mass"] = 7800.0 * d[0] * d[1] * d[1];
///       p["joint.elbow.translation.x"] = d[0] - 0.5;
///     })
///
/// Parameters that it does not name keep their nominal values.
template <std::invocable<std::span<const HyperDual>, NamedParameters&> Formula>
[[nodiscard]] DesignMapPointer formula_map(const ParameterSet& set, DesignVariables variables,
                                           Formula formula) {
  const NamedParameters nominal(set);
  return detail::make_formula_map(
      std::move(variables),
      [formula = std::move(formula), nominal](std::span<const HyperDual> d,
                                              std::vector<HyperDual>& p) {
        NamedParameters named = nominal;
        formula(d, named);
        p = named.values();
      },
      nominal.names());
}

}  // namespace hbar
