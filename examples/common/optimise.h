#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "examples/common/process.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/solvers/nlp/ipopt.h"

namespace CLI {
class App;
}

namespace hbar::example {

/// The command-line options that every optimisation example has.
struct OptimiseArguments {
  std::filesystem::path out;  ///< folder for the results; it must exist when optimise is called
  std::string formulation = "all-at-once";
  std::string hessian = "exact";  ///< or "gauss-newton", "limited-memory"
  std::filesystem::path resume;   ///< a solution file to start from; empty: none
  int max_iterations = 500;
  int segments = 8;  ///< of multiple shooting
  bool check_derivatives = false;
  double save_every = 10.0;  ///< s; how often solution.csv is written on the way
};

/// --out, --formulation, --hessian, --resume, --max-iterations, --segments, --check-derivatives,
/// --save-every, with the values of `arguments` as defaults.
void add_options(CLI::App& app, OptimiseArguments& arguments);

/// --save-every.
void add_save_option(CLI::App& app, double& save_every);

/// "exact", "gauss-newton", "limited-memory".
[[nodiscard]] std::string_view name_of(solvers::HessianKind kind);
/// @throws InvalidInput listing the known kinds
[[nodiscard]] solvers::HessianKind find_hessian(std::string_view name);

/// The requested formulation and segments.
/// @throws InvalidInput listing the known formulations
[[nodiscard]] TranscriptionOptions transcription_options(const OptimiseArguments& arguments);

/// Solves with Ipopt and keeps the result in a file, on the way and at the end. What cannot be
/// written is reported as by write_result, and the result is returned all the same.
[[nodiscard]] solvers::IpoptResult solve_and_keep(solvers::Nlp& program,
                                                  const solvers::IpoptOptions& options,
                                                  const std::filesystem::path& solution,
                                                  const std::map<std::string, std::string>& about);

/// The result of optimise.
struct Optimised {
  solvers::IpoptResult result;
  std::vector<solvers::IterationInfo> iterations;
  TranscriptionTimes times;  ///< of this optimisation alone
  ExitCode code = ExitCode::kNotConverged;
};

/// Solves with Ipopt, shows each iterate, saves the result and describes it in words.
///
/// The first SIGINT or SIGTERM stops it with its best point. Into the folder arguments.out it
/// writes solution.csv (which --resume takes; on the way, too), iterations.csv and trajectory.csv,
/// converged or not.
///
/// @param program    also supplies the start, unless there is a solution to resume
/// @param arguments  see there
/// @param options    of Ipopt; hessian, max_iterations, stop and on_iteration are set here, and
///                   warm_start if there is a solution to resume
/// @throws InvalidInput if the solution to resume belongs to another program, or a name is unknown
/// @throws NumericalFailure if arguments.check_derivatives and a derivative is wrong
/// @throws IoError before the work if a file could not be written; see write_result for after it
[[nodiscard]] Optimised optimise(Transcription& program, const OptimiseArguments& arguments,
                                 solvers::IpoptOptions options = {});

/// "time: 1.20 s: residuals 0.10 s (31), …": where an optimisation's time went, one line.
[[nodiscard]] std::string time_line(const Optimised& optimised);

}  // namespace hbar::example
