#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "hbar/adjoint/design/design_map.h"
#include "hbar/adjoint/programs/trajectory_problem.h"
#include "hbar/adjoint/study/trajectory_csv.h"

namespace hbar::identify {

/// The parameters that depend on the unknowns, which are named parameters. A body's moments of
/// inertia grow with its mass, so that "body.rod.mass" stands for a density.
/// @throws InvalidInput for an unknown parameter, suggesting the nearest one
[[nodiscard]] ParameterSet unknown_parameters(const Model& model,
                                              const std::vector<std::string>& unknowns);

/// Maps unknowns to unknown_parameters. Linear.
///
/// @param start  factor > 0 of each unknown's value in the model, where a fit begins    [d]
/// @throws InvalidInput if an unknown is not positive in the model
[[nodiscard]] DesignMapPointer unknowns_map(const ParameterSet& set,
                                            const std::vector<std::string>& unknowns,
                                            const Eigen::VectorXd& start);

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
  int segments = 1;         ///< the integrator restarts in each, as in multiple shooting
  bool sliding = true;      ///< the shoe is pressed down now and then; else it hovers all the time
  bool wrong_start = true;  ///< a fit begins far from the scene's values; else there
  std::vector<std::string> unknowns = default_unknowns();
};

/// A carriage whose motors push and press in a known way, with a rod that starts turned by 0.8 rad.
struct Rig {
  Horizon horizon;
  DesignMapPointer map;
  Eigen::VectorXd nominal;  ///< the scene's own values of the unknowns                  [d]
  Eigen::MatrixXd u;        ///< known controls                                       [controls x N]
  Eigen::VectorXd q0;       ///< known, at rest                                              [dof]
};

/// @throws IoError, InvalidInput  as read_scene, or if the scene is not such a rig
[[nodiscard]] Rig make_rig(const RigOptions& options);

/// A motion of the rig, simulated with the scene's own values, as a table: the coordinates that
/// have a σ, with normal errors added, and the controls.
///
/// @throws InvalidInput if no coordinate has a σ
/// @throws NumericalFailure if the simulation fails
[[nodiscard]] std::string recorded_csv(const Rig& rig, const Sigmas& sigmas,
                                       std::mt19937_64& random);

/// The measured data, and the controls that acted.
struct Recording {
  study::TrajectoryData data;
  Eigen::VectorXd sigma;  ///< of each datum                                        [data]
  Eigen::MatrixXd u;      ///< those in the table; the rig's where it has none [controls x N]
};

/// Reads such a table, or a measured one.
///
/// @param file  its name for messages
/// @throws InvalidInput as read_trajectory_csv, or naming a column without σ, or a control that is
///   given at some steps only
[[nodiscard]] Recording read_recording(const Rig& rig, const Sigmas& sigmas,
                                       const std::string& text, const std::string& file);

}  // namespace hbar::identify
