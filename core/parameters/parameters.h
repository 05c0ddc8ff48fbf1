#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/model/mechanism.h"

namespace hbar {

/// Classes of design parameter, in the order in which they are listed: Table II of the document by
/// its roman numbers, then what the document does not free.
enum class ParameterKind {
  kJointTransform,  ///< I: rotation vector w and translation t, X_PJ = (R̄ exp([w]), p̄ + t)
  kBodyTransform,   ///< II: the same for X_JB
  kContactPoint,    ///< III: x, y, z of each contact point in the body frame, at nominal sizes
  kMass,            ///< IV: at nominal sizes
  kInertia,         ///< IV: principal moments, at nominal sizes
  kStiffness,       ///< V
  kDamping,         ///< V
  kContactScale,    ///< VI: s of the body whose points touch
  kMotorP,
  kMotorD,
  kGravity,
  kContactCoefficient,  ///< k_n, k_t, μ, k_d of a contact
  kSize  ///< of a body's shape: moves its contact points and surface, scales its mass and moments
};

/// The classes, with the name each has in messages and reports.
[[nodiscard]] const std::vector<ParameterKind>& parameter_kinds();
[[nodiscard]] std::string_view kind_name(ParameterKind kind);

/// One scalar design parameter.
struct Parameter {
  ParameterKind kind = ParameterKind::kJointTransform;
  int owner = 0;         ///< link, motor or contact; 0 for gravity
  int component = 0;     ///< within its kind and owner
  std::string name;      ///< as in scene_format.md: "joint.NAME.rotation.x", "body.NAME.mass", …
  std::string unit;      ///< in the model's unit system
  double nominal = 0.0;  ///< the model's own value; 0 for transformations
  double lower = 0.0;    ///< physical bound
  double upper = 0.0;
};

/// Scalars of one kind and owner that stand together in p.
struct ParameterBlock {
  ParameterKind kind = ParameterKind::kJointTransform;
  int owner = 0;
  int first = 0;  ///< index in p
  int size = 0;
};

/// Which parameters are free, and in which order they stand in the vector p: by kind, then by link
/// (or motor) in file order, then by component. The single registry: everything that reads or
/// writes p goes through it.
class ParameterSet {
 public:
  /// No parameter.
  ParameterSet() = default;

  /// Every parameter of the model.
  [[nodiscard]] static ParameterSet all(const Model& model);
  /// Those that the links' design masks select (motor gains and gravity have no bit).
  [[nodiscard]] static ParameterSet masked(const Model& model);
  /// Those named: a full name, or a prefix that ends at a dot ("joint.knee", "body.shin.inertia").
  /// @throws InvalidInput for a name that matches nothing, with the nearest that does
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
/// @throws InvalidInput if p has another size, is not finite, or makes a mass or a moment not
///         positive or a triangle of moments impossible; the message names the parameter
template <Scalar S>
void apply_parameters(const Model& model, const ParameterSet& set, const VectorView<S>& p,
                      Mechanism<S>& mechanism);

}  // namespace hbar
