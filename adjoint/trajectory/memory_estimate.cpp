#include "hbar/adjoint/trajectory/memory_estimate.h"

#include <Eigen/LU>
#include <algorithm>

#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/adjoint/trajectory/timeline.h"
#include "hbar/contact/contact_forces.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model.h"
#include "hbar/solvers/newton/newton.h"

namespace hbar {
namespace {

constexpr double kNumber = sizeof(double);
/// What Eigen adds to an allocation to align it.
constexpr double kAlignment = 67.0;
/// Of motions, dynamics, pull-backs and mechanisms, as counted: of each, of a node and of a link.
constexpr double kWorkspace = 8900.0;
constexpr double kNode = 3000.0;
constexpr double kLink = 2200.0;
/// Touching points for which ContactForces makes room at most.
constexpr double kTouches = 1000.0;
/// Contact forces that are at work in a gradient at once: of the sweep, and of the values.
constexpr double kContactForces = 2.0;

/// Stages of which a simulation without halved steps consists, the initial state included.
double stage_count(const MemoryCounts& counts) {
  const Integrator& method = find_integrator(counts.integrator);
  const Integrator& starter = find_integrator(method.starter);
  return 1.0 + static_cast<double>(method.stages.size()) * counts.steps +
         static_cast<double>(starter.stages.size()) * (counts.restarts + 1.0);
}

double workspace_of(const Model& model) {
  const double n = model.dof();
  const double nodes = model.tree().node_count();
  const double links = model.link_count();
  double points = 0.0;
  for (const Link& link : model.links()) {
    points += static_cast<double>(link.body.contact_points.cols());
  }
  double tested = 0.0;
  for (const Contact& contact : model.contacts()) {
    tested += static_cast<double>(model.link(contact.link).body.contact_points.cols());
  }
  double bytes =
      kWorkspace + 2.0 * kNumber * n * n + kNode * nodes + kLink * links + 3.0 * kNumber * points;
  if (model.contact_count() > 0) {
    const double touches = std::min(tested, kTouches) * sizeof(TouchingPoint<double>);
    const double pairs = model.contact_count() * static_cast<double>(sizeof(ActivePair<double>));
    bytes += kContactForces * (nodes * links + touches + pairs);
  }
  return bytes;
}

}  // namespace

MemoryEstimate estimate_memory(const Model& model, const MemoryCounts& counts) {
  using Factors = Eigen::PartialPivLU<Eigen::MatrixXd>;
  const double n = model.dof();
  const double controls = model.control_count();
  const double steps = counts.steps;
  const double stages = stage_count(counts);
  // Timeline keeps where each step ends, and where each part of one does and how long it was.
  constexpr double kStage = sizeof(Stage) + sizeof(solvers::NewtonReport) + 16.0;
  constexpr double kStep = sizeof(int);
  MemoryEstimate out;
  out.workspace = workspace_of(model);
  out.trajectory = stages * (kStage + 2.0 * n * kNumber) + steps * (kStep + controls * kNumber);
  out.factors =
      stages * (sizeof(Factors) + n * n * kNumber + 2.0 * n * sizeof(int) + 3.0 * kAlignment);
  // Partials are read off values; then these go, and adjoints are swept from the partials.
  const double values = (2.0 * n + counts.measured + controls) * steps * kNumber;
  const double adjoints = (3.0 * n * stages + 2.0 * controls * steps) * kNumber;
  out.gradient = values + std::max(values, adjoints) + 8.0 * counts.parameters * kNumber;
  return out;
}

void require_memory(const Model& model, int steps, const MemoryEstimate& estimate, double limit) {
  const double bytes = estimate.total(false);
  if (!(bytes > limit)) {
    return;
  }
  const std::string compared = concat(" GB; the limit is ", limit * 1e-9, " GB: ");
  if (estimate.workspace > limit) {
    throw InvalidInput(concat("one step of ", model.dof(), " coordinates takes about ",
                              estimate.workspace * 1e-9, compared,
                              "take a smaller model or raise max_memory"));
  }
  throw InvalidInput(concat(steps, " steps of ", model.dof(),
                            " coordinates and their gradient take about ", bytes * 1e-9, compared,
                            "take fewer steps or raise max_memory"));
}

}  // namespace hbar
