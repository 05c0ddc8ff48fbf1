#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hbar/adjoint/programs/design_map.h"
#include "hbar/adjoint/terms/constraint.h"

namespace hbar::finger_reach {

/// A part of the finger between two hinges: a cuboid along x, as thick as it is wide.
struct Phalanx {
  std::string body;        ///< its name, and its link's
  std::string next_joint;  ///< the joint at its end
  double length = 0.0;     ///< along x, m
  double width = 0.0;      ///< along y and z, m
  double density = 0.0;    ///< kg/m³
};

/// The phalanges of examples/scenes/finger.xml as the scene has them.
/// @throws InvalidInput if the model has no such bodies, or a body is not such a cuboid
[[nodiscard]] std::array<Phalanx, 3> phalanges(const Model& model);

/// What a phalanx's size decides: where the next joint and its own body sit, its mass and moments.
///
/// @param payload  the mass at the tip is among them
[[nodiscard]] ParameterSet finger_parameters(const Model& model, bool payload = false);

/// Lengths and widths of the phalanges onto finger_parameters: d = (3 lengths, 3 widths), and if
/// the tip's mass is in the set, a payload at the tip that is given (its bounds leave it no room).
class FingerMap final : public DesignMap {
 public:
  /// @param payload  kg
  FingerMap(const std::array<Phalanx, 3>& phalanges, const ParameterSet& set, double payload = 0.0);

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return count_; }
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override;
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const override;
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd& y) const override;

 private:
  /// Where a phalanx's parameters stand in p.
  struct Places {
    int joint_x = 0;  ///< next joint's offset from its nominal place
    int body_x = 0;   ///< body's offset
    int mass = 0;
    int inertia = 0;  ///< the first of three
  };

  void add_payload(const ParameterSet& set, double payload);

  std::array<Phalanx, 3> phalanges_;
  std::array<Places, 3> places_;
  int tip_ = -1;  // its mass in p
  double tip_mass_ = 0.0;
  Eigen::Index count_ = 0;
  DesignVariables variables_;
};

/// No phalanx longer than `ratio` times its width, from p alone: width²/length² = m / (ρ length³).
[[nodiscard]] ConstraintPointer slenderness(const std::array<Phalanx, 3>& phalanges,
                                            const ParameterSet& set, double ratio);

}  // namespace hbar::finger_reach
