#include <cmath>
#include <cstdio>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/model/model_builder.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"
#include "hbar/solvers/linear/klu.h"
#ifdef STRANGER_HAS_SUITE
#include "hbar/solvers/linear/solver_suite.h"
#endif
#ifdef STRANGER_HAS_STUDY
#include "hbar/adjoint/study/many_starts.h"
#endif

// What a stranger does first: a pendulum in C++ and one from a scene, a simulation, its gradient.
// Exits with 0 if the gradient is that of central differences, and every solver of the suite, where
// that is there, solves a small system.

namespace {

double final_angle_squared(const hbar::Horizon& horizon, const hbar::Inputs& inputs) {
  const hbar::Rollout rollout = simulate(horizon, inputs);
  const double angle = read_values(horizon, rollout.trajectory()).q.rightCols(1)(0);
  return 0.5 * angle * angle;
}

bool gradient_is_right(const hbar::Model& model) {
  hbar::Horizon horizon(model, hbar::ParameterSet::all(model),
                        {.integrator = "bdf2", .h = 0.01, .steps = 20});
  hbar::Inputs inputs = horizon.nominal_inputs();
  inputs.q0(0) = 0.3;

  const hbar::Objective objective(hbar::squared_final_position());
  const hbar::Rollout rollout = simulate(horizon, inputs);
  const double slope = hbar::gradient(horizon, rollout.trajectory(), objective).q0(0);

  const double step = 1e-5;
  inputs.q0(0) = 0.3 + step;
  const double above = final_angle_squared(horizon, inputs);
  inputs.q0(0) = 0.3 - step;
  const double below = final_angle_squared(horizon, inputs);
  const double difference = (above - below) / (2.0 * step);
  std::printf("stranger: gradient %.12g, central difference %.12g\n", slope, difference);
  return std::abs(slope - difference) < 1e-8;
}

#ifdef STRANGER_HAS_SUITE
bool solvers_solve() {
  hbar::solvers::SparseMatrix A(3, 3);
  for (int i = 0; i < 3; ++i) A.insert(i, i) = 2.0;
  for (int i = 0; i < 2; ++i) A.insert(i + 1, i) = A.insert(i, i + 1) = -1.0;
  A.makeCompressed();
  std::vector<std::string> names = {"auto"};
  for (const auto& entry : hbar::solvers::solver_suite()) {
    if (entry.claims(hbar::solvers::Structure::kDefinite)) names.push_back(entry.name);
  }
  bool ok = names.size() > 3;
  for (const std::string& name : names) {
    const auto solver =
        hbar::solvers::make_solver(name, {.structure = hbar::solvers::Structure::kDefinite}, A);
    solver->analyze(A);
    solver->factorize(A);
    Eigen::VectorXd x = Eigen::VectorXd::Ones(3);
    solver->solve(x, x);
    const double error = (x - Eigen::Vector3d(1.5, 2.0, 1.5)).norm();
    std::printf("stranger: %s is %s, error %.3g\n", name.c_str(), solver->name().c_str(), error);
    ok = ok && error < 1e-14;
  }
  return ok;
}
#else
bool solvers_solve() { return true; }
#endif

#ifdef STRANGER_HAS_STUDY
bool jobs_run() {
  const hbar::study::JobReport report =
      hbar::study::run_jobs({.name = "squares", .count = 5}, [](int index, std::mt19937_64&) {
        return hbar::study::JobResult{.converged = true,
                                      .objective = (index - 3.0) * (index - 3.0)};
      });
  return report.complete() && report.best() == 3;
}
#else
bool jobs_run() { return true; }
#endif

}  // namespace

int main() {
  hbar::ModelBuilder builder("pendulum");
  builder.set_gravity({0.0, 0.0, -9.81});
  builder.add_link(-1, {.name = "hinge", .kind = hbar::RevoluteJoint{{0.0, 1.0, 0.0}}},
                   hbar::solid_body("rod", hbar::Cuboid{{0.1, 0.1, 1.0}}, 800.0,
                                    hbar::RigidTransform<double>{.p = {0.0, 0.0, -0.5}}));

  const auto scene = hbar::scene::read_scene_text(
      R"(<redmax model="pendulum">
  <robot>
    <link name="rod">
      <joint type="revolute" axis="0 1 0"/>
      <body type="cuboid" size="1 1 10" pos="0 0 -5" density="1"/>
    </link>
  </robot>
</redmax>)",
      "pendulum.xml");

  const bool solver_is_there = hbar::solvers::make_klu() != nullptr;
  const bool ok = gradient_is_right(builder.build()) &&
                  gradient_is_right(hbar::scene::build_model(scene)) && solver_is_there &&
                  solvers_solve() && jobs_run();
  return ok ? 0 : 1;
}
