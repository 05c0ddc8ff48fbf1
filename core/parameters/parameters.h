#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/model/mechanism.h"
#include "hbar/core/parameters/parameter.h"

namespace hbar {

/// Which parameters are free, and their order in the vector p: by kind, then by link (or motor) in
/// file order, then by component. The single registry: everything that reads or writes p goes
/// through it. Immutable; copies share what they hold.
class ParameterSet {
 public:
  /// No parameter.
  ParameterSet() : ParameterSet(std::vector<Parameter>()) {}
  ParameterSet(const ParameterSet&) = default;
  ParameterSet& operator=(const ParameterSet&) = default;
  ~ParameterSet() = default;

  /// Every parameter of the model.
  [[nodiscard]] static ParameterSet all(const Model& model);
  /// Those that the links' design masks select (motor gains and gravity have no bit).
  [[nodiscard]] static ParameterSet masked(const Model& model);
  /// Those named: a full name, or a prefix that ends at a dot ("joint.knee", "body.shin.inertia").
  /// @throws InvalidInput for a name that matches nothing, suggesting the nearest that does
  [[nodiscard]] static ParameterSet named(const Model& model,
                                          const std::vector<std::string>& names);

  [[nodiscard]] int size() const { return static_cast<int>(parameters().size()); }
  [[nodiscard]] const std::vector<Parameter>& parameters() const { return data_->parameters; }
  [[nodiscard]] const std::vector<ParameterBlock>& blocks() const { return data_->blocks; }
  /// @throws InvalidInput if i is not in 0 … size() − 1
  [[nodiscard]] const Parameter& operator[](int i) const {
    require_index("parameter", i, size());
    return parameters()[static_cast<std::size_t>(i)];
  }

  /// Index in p of a full name.
  /// @throws InvalidInput if it is not in the set
  [[nodiscard]] int find(std::string_view name) const;

  /// Index in p of a component; −1 if it is not in the set.
  [[nodiscard]] int index(ParameterKind kind, int owner, int component) const;

  [[nodiscard]] Eigen::VectorXd nominal() const;  ///< [size]
  [[nodiscard]] Eigen::VectorXd lower() const;    ///< [size]
  [[nodiscard]] Eigen::VectorXd upper() const;    ///< [size]

  /// The same parameters, with the same nominal values and bounds.
  friend bool operator==(const ParameterSet& a, const ParameterSet& b) {
    return a.data_ == b.data_ || a.parameters() == b.parameters();
  }

 private:
  explicit ParameterSet(std::vector<Parameter> parameters);

  struct Data {
    std::vector<Parameter> parameters;
    std::vector<ParameterBlock> blocks;
  };

  std::shared_ptr<const Data> data_;
};

/// @throws InvalidInput if the set is not of this model: naming the first parameter that the model
///         lacks, or whose nominal value or bound is another one there
void require_parameters_of(const Model& model, const ParameterSet& set);

/// @param p  values of the set's parameters                                     [set.size()]
/// @throws InvalidInput naming the first parameter that is negative and must not be (stiffness,
///   damping, motor gains, contact coefficients and scales) or not positive and must be (sizes)
void require_in_range(const ParameterSet& set, const Eigen::VectorXd& p);

/// Sets to 0 what require_in_range would refuse for being negative by less than 1e-6 of its nominal
/// value or of 1: optimisers relax bounds by about 1e-8.
///
/// @param[in,out] p  values of the set's parameters                             [set.size()]
void round_into_range(const ParameterSet& set, Eigen::VectorXd& p);

/// Sets a mechanism's numbers to the model's own, with p in place of those in the set.
///
/// @param p  values of the set's parameters                                     [set.size()]
/// @throws InvalidInput if p has another size, is not finite, or makes a mass, moment or size
///         non-positive or the moments violate the triangle inequality; the message names the
///         parameter. Other ranges are require_in_range's
template <Scalar S>
void apply_parameters(const Model& model, const ParameterSet& set, const VectorView<S>& p,
                      Mechanism<S>& mechanism);

}  // namespace hbar
