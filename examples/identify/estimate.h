#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/study/information.h"
#include "hbar/adjoint/study/many_starts.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "rig.h"

namespace hbar::identify {

/// The fit as a nonlinear program: minimise half of χ² over the unknowns. The controls are
/// variables fixed by their bounds.
///
/// @param options  multiple shooting has the rig's own motion if it has the rig's segments
[[nodiscard]] std::unique_ptr<Transcription> misfit_program(
    const Rig& rig, const Recording& recording, const TranscriptionOptions& options = {});

/// Options for Ipopt: fits to 1e-6, with the number of data as the objective's size.
[[nodiscard]] solvers::IpoptOptions fit_options(const Recording& recording);

/// What the data tell about the unknowns at x: covariance and 95 % intervals from the Fisher
/// information.
///
/// @throws EvaluationError if x cannot be simulated
[[nodiscard]] study::Information information_at(const Transcription& program,
                                                const Recording& recording,
                                                const Eigen::VectorXd& x);

/// How one way of fitting went.
struct Way {
  std::string name;
  bool converged = false;
  int iterations = -1;  ///< −1: the optimiser does not tell
  solvers::EvaluationCounts evaluations;
  double seconds = 0.0;
  double objective = 0.0;
  Eigen::VectorXd unknowns;  ///<                                                          [d]
};

/// Fits with Ipopt and each kind of Hessian, and with NLopt's bound-constrained L-BFGS, all from
/// the same start.
[[nodiscard]] std::vector<Way> every_way(const Rig& rig, const Recording& recording);

/// Fits one recording per job, each with its own errors, and stores the estimate and the standard
/// deviation of each unknown, and χ².
///
/// @param options  its columns are set here
/// @throws as run_jobs
[[nodiscard]] study::JobReport repeat_fits(const Rig& rig, const Sigmas& sigmas,
                                           study::JobOptions options);

/// What many fits tell about the intervals.
struct Coverage {
  int fits = 0;               ///< that converged
  Eigen::VectorXd bias;       ///< mean estimate − truth                                   [d]
  Eigen::VectorXd scatter;    ///< standard deviation of the estimates                     [d]
  Eigen::VectorXd predicted;  ///< mean of the standard deviations that the fits stated    [d]
  Eigen::VectorXd covered;    ///< share of the 95 % intervals that hold the truth         [d]
  double chi_square = 0.0;    ///< mean
};

/// @param truth  of the unknowns                                                          [d]
/// @throws InvalidInput if fewer than two fits converged
[[nodiscard]] Coverage coverage(const study::JobReport& report, const Eigen::VectorXd& truth);

}  // namespace hbar::identify
