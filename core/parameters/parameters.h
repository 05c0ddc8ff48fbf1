#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/model/mechanism.h"
#include "hbar/core/parameters/parameter.h"

namespace hbar {

/// Which parameters are free, and their order in the vector p: by kind, then by link (or motor) in
/// file order, then by component. The single registry: everything that reads or writes p goes
/// through it.
class ParameterSet {
 public:
  /// No parameter.
  ParameterSet() = default;

  /// Every parameter of the model.
  [[nodiscard]] static ParameterSet all(const Model& model);
  /// Those that the links' design masks select (motor gains and gravity have no bit).
  [[nodiscard]] static ParameterSet masked(const Model& model);
  /// Those named: a full name, or a prefix that ends at a dot ("joint.knee", "body.shin.inertia").
  /// @throws InvalidInput for a name that matches nothing, suggesting the nearest that does
  [[nodiscard]] static ParameterSet named(const Model& model,
                                          const std::vector<std::string>& names);

  [[nodiscard]] int size() const { return static_cast<int>(parameters_.size()); }
  [[nodiscard]] const std::vector<Parameter>& parameters() const { return parameters_; }
  [[nodiscard]] const std::vector<ParameterBlock>& blocks() const { return blocks_; }
  [[nodiscard]] const Parameter& operator[](int i) const {
    return parameters_[static_cast<std::size_t>(i)];
  }

  /// Index in p of a full name.
  /// @throws InvalidInput if it is not in the set
  [[nodiscard]] int find(std::string_view name) const;

  /// Index in p of a component; −1 if it is not in the set.
  [[nodiscard]] int index(ParameterKind kind, int owner, int component) const;

  [[nodiscard]] Eigen::VectorXd nominal() const;  ///< [size]
  [[nodiscard]] Eigen::VectorXd lower() const;    ///< [size]
  [[nodiscard]] Eigen::VectorXd upper() const;    ///< [size]

 private:
  explicit ParameterSet(std::vector<Parameter> parameters);

  std::vector<Parameter> parameters_;
  std::vector<ParameterBlock> blocks_;
};

/// Sets a mechanism's numbers to the model's own, with p in place of those in the set.
///
/// @param p  values of the set's parameters                                     [set.size()]
/// @throws InvalidInput if p has another size, is not finite, or makes a mass or moment
///         non-positive or the moments violate the triangle inequality; the message names the
///         parameter
template <Scalar S>
void apply_parameters(const Model& model, const ParameterSet& set, const VectorView<S>& p,
                      Mechanism<S>& mechanism);

}  // namespace hbar
