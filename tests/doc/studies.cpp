// The snippets of doc/studies.md, run on the arm, the finger and the pendulum of examples/scenes.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "hbar/hbar.h"
#include "hbar/ipopt.h"
#include "hbar/study.h"
#include "tests/doc/example_model.h"
#include "tests/support/temporary_folder.h"

namespace hbar {
namespace {

/// 0.4 s of a scene, with controls held for 80 ms; what is wanted is added by the tests.
TrajectoryProblem short_problem(const std::string& scene) {
  const Model model = testing::example_model(scene);
  TrajectoryProblem problem{
      .horizon = Horizon(model, {}, {.integrator = "bdf2", .h = 0.02, .steps = 20}),
      .map = parameter_map({}),
      .objective = Objective(effort())};
  problem.controls.hold = 4;
  problem.controls.lower = Eigen::VectorXd::Constant(model.control_count(), -1.0);
  problem.controls.upper = Eigen::VectorXd::Constant(model.control_count(), 1.0);
  return problem;
}

/// The arm with its hand at a point in the end.
std::unique_ptr<Transcription> make_program() {
  TrajectoryProblem problem = short_problem("arm.xml");
  problem.constraints = {variable_at_step(problem.horizon.model(), "hand", 20, {0.5, 0.12, 0.05})};
  return transcribe(problem);
}

/// Any controls within their bounds.
solvers::PrimalDualPoint random_start(const solvers::Nlp& program, std::mt19937_64& random) {
  const solvers::NlpVariables& variables = program.variables();
  solvers::PrimalDualPoint start{.x = variables.start};
  for (Eigen::Index i = 0; i < start.x.size(); ++i) {
    const double share = static_cast<double>(random() >> 11U) * 0x1p-53;
    start.x[i] = variables.lower[i] + share * (variables.upper[i] - variables.lower[i]);
  }
  return start;
}

solvers::IpoptResult solve_from_file(Transcription& program, const std::filesystem::path& file) {
  solvers::IpoptOptions options;
  if (std::filesystem::exists(file)) {
    options.warm_start = study::load_solution(file, program);
  }
  const auto result = study::solve_and_save(program, options, file, {{"scene", "arm.xml"}});

  return result;
}

TEST(StudiesPage, GoesOnFromAFile) {
  const scene::TemporaryFolder folder;
  const auto program = make_program();
  const auto first = solve_from_file(*program, folder / "arm.sol");
  ASSERT_TRUE(first.converged()) << first.message;
  const auto second = solve_from_file(*program, folder / "arm.sol");
  EXPECT_TRUE(second.converged()) << second.message;
  EXPECT_LT(second.iterations, first.iterations);
  EXPECT_EQ(study::read_solution(folder / "arm.sol").about.at("scene"), "arm.xml");
}

TEST(StudiesPage, StartsManyTimes) {
  const scene::TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path();
  const std::atomic<bool> interrupted = false;

  const study::JobReport report = study::run_jobs(
      {.name = "arm, random starts",
       .seed = 1,
       .count = 8,
       .columns = {"iterations", "violation"},
       .table = folder / "starts.csv",
       .time_limit = 600.0,
       .stop = &interrupted},
      [&](int index, std::mt19937_64& random) {
        const auto program = make_program();  // of this job alone
        solvers::IpoptOptions options;
        options.warm_start = random_start(*program, random);
        const auto file = folder / ("start" + std::to_string(index) + ".sol");
        const auto result = study::solve_and_save(*program, options, file);
        return study::JobResult{
            .converged = result.converged(),
            .objective = result.objective,
            .numbers = {static_cast<double>(result.iterations), result.violation.amount},
            .status = std::string(to_string(result.status))};
      });
  if (const std::optional<int> best = report.best()) {
    std::cout << "the best is start" << *best << ".sol\n";
  }

  EXPECT_TRUE(report.complete());
  ASSERT_TRUE(report.best());
  const auto best = static_cast<std::size_t>(*report.best());
  EXPECT_TRUE(std::filesystem::exists(folder / ("start" + std::to_string(best) + ".sol")));
  for (const auto& result : report.results) {
    EXPECT_FALSE(result->failed) << result->message;
    EXPECT_GE(result->objective, report.results[best]->objective - 1e-12);
  }
}

TEST(StudiesPage, WalksAlongAFront) {
  TrajectoryProblem problem = short_problem("finger.xml");
  const Eigen::Vector3d target(0.27, 0.05, -0.05);

  const Objective cost(effort());
  const Objective miss(variable_tracking(target));
  const auto front = study::pareto_sweep(
      study::equal_weights(11), [&](double weight, const solvers::PrimalDualPoint* neighbour) {
        problem.objective = Objective(effort(weight)).add(variable_tracking(target, 1.0 - weight));
        const auto program = transcribe(problem);
        solvers::IpoptOptions options;
        options.hessian = solvers::HessianKind::kGaussNewton;
        if (neighbour != nullptr) {
          options.warm_start = *neighbour;
        }
        const auto result = solvers::solve_with_ipopt(*program, options);
        const TrajectoryValues& motion = program->trajectory_values(result.x);
        return study::WeightedOptimum{.converged = result.converged(),
                                      .f1 = cost.value(motion),
                                      .f2 = miss.value(motion),
                                      .point = result.point(),
                                      .message = result.message};
      });

  ASSERT_EQ(front.size(), 11U);
  for (std::size_t i = 0; i < front.size(); ++i) {
    EXPECT_TRUE(front[i].optimum.converged) << front[i].optimum.message;
    if (i > 0) {  // more effort, less of a miss
      EXPECT_LE(front[i - 1].optimum.f1, front[i].optimum.f1);
      EXPECT_GE(front[i - 1].optimum.f2, front[i].optimum.f2 - 1e-6);
    }
  }
  EXPECT_LT(front.back().optimum.f2, 0.9 * front.front().optimum.f2);
}

/// A recording of the pendulum: every fifth angle and rate, with errors of sizes 1e-3 and 5e-2.
std::string recording(const Horizon& horizon, const Inputs& inputs) {
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  std::ostringstream text;
  text.precision(12);
  text << "time,hinge,rate.hinge\n";
  for (int k = 5; k <= horizon.steps(); k += 5) {
    text << k * horizon.options().h << ',' << trajectory.q_at_step(k)[0] + 1e-3 * std::sin(7.0 * k)
         << ',' << trajectory.qdot_at_step(k)[0] + 5e-2 * std::sin(5.0 * k) << '\n';
  }
  return text.str();
}

TEST(StudiesPage, IdentifiesMassAndDamping) {
  const Model model = testing::example_model("pendulum.xml");
  const auto set = ParameterSet::named(model, {"body.rod.mass", "joint.hinge.damping"});
  const Horizon horizon(model, set, {.integrator = "bdf2", .h = 0.01, .steps = 200});
  const auto map = parameter_map(set);
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0[0] = 1.2;
  inputs.p = Eigen::Vector2d(2.2, 0.15);  // the truth; 2 kg and 0.1 N m s are where the fit begins
  const std::string text = recording(horizon, inputs);

  const auto names = study::trajectory_names(horizon);
  const auto data =
      study::read_trajectory_csv(text, "pendulum.csv", names, {.h = 0.01, .steps = 200});
  const Eigen::VectorXd sigma = data.by_column(Eigen::Vector2d(1e-3, 5e-2));  // of two columns
  const Objective misfit(study::measured_data_term(data, sigma));

  TrajectoryProblem problem{.horizon = horizon, .map = map, .objective = misfit, .q0 = inputs.q0};
  const auto program = transcribe(problem);
  const auto result =
      solvers::solve_with_ipopt(*program, {.hessian = solvers::HessianKind::kGaussNewton});
  ASSERT_TRUE(result.converged()) << result.message;
  const Eigen::VectorXd d = program->design(result.x);
  const Eigen::VectorXd truth = inputs.p;
  inputs.p = map->parameters(d);

  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  const study::Information known =
      study::fisher_information(horizon, trajectory, *map, d, data, sigma);
  if (!known.complete()) {
    throw std::runtime_error(known.message);
  }
  std::cout << "between " << known.lower.transpose() << " and " << known.upper.transpose() << '\n';

  for (int i = 0; i < 2; ++i) {
    EXPECT_LT(known.standard_deviations[i], 0.02 * truth[i]);
    EXPECT_LT(std::abs(d[i] - truth[i]), 4.0 * known.standard_deviations[i]);
  }
}

}  // namespace
}  // namespace hbar
