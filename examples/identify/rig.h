#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "hbar/adjoint/programs/design_map.h"
#include "hbar/adjoint/programs/trajectory_problem.h"
#include "hbar/adjoint/study/trajectory_csv.h"

namespace hbar::identify {

/// What is unknown of a model, as parameters by their names. A body's moments of inertia grow with
/// its mass, so that "body.rod.mass" stands for a density. Linear: d ↦ p = P d.
class UnknownsMap final : public DesignMap {
 public:
  /// The parameters that move with the unknowns.
  /// @throws InvalidInput if a name is no parameter's, with the nearest that is
  [[nodiscard]] static ParameterSet parameters_of(const Model& model,
                                                  const std::vector<std::string>& unknowns);

  /// @param set    parameters_of(model, unknowns)
  /// @param start  factor > 0 of each unknown's value in the model, where a fit begins    [d]
  UnknownsMap(const ParameterSet& set, const std::vector<std::string>& unknowns,
              const Eigen::VectorXd& start);

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return P_.rows(); }
  [[nodiscard]] bool depends(Eigen::Index parameter, Eigen::Index variable) const override {
    return P_(parameter, variable) != 0.0;
  }
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override {
    return P_ * d;
  }
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd&) const override { return P_; }
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd&) const override {
    return Eigen::MatrixXd::Zero(d.size(), d.size());
  }
  /// The model's own values of the unknowns.                                              [d]
  [[nodiscard]] const Eigen::VectorXd& nominal() const { return nominal_; }

 private:
  Eigen::MatrixXd P_;
  Eigen::VectorXd nominal_;
  DesignVariables variables_;
};

/// Standard deviations of what is measured, by the name of its column.
using Sigmas = std::map<std::string, double>;

/// 1 mm on the rail, 5 mrad at the hinge.
[[nodiscard]] Sigmas default_sigmas();
/// Masses of carriage and rod, damping of rail and hinge, friction of the shoe.
[[nodiscard]] std::vector<std::string> default_unknowns();

/// How the rig is set up.
struct RigOptions {
  std::filesystem::path scene;
  int steps = 200;          ///< of 10 ms
  int segments = 1;         ///< in each the integrator starts anew, as multiple shooting asks
  bool sliding = true;      ///< the shoe is pressed down now and then; else it hovers all the time
  bool wrong_start = true;  ///< a fit begins far from the scene's values; else there
  std::vector<std::string> unknowns = default_unknowns();
};

/// A carriage whose motors push and press in a known way, with a rod that starts turned by 0.8 rad.
struct Rig {
  Horizon horizon;
  std::shared_ptr<const UnknownsMap> map;
  Eigen::MatrixXd u;   ///< known controls                                       [controls x N]
  Eigen::VectorXd q0;  ///< known, at rest                                              [dof]
};

/// @throws IoError, InvalidInput  as read_scene, or if the scene is no such rig
[[nodiscard]] Rig make_rig(const RigOptions& options);

/// A motion of the rig, simulated with the scene's own values, as a table: the coordinates that
/// have a σ, with normal errors added, and the controls.
///
/// @throws InvalidInput if no coordinate has a σ
/// @throws NumericalFailure if the simulation fails
[[nodiscard]] std::string recorded_csv(const Rig& rig, const Sigmas& sigmas,
                                       std::mt19937_64& random);

/// What was measured, and the controls that acted.
struct Recording {
  study::TrajectoryData data;  ///< without controls
  Eigen::VectorXd sigma;       ///< of each datum                                        [data]
  Eigen::MatrixXd u;           ///< those in the table; the rig's where it has none [controls x N]
};

/// Reads such a table, or one that somebody measured.
///
/// @param file  its name for messages
/// @throws InvalidInput as read_trajectory_csv, or naming a column without σ, or a control that is
///   given at some steps only
[[nodiscard]] Recording read_recording(const Rig& rig, const Sigmas& sigmas,
                                       const std::string& text, const std::string& file);

}  // namespace hbar::identify
