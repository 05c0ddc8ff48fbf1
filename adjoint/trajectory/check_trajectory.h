#pragma once

namespace hbar {

class Horizon;
struct Trajectory;

/// @throws InvalidInput unless the trajectory is of the horizon's model, parameters and time step.
///         It may have fewer steps, as what Rollout::partial gives
void require_trajectory_of(const Horizon& horizon, const Trajectory& trajectory);

/// The same for what needs a whole trajectory.
/// @throws InvalidInput as require_trajectory_of, or if steps are missing
void require_whole_trajectory_of(const Horizon& horizon, const Trajectory& trajectory);

}  // namespace hbar
