#include "cases.h"

#include "families.h"
#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"

namespace hbar::solver_benchmark {
namespace {

/// Of the controls of a scene, in their own units: small against what motors usually take.
constexpr double kSceneControls = 0.05;

Problem family_problem(const Case& which, const std::atomic<bool>* stop) {
  const Family& family = find_family(which.family);
  const Model model = make_model(family, which.joints);
  SimulationOptions options;
  options.integrator = which.integrator;
  options.h = family.h;
  options.steps = which.steps;
  options.keep_factors = false;
  options.stop = stop;
  Horizon horizon(model, ParameterSet::named(model, {}), options);
  Inputs inputs = horizon.nominal_inputs();
  set_gentle_motion(family, model, inputs);
  return {std::move(horizon), Objective(), std::move(inputs)};
}

Problem scene_problem(const Case& which, const std::atomic<bool>* stop) {
  LoadOptions options;
  options.integrator = which.integrator;
  options.steps = which.steps;
  options.parameters = ParameterChoice::kNone;
  options.stop = stop;
  Problem problem = load_problem(which.scene, options).problem;
  set_swinging_controls(problem.inputs, kSceneControls);
  return problem;
}

bool same_motion(const Case& a, const Case& b) {
  return a.family == b.family && a.joints == b.joints && a.scene == b.scene && a.steps == b.steps &&
         a.integrator == b.integrator;
}

}  // namespace

std::string source_name(const Case& which) {
  return which.family.empty() ? which.scene.stem().string() : concat(which.family, which.joints);
}

std::string name_of(const Case& which) {
  return concat(source_name(which), '_', which.integrator, '_', which.steps, '_',
                name_of(which.system));
}

struct CaseAssembler::Motion {
  Case which;
  Horizon horizon;
  Trajectory trajectory;
};

CaseAssembler::CaseAssembler(const std::atomic<bool>* stop) : stop_(stop) {}
CaseAssembler::~CaseAssembler() = default;

CaseAssembler::Motion& CaseAssembler::motion_of(const Case& which) {
  if (motion_ == nullptr || !same_motion(motion_->which, which)) {
    motion_.reset();  // its memory is free for the next one
    Problem problem =
        which.family.empty() ? scene_problem(which, stop_) : family_problem(which, stop_);
    Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    motion_ =
        std::make_unique<Motion>(Motion{which, std::move(problem.horizon), std::move(trajectory)});
  }
  return *motion_;
}

BenchmarkMatrix CaseAssembler::assemble(const Case& which) {
  Motion& motion = motion_of(which);
  const Horizon& horizon = motion.horizon;
  TrajectorySystem system = assemble_system(which.system, horizon, motion.trajectory);
  BenchmarkMatrix out;
  out.label = {.name = name_of(which),
               .source = source_name(which),
               .family = which.family,
               .system = std::string(name_of(which.system)),
               .integrator = which.integrator,
               .dof = horizon.model().dof(),
               .steps = which.steps,
               .h = horizon.options().h};
  out.A = std::move(system.A);
  out.b = std::move(system.b);
  out.options = std::move(system.options);
  out.name_of_unknown = std::move(system.name_of_unknown);
  return out;
}

}  // namespace hbar::solver_benchmark
