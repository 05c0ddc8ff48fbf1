#include "hbar/adjoint/derivatives/factorized_linearization.h"

#include "hbar/adjoint/trajectory/timeline.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/base/error.h"

namespace hbar {

std::function<std::string(int)> stage_names(const Horizon& horizon, const Timeline& timeline) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(timeline.stage_count()));
  for (int s = 0; s < timeline.stage_count(); ++s) {
    times.push_back(timeline.stage(s).time);
  }
  return [model = horizon.shared_model(), times = std::move(times)](int index) {
    const int stage = index / model->dof() + 1;
    return concat("stage ", stage, " (t = ", times[static_cast<std::size_t>(stage)],
                  "), coordinate ", model->coordinate_name(index % model->dof()));
  };
}

const Linearization& FactorizedLinearization::update(const Trajectory& trajectory) {
  const Linearization& out = linearizer_.linearize(trajectory);
  linearization_ = &out;
  solver_.factorize(out.H.matrix(), linearizer_.pattern_count(), [&] {
    return solvers::MatrixDescription{
        {.structure = solvers::Structure::kBlockTriangular, .block_sizes = out.block_sizes},
        stage_names(horizon_, trajectory.timeline)};
  });
  return out;
}

}  // namespace hbar
