#include "hbar/adjoint/systems/trajectory_system.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hbar/adjoint/derivatives/factorized_linearization.h"
#include "hbar/adjoint/systems/optimality_matrix.h"
#include "hbar/adjoint/systems/periodic_matrix.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using solvers::SparseMatrix;

constexpr std::array<std::string_view, 4> kNames = {"adjoint", "periodic", "gauss_newton", "kkt"};

void check(const SystemOptions& options) {
  const auto refuse = [](std::string_view name, double value, std::string_view allowed) {
    throw InvalidInput(concat("system: ", name, " is ", value, "; it must be ", allowed));
  };
  const auto non_negative = [&](std::string_view name, double value) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      refuse(name, value, "0 or more, and finite");
    }
  };
  const auto positive = [&](std::string_view name, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      refuse(name, value, "positive and finite");
    }
  };
  non_negative("tracking", options.tracking);
  non_negative("forces", options.forces);
  non_negative("effort", options.effort);
  positive("damping", options.damping);
  positive("slack", options.slack);
}

/// −∂ḡ/∂q̇₀·1.
Eigen::VectorXd push(const Linearization& system) {
  const SparseMatrix& by_qdot0 = system.dg_dqdot0.matrix();
  return -(by_qdot0 * Eigen::VectorXd::Ones(by_qdot0.cols()));
}

}  // namespace

std::string_view name_of(SystemKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

SystemKind find_system_kind(std::string_view name) {
  const auto place = std::find(kNames.begin(), kNames.end(), name);
  if (place == kNames.end()) {
    std::string known;
    for (const std::string_view kind : kNames) {
      known += concat(' ', kind);
    }
    throw InvalidInput(concat("there is no system \"", name, "\"; known:", known));
  }
  return static_cast<SystemKind>(place - kNames.begin());
}

TrajectorySystem assemble_system(SystemKind kind, const Horizon& horizon,
                                 const Trajectory& trajectory, const SystemOptions& options) {
  check(options);
  Linearizer linearizer(horizon);
  const Linearization& system = linearizer.linearize(trajectory);
  TrajectorySystem out;
  out.kind = kind;
  out.name_of_unknown = stage_names(horizon, trajectory.timeline);
  switch (kind) {
    case SystemKind::kAdjoint:
      out.A = system.H.matrix();
      out.b = push(system);
      out.options = {.structure = solvers::Structure::kBlockTriangular,
                     .block_sizes = system.block_sizes};
      break;
    case SystemKind::kPeriodic:
      out.A = periodic_matrix(horizon.model(), trajectory, system);
      out.b = push(system);
      out.options = periodic_options(system);
      break;
    case SystemKind::kGaussNewton:
      fill_gauss_newton(horizon, trajectory, system, options, out);
      break;
    case SystemKind::kKkt:
      fill_kkt(horizon, trajectory, system, options, out);
      break;
  }
  return out;
}

}  // namespace hbar
