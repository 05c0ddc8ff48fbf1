#include "estimate.h"

#include <cmath>

#include "hbar/adjoint/study/identification.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/nlp/nlopt.h"

namespace hbar::identify {
namespace {

using solvers::HessianKind;

constexpr double kLevel = 0.95;

/// Of a run of equal columns at the beginning: how many; all others must be made of such runs.
int steps_per_block(const Eigen::MatrixXd& u) {
  const auto steps = static_cast<int>(u.cols());
  for (int hold = steps; hold > 1; --hold) {
    bool holds = true;
    for (int k = 0; k < steps && holds; ++k) {
      holds = u.col(k) == u.col(k - k % hold);
    }
    if (holds) {
      return hold;
    }
  }
  return 1;
}

Way way_of(const solvers::IpoptResult& result, std::string name, Eigen::VectorXd unknowns) {
  return {.name = std::move(name),
          .converged = result.converged(),
          .iterations = result.iterations,
          .evaluations = result.evaluations,
          .seconds = result.elapsed,
          .objective = result.objective,
          .unknowns = std::move(unknowns)};
}

/// The numbers of a result: estimates, standard deviations, χ².
study::JobResult job_result(const solvers::IpoptResult& result, const study::Information& known) {
  if (!known.complete()) {
    throw NumericalFailure(known.message);
  }
  study::JobResult out{.converged = result.converged(),
                       .objective = result.objective,
                       .status = std::string(to_string(result.status))};
  for (const Eigen::VectorXd* part : {&known.estimate, &known.standard_deviations}) {
    out.numbers.insert(out.numbers.end(), part->begin(), part->end());
  }
  out.numbers.push_back(known.chi_square);
  return out;
}

}  // namespace

std::unique_ptr<Transcription> misfit_program(const Rig& rig, const Recording& recording,
                                              const TranscriptionOptions& options) {
  HeldControls controls;
  controls.hold = steps_per_block(recording.u);
  const Eigen::Index blocks = (recording.u.cols() + controls.hold - 1) / controls.hold;
  controls.start.resize(recording.u.rows(), blocks);
  for (Eigen::Index b = 0; b < blocks; ++b) {
    controls.start.col(b) = recording.u.col(b * controls.hold);
  }
  controls.lower = controls.start.reshaped();
  controls.upper = controls.lower;
  return transcribe(TrajectoryProblem{.horizon = rig.horizon,
                                      .map = rig.map,
                                      .objective = Objective(study::measured_data_term(
                                          recording.data, recording.sigma)),
                                      .constraints = {},
                                      .controls = std::move(controls),
                                      .q0 = rig.q0,
                                      .qdot0 = {}},
                    options);
}

solvers::IpoptOptions fit_options(const Recording& recording) {
  solvers::IpoptOptions options;
  options.tolerance = 1e-6;
  options.max_iterations = 200;
  options.hessian = HessianKind::kGaussNewton;
  options.objective_scale = static_cast<double>(recording.data.data.size());
  return options;
}

study::Information information_at(const Transcription& program, const Recording& recording,
                                  const Eigen::VectorXd& x) {
  Horizon horizon = program.problem().horizon;
  const Rollout rollout = simulate(horizon, program.inputs(x));
  if (!rollout.converged()) {
    throw solvers::EvaluationError(rollout.report().message);
  }
  study::IdentificationOptions options;
  options.information.level = kLevel;
  return study::fisher_information(horizon, rollout.trajectory(), *program.problem().map,
                                   program.design(x), recording.data, recording.sigma, options);
}

std::vector<Way> every_way(const Rig& rig, const Recording& recording) {
  std::vector<Way> ways;
  for (const auto& [kind, name] : {std::pair{HessianKind::kGaussNewton, "Ipopt, Gauss-Newton"},
                                   std::pair{HessianKind::kExact, "Ipopt, exact"},
                                   std::pair{HessianKind::kLimitedMemory, "Ipopt, L-BFGS"}}) {
    const auto program = misfit_program(rig, recording);
    solvers::IpoptOptions options = fit_options(recording);
    options.hessian = kind;
    const solvers::IpoptResult result = solvers::solve_with_ipopt(*program, options);
    ways.push_back(way_of(result, name, program->design(result.x)));
  }
  const auto program = misfit_program(rig, recording);
  solvers::NloptOptions options;
  options.optimality_tolerance = 1e-5;
  options.objective_scale = static_cast<double>(recording.data.data.size());
  const solvers::NloptResult result = solvers::minimise_with_nlopt(*program, options);
  ways.push_back({.name = "NLopt, L-BFGS",
                  .converged = result.converged(),
                  .evaluations = result.evaluations,
                  .seconds = result.elapsed,
                  .objective = result.objective,
                  .unknowns = program->design(result.x)});
  return ways;
}

study::JobReport repeat_fits(const Rig& rig, const Sigmas& sigmas, study::JobOptions options) {
  options.columns.clear();
  for (const char* what : {"", "sd "}) {
    for (const std::string& name : rig.map->variables().names) {
      options.columns.push_back(what + name);
    }
  }
  options.columns.emplace_back("chi square");
  return study::run_jobs(options, [&](int, std::mt19937_64& random) {
    const Recording recording =
        read_recording(rig, sigmas, recorded_csv(rig, sigmas, random), "recording");
    const auto program = misfit_program(rig, recording);
    const solvers::IpoptResult result = solvers::solve_with_ipopt(*program, fit_options(recording));
    return job_result(result, information_at(*program, recording, result.x));
  });
}

Coverage coverage(const study::JobReport& report, const Eigen::VectorXd& truth) {
  const Eigen::Index count = truth.size();
  const double z = study::normal_quantile(kLevel);
  Coverage out;
  out.bias = Eigen::VectorXd::Zero(count);
  out.scatter = out.bias;
  out.predicted = out.bias;
  out.covered = out.bias;
  for (const std::optional<study::JobResult>& result : report.results) {
    if (!result || !result->converged) {
      continue;
    }
    const Eigen::Map<const Eigen::VectorXd> estimate(result->numbers.data(), count);
    const Eigen::Map<const Eigen::VectorXd> deviation(result->numbers.data() + count, count);
    const Eigen::VectorXd error = estimate - truth;
    out.bias += error;
    out.scatter += error.cwiseAbs2();
    out.predicted += deviation;
    out.covered.array() += (error.array().abs() <= z * deviation.array()).cast<double>();
    out.chi_square += result->numbers.back();
    ++out.fits;
  }
  if (out.fits < 2) {
    throw InvalidInput(concat("identify: ", out.fits, " of ", report.results.size(),
                              " fits converged; there must be two"));
  }
  const auto fits = static_cast<double>(out.fits);
  out.bias /= fits;
  out.scatter =
      ((out.scatter - fits * out.bias.cwiseAbs2()) / (fits - 1.0)).cwiseMax(0.0).cwiseSqrt();
  out.predicted /= fits;
  out.covered /= fits;
  out.chi_square /= fits;
  return out;
}

}  // namespace hbar::identify
