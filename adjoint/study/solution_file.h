#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "hbar/solvers/nlp/ipopt.h"
#include "hbar/solvers/nlp/primal_dual_point.h"

namespace hbar::study {

/// What is stored of a solution of a nonlinear program.
struct Solution {
  solvers::PrimalDualPoint point;             ///< in the program's units
  std::vector<std::string> variable_names;    ///<                                          [n]
  std::vector<std::string> constraint_names;  ///<                                          [m]
  double objective = 0.0;                     ///< f(x)
  std::string status;                         ///< how it was reached: "optimal", …
  std::map<std::string, std::string> about;   ///< further information for the reader
};

/// The result of an optimisation, with the names of its program.
///
/// @param about  further entries for the file: the scene, the date, the author
[[nodiscard]] Solution solution_of(const solvers::Nlp& nlp, const solvers::IpoptResult& result,
                                   std::map<std::string, std::string> about = {});

/// Writes a solution as text that a person or a spreadsheet can read; atomically. Numbers are read
/// back exactly, and each line ends with a checksum: to change a number by hand, empty that cell.
///
/// @throws InvalidInput if sizes disagree or a number is not finite
/// @throws IoError if the file cannot be written
void save_solution(const std::filesystem::path& path, const Solution& solution);

/// Reads what save_solution wrote.
///
/// @throws InvalidInput that begins `file:line:` if it is not such a file, or names what is damaged
/// @throws IoError if the file cannot be read
[[nodiscard]] Solution read_solution(const std::filesystem::path& path);

/// Reads the point of a solution of this program: what IpoptOptions::warm_start takes.
///
/// @param nlp  its variables and constraints must have the file's names, in the same order
/// @throws InvalidInput that begins `file:line:` and says what differs if the file belongs to
///   another program or is not a solution
/// @throws IoError if the file cannot be read
[[nodiscard]] solvers::PrimalDualPoint load_solution(const std::filesystem::path& path,
                                                     const solvers::Nlp& nlp);

/// Options whose on_checkpoint saves the result of a program, after the caller's own if there is
/// one. A checkpoint that cannot be written is left out: the next one, or the end, may succeed.
///
/// @param nlp      must outlive the optimisation
/// @param options  checkpoint_every is how often
/// @param path     the file
[[nodiscard]] solvers::IpoptOptions saving_checkpoints(
    const solvers::Nlp& nlp, solvers::IpoptOptions options, const std::filesystem::path& path,
    const std::map<std::string, std::string>& about = {});

/// Saves what an optimisation reached, whether it converged, ran out of iterations or was
/// interrupted: the best point, with the multipliers of the last iterate. Multipliers that are not
/// finite are saved as 0; a result without a finite point is not saved.
///
/// @throws InvalidInput as save_solution
/// @throws IoError as scene::write_result_file: the message names the file that was written instead
void save_result(const solvers::Nlp& nlp, const solvers::IpoptResult& result,
                 const std::filesystem::path& path, std::map<std::string, std::string> about = {});

/// Solves with Ipopt and saves the result (save_result). The best point so far is saved every
/// IpoptOptions::checkpoint_every seconds on the way, each time atomically: a process that is
/// killed at any moment loses no more than that, and load_solution reads what it left.
///
/// @throws IoError before the work if the file could not be written, and as save_result after it
/// @throws what solve_with_ipopt throws; then the last checkpoint stays
[[nodiscard]] solvers::IpoptResult solve_and_save(solvers::Nlp& nlp,
                                                  const solvers::IpoptOptions& options,
                                                  const std::filesystem::path& path,
                                                  std::map<std::string, std::string> about = {});

}  // namespace hbar::study
