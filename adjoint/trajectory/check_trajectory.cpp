#include "hbar/adjoint/trajectory/check_trajectory.h"

#include <cmath>

#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

void refuse(std::string_view what) {
  throw InvalidInput(concat("the trajectory does not belong to this horizon: ", what,
                            "; take one that the same horizon simulated"));
}

void require_shapes(const Horizon& horizon, const Trajectory& trajectory) {
  const Inputs& inputs = trajectory.inputs;
  const Eigen::Index stages = trajectory.timeline.stage_count();
  const int n = horizon.model().dof();
  if (trajectory.q.rows() != n || trajectory.qdot.rows() != n || trajectory.q.cols() != stages ||
      trajectory.qdot.cols() != stages) {
    refuse(concat("its states are ", trajectory.q.rows(), " x ", trajectory.q.cols(), " and ",
                  trajectory.qdot.rows(), " x ", trajectory.qdot.cols(), ", not ", n, " x ",
                  stages));
  }
  if (inputs.p.size() != horizon.parameters().size() || inputs.q0.size() != n ||
      inputs.qdot0.size() != n || inputs.u.rows() != horizon.model().control_count() ||
      inputs.u.cols() != horizon.steps()) {
    refuse(concat("its inputs are ", inputs.p.size(), " parameters, ", inputs.u.rows(), " x ",
                  inputs.u.cols(), " controls and ", inputs.q0.size(), " + ", inputs.qdot0.size(),
                  " initial values, not ", horizon.parameters().size(), ", ",
                  horizon.model().control_count(), " x ", horizon.steps(), ", ", n, " + ", n));
  }
}

}  // namespace

void require_trajectory_of(const Horizon& horizon, const Trajectory& trajectory) {
  if (trajectory.model == nullptr || trajectory.mechanism == nullptr) {
    refuse("it is empty, or was moved from");
  }
  if (trajectory.model != horizon.shared_model() && !(*trajectory.model == horizon.model())) {
    refuse(concat("it is of another model, '", trajectory.model->name(), "'"));
  }
  if (trajectory.parameters != horizon.parameters()) {
    refuse(concat("it was simulated with ", trajectory.parameters.size(),
                  " free parameters, the horizon has ", horizon.parameters().size(),
                  trajectory.parameters.size() == horizon.parameters().size() ? " others" : ""));
  }
  if (trajectory.integrator != horizon.integrator().name) {
    refuse(concat("its steps are ", trajectory.integrator, "'s, the horizon's are ",
                  horizon.integrator().name, "'s"));
  }
  const int steps = trajectory.step_count();
  if (steps > horizon.steps()) {
    refuse(concat("it has ", steps, " steps, the horizon ", horizon.steps()));
  }
  const double h = horizon.options().h;
  const double end = trajectory.timeline.stage(trajectory.timeline.step_end(steps)).time;
  if (!(std::abs(end - steps * h) <= 1e-6 * h * steps)) {
    refuse(concat("its ", steps, " steps end at ", end, ", those of the horizon at ", steps * h));
  }
  require_shapes(horizon, trajectory);
}

void require_whole_trajectory_of(const Horizon& horizon, const Trajectory& trajectory) {
  require_trajectory_of(horizon, trajectory);
  if (trajectory.step_count() < horizon.steps()) {
    throw InvalidInput(concat("the trajectory has ", trajectory.step_count(), " of ",
                              horizon.steps(),
                              " steps; this needs a whole one, which "
                              "Rollout::trajectory gives or refuses"));
  }
}

}  // namespace hbar
