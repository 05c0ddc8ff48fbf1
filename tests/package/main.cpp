#include <cmath>
#include <cstdio>

#include "hbar/hbar.h"
#ifdef STRANGER_HAS_IPOPT
#include "hbar/ipopt.h"
#endif
#ifdef STRANGER_HAS_NLOPT
#include "hbar/nlopt.h"
#endif
#ifdef STRANGER_HAS_STUDY
#include "hbar/study.h"
#endif
#ifdef STRANGER_HAS_SUITE
#include "hbar/suite.h"
#endif
#ifdef STRANGER_HAS_UMFPACK
#include "hbar/umfpack.h"
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
#ifdef STRANGER_HAS_UMFPACK
  const char* const solver = "umfpack";
#else
  const char* const solver = "klu";
#endif
  const double same =
      gradient(horizon, rollout.trajectory(), objective, hbar::solver_factory(solver)).q0(0);

  const double step = 1e-5;
  inputs.q0(0) = 0.3 + step;
  const double above = final_angle_squared(horizon, inputs);
  inputs.q0(0) = 0.3 - step;
  const double below = final_angle_squared(horizon, inputs);
  const double difference = (above - below) / (2.0 * step);
  std::printf("stranger: gradient %.12g, central difference %.12g\n", slope, difference);
  return std::abs(slope - difference) < 1e-8 && std::abs(slope - same) < 1e-12;
}

bool solvers_solve() {
  hbar::solvers::SparseMatrix A(3, 3);
  for (int i = 0; i < 3; ++i) {
    A.insert(i, i) = 2.0;
  }
  for (int i = 0; i < 2; ++i) {
    A.insert(i + 1, i) = A.insert(i, i + 1) = -1.0;
  }
  A.makeCompressed();
  std::vector<std::string> names = {"auto"};
  for (const auto& entry : hbar::solvers::available_solvers()) {
    if (entry.claims(hbar::solvers::Structure::kDefinite)) {
      names.push_back(entry.name);
    }
  }
#ifdef STRANGER_HAS_SUITE
  bool ok = names.size() > 3;
#else
  bool ok = names.size() > 1;
#endif
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

  const bool ok = gradient_is_right(builder.build()) &&
                  gradient_is_right(hbar::scene::build_model(scene)) && solvers_solve() &&
                  jobs_run();
  return ok ? 0 : 1;
}
