#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace hbar::study {

/// What a job found.
struct JobResult {
  bool converged = false;            ///< whether it may be the best
  bool failed = false;               ///< no numbers: it threw, crashed or took too long (`message`)
  double objective = 0.0;            ///< what is compared; less is better
  std::vector<double> numbers = {};  ///< in the order of JobOptions::columns [columns]
  std::string status = {};           ///< a word or two: "optimal", "iteration limit"
  std::string message = {};          ///< what else is to be told
};

/// A job: a function of its index, from 0, and of random numbers that are its own. It runs in a
/// process of its own, so that nothing that it changes is seen by others: what it finds it returns.
using Job = std::function<JobResult(int index, std::mt19937_64& random)>;

/// Which jobs are run, and how.
struct JobOptions {
  std::string name = {};                  ///< of the study, one line; what tells it from others
  std::uint64_t seed = 0;                 ///< of all random numbers
  int count = 1;                          ///< how many jobs
  std::vector<std::string> columns = {};  ///< names of a result's numbers
  std::filesystem::path table = {};       ///< file of results; empty: none is kept
  int workers = 0;                        ///< processes at a time; 0: one per core
  double time_limit = std::numeric_limits<double>::infinity();  ///< of each job, s
  bool retry_failed = false;                   ///< runs those again that the table holds as failed
  int most = std::numeric_limits<int>::max();  ///< jobs to run now; the others may follow later
  const std::atomic<bool>* stop = nullptr;     ///< ends running jobs soon after it becomes true
  /// Called in this process whenever a job has ended.
  std::function<void(int index, const JobResult& result)> on_job = {};
};

/// What is known of a study's jobs.
struct JobReport {
  std::vector<std::optional<JobResult>> results;  ///< nothing for a job that was not run  [count]
  int ran = 0;                                    ///< ended now
  int kept = 0;                                   ///< found in the table

  [[nodiscard]] bool complete() const;
  /// The converged job of least objective, the first of equals; none if none converged.
  [[nodiscard]] std::optional<int> best() const;
};

/// The random numbers of a job: they depend on the study's seed and the job's index alone.
[[nodiscard]] std::mt19937_64 job_random(std::uint64_t seed, int index);

/// Runs independent jobs on all cores, each in a process of its own (fork), because Ipopt with
/// MUMPS is not reentrant; a job that throws, crashes or takes too long is recorded as failed and
/// stops no other. Results depend neither on the number of workers nor on the order in which jobs
/// end.
///
/// The table is a CSV file with a line per job, in the order of their indices; it is replaced as a
/// whole after each job. Called again with the same table, only the jobs run that are not in it: if
/// this process is killed, no more than the running jobs are lost.
///
/// The calling process must have no other threads, since a child inherits the locks that they hold
/// and not the threads that would release them. What a job writes to standard streams is not
/// collected.
///
/// @param options  see there
/// @param job      called in child processes; a number of its result that is not finite, or another
///   count of numbers than of columns, makes it a failed one
/// @throws InvalidInput if options make no sense or the table is another study's
/// @throws IoError if the table cannot be read or written, or no process be started
JobReport run_jobs(const JobOptions& options, const Job& job);

}  // namespace hbar::study
