#pragma once

#include <filesystem>
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

/// What every optimisation example can be asked on its command line.
struct OptimiseArguments {
  std::filesystem::path out;  ///< folder for the results; it must exist when optimise is called
  std::string formulation = "all-at-once";
  std::string hessian = "exact";  ///< or "gauss-newton", "limited-memory"
  std::filesystem::path resume;   ///< a solution file to start from; empty: none
  int max_iterations = 500;
  int segments = 8;  ///< of multiple shooting
  bool check_derivatives = false;
};

/// --out, --formulation, --hessian, --resume, --max-iterations, --segments, --check-derivatives,
/// with what `arguments` holds as defaults.
void add_options(CLI::App& app, OptimiseArguments& arguments);

/// "exact", "gauss-newton", "limited-memory".
[[nodiscard]] std::string_view name_of(solvers::HessianKind kind);
/// @throws InvalidInput naming the kinds there are
[[nodiscard]] solvers::HessianKind find_hessian(std::string_view name);

/// The formulation and segments that were asked for.
/// @throws InvalidInput naming the formulations there are
[[nodiscard]] TranscriptionOptions transcription_options(const OptimiseArguments& arguments);

/// What optimise reached.
struct Optimised {
  solvers::IpoptResult result;
  std::vector<solvers::IterationInfo> iterations;
  TranscriptionTimes times;  ///< of this optimisation alone
  ExitCode code = ExitCode::kNotConverged;
};

/// Solves with Ipopt, shows each iterate, keeps what was reached and says in words what it is like.
///
/// The first SIGINT stops it with its best point. Into the folder arguments.out it writes
/// solution.csv (which --resume takes), iterations.csv and trajectory.csv, converged or not.
///
/// @param program    also says where to begin, unless there is a solution to resume
/// @param arguments  see there
/// @param options    of Ipopt; hessian, max_iterations, stop and on_iteration are set here, and
///                   warm_start if there is a solution to resume
/// @throws InvalidInput if the solution to resume is another program's, or a name is not known
/// @throws NumericalFailure if arguments.check_derivatives and a derivative is wrong
/// @throws IoError if a file or standard output cannot be written
[[nodiscard]] Optimised optimise(Transcription& program, const OptimiseArguments& arguments,
                                 solvers::IpoptOptions options = {});

/// "time: 1.20 s: residuals 0.10 s (31), …": where an optimisation's time went, one line.
[[nodiscard]] std::string time_line(const Optimised& optimised);

}  // namespace hbar::example
