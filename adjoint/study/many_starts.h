#pragma once

#include <optional>

#include "hbar/adjoint/study/job.h"

namespace hbar::study {

/// What is known about a study's jobs.
struct JobReport {
  std::vector<std::optional<JobResult>> results;  ///< nothing for a job that was not run  [count]
  int ran = 0;                                    ///< finished in this run
  int kept = 0;                                   ///< found in the table

  [[nodiscard]] bool complete() const;
  /// The converged job with the lowest objective, the first if several are equal; none if none
  /// converged.
  [[nodiscard]] std::optional<int> best() const;
};

/// The random numbers of a job: they depend only on the study's seed and the job's index.
[[nodiscard]] std::mt19937_64 job_random(std::uint64_t seed, int index);

/// Runs independent jobs on all cores, each in a process of its own (fork), because Ipopt with
/// MUMPS is not reentrant; a job that throws, crashes or takes too long is recorded as failed and
/// stops no other. Results depend neither on the number of workers nor on the order in which jobs
/// end.
///
/// The table is a CSV file with a line per job, in the order of their indices; it is replaced as a
/// whole after each job. A further call with the same table runs only the jobs that are not in it:
/// if this process is killed, only the running jobs are lost.
///
/// The calling process must have no other threads, since a child inherits the locks that they hold
/// and not the threads that would release them. What a job writes to standard streams is not
/// collected.
///
/// @param options  see there
/// @param job      called in child processes; a result with more or fewer numbers than columns, or
///   with one that is not finite, counts as failed
/// @throws InvalidInput if the options are inconsistent or the table belongs to another study
/// @throws IoError before the work if the table cannot be read or written, or no process can be
///   started; and if the table cannot be written in the end, with the file that was written instead
JobReport run_jobs(const JobOptions& options, const Job& job);

}  // namespace hbar::study
