#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "hbar/solvers/nlp/ipopt.h"
#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::study {

/// What is kept of a solution of a nonlinear program.
struct Solution {
  solvers::PrimalDualPoint point;             ///< in the program's units
  std::vector<std::string> variable_names;    ///<                                          [n]
  std::vector<std::string> constraint_names;  ///<                                          [m]
  double objective = 0.0;                     ///< f(x)
  std::string status;                         ///< how it was reached: "optimal", …
  std::map<std::string, std::string> about;   ///< what else a reader should know
};

/// What an optimisation reached, with the names of its program.
///
/// @param about  what else the file shall say: the scene, the date, who did it
[[nodiscard]] Solution solution_of(const solvers::Nlp& nlp, const solvers::IpoptResult& result,
                                   std::map<std::string, std::string> about = {});

/// Writes a solution as a text that a person or a spreadsheet can read, whole or not at all.
/// Numbers are read back to the last bit.
///
/// @throws InvalidInput if sizes disagree or a number is not finite
/// @throws IoError if the file cannot be written
void save_solution(const std::filesystem::path& path, const Solution& solution);

/// Reads what save_solution wrote.
///
/// @throws InvalidInput that begins `file:line:` if it is no such file
/// @throws IoError if the file cannot be read
[[nodiscard]] Solution read_solution(const std::filesystem::path& path);

/// Reads the point of a solution of this program: what IpoptOptions::warm_start takes.
///
/// @param nlp  its variables and constraints must have the file's names, in the same order
/// @throws InvalidInput that begins `file:line:` and says what differs if the file is another
///   program's, or no solution
/// @throws IoError if the file cannot be read
[[nodiscard]] solvers::PrimalDualPoint load_solution(const std::filesystem::path& path,
                                                     const solvers::Nlp& nlp);

/// Solves with Ipopt and saves what was reached, whether Ipopt converged, ran out of iterations or
/// was interrupted (IpoptOptions::stop, on_iteration): then it is the best point that was
/// evaluated, with the multipliers of the last iterate. Nothing is saved while Ipopt runs, because
/// it shows its iterates to nobody, nor if it throws, or reaches no finite point. Multipliers that
/// are not finite are saved as 0.
///
/// @throws what solve_with_ipopt and save_solution throw
[[nodiscard]] solvers::IpoptResult solve_and_save(solvers::Nlp& nlp,
                                                  const solvers::IpoptOptions& options,
                                                  const std::filesystem::path& path,
                                                  std::map<std::string, std::string> about = {});

}  // namespace hbar::study
