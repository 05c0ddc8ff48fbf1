// A scene: text, description, model, a few steps of simulation, the gradient.

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "hbar/core/scene/read_xml.h"
#include "hbar/core/scene/write_xml.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

using scene::Description;

constexpr int kSteps = 3;

// What a scene may ask for here; more is slow, and no mistake of a reader.
constexpr double kMostPoints = 1000.0;
constexpr int kMostCells = 12;
constexpr int kMostLinks = 20;
constexpr int kMostIterations = 100;
constexpr int kMostHalvings = 2;  // each doubles the steps that a hopeless motion takes

/// The files that scenes name, in a folder where their distance grids may be cached.
const ScratchFolder& folder() {
  static const ScratchFolder kFolder;
  static const bool kFilled = [] {
    for (const auto& entry : std::filesystem::directory_iterator(HBAR_FUZZ_FILES)) {
      std::filesystem::copy(entry.path(), kFolder.path());
    }
    return true;
  }();
  static_cast<void>(kFilled);
  return kFolder;
}

template <std::size_t n>
double product(const std::array<int, n>& counts) {
  double points = 1.0;
  for (const int count : counts) {
    points *= count;
  }
  return points;
}

struct PointCount {
  double operator()(const scene::CuboidBody& body) const {
    return product(body.general_contact_resolution);
  }
  double operator()(const scene::SphereBody& body) const {
    return body.general_contact_resolution ? product(*body.general_contact_resolution) : 1.0;
  }
  double operator()(const scene::CylinderBody& body) const {
    return product(
        std::array{body.general_contact_angle_resolution, body.general_contact_radius_resolution});
  }
  double operator()(const scene::CapsuleBody& body) const {
    return product(body.general_contact_resolution);
  }
  double operator()(const scene::MeshBody& body) const {
    return body.distance_cells > kMostCells ? 2.0 * kMostPoints : body.contact_count;
  }
  double operator()(const scene::AbstractBody&) const { return 0.0; }
  double operator()(const scene::RectArray& points) const { return product(points.resolution); }
  double operator()(const scene::PointList&) const { return 0.0; }
};

bool is_large(const Description& description) {
  double points = 0.0;
  std::size_t links = 0;
  for (const scene::Robot& robot : description.robots) {
    links += robot.links.size();
    for (const scene::Link& link : robot.links) {
      points += std::visit(PointCount(), link.body.shape);
    }
  }
  for (const scene::TactileSensor& sensor : description.tactile_sensors) {
    points += std::visit(PointCount(), sensor.points);
  }
  const auto pairs = static_cast<double>(1 + description.contacts.size());
  return points * pairs > kMostPoints || links > kMostLinks ||
         description.solver_options.max_iter > kMostIterations ||
         description.solver_options.max_ls > kMostIterations;
}

/// What was read can be written, and is the same when it is read again.
void check_round_trip(const Description& description) {
  std::string text;
  try {
    text = scene::write_scene_text(description);
  } catch (const InvalidInput& error) {
    fail(concat("a scene that was read cannot be written: ", error.what()));
  }
  const scene::Scene again = scene::read_scene_text(text, "written.xml", folder().path());
  require(again.description == description, "a written scene reads back differently");
  require(scene::write_scene_text(again.description) == text, "a scene is written differently");
}

/// Simulates and differentiates: a result that claims to be one consists of numbers.
void simulate_and_differentiate(const std::filesystem::path& file) {
  LoadOptions load;
  load.steps = kSteps;
  load.parameters = ParameterChoice::kAll;
  const LoadedProblem loaded = load_problem(file, load);
  const Problem& problem = loaded.problem;
  Inputs inputs = problem.inputs;
  inputs.q0.setConstant(0.1);
  inputs.qdot0.setConstant(0.05);
  inputs.u.setConstant(0.2);
  SimulationOptions options = problem.horizon.options();
  options.max_halvings = kMostHalvings;
  const Horizon horizon = problem.horizon.with(options);
  const Rollout rollout = simulate(horizon, inputs);
  const Trajectory& reached = rollout.partial();
  require(reached.q.allFinite() && reached.qdot.allFinite(), "a trajectory that is not finite");
  require(rollout.converged() == rollout.report().message.empty(),
          "a failure without a message, or a message without one");
  if (!rollout.converged()) {
    return;
  }
  const Gradient found = gradient(horizon, reached, problem.objective);
  const bool finite =
      found.p.allFinite() && found.u.allFinite() && found.q0.allFinite() && found.qdot0.allFinite();
  require(finite || !std::isfinite(found.value), "a gradient that is not finite");
}

}  // namespace

void try_input(std::string_view input) {
  const scene::Scene scene = scene::read_scene_text(input, "scene.xml", folder().path());
  check_round_trip(scene.description);
  if (!is_large(scene.description)) {
    simulate_and_differentiate(folder().put("scene.xml", input));
  }
}

}  // namespace hbar::fuzz
