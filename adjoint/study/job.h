#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace hbar::study {

/// What a job found.
struct JobResult {
  bool converged = false;            ///< whether it may count as the best
  bool failed = false;               ///< no numbers: it threw, crashed or took too long (`message`)
  double objective = 0.0;            ///< for comparison; smaller is better
  std::vector<double> numbers = {};  ///< in the order of JobOptions::columns [columns]
  std::string status = {};           ///< a word or two: "optimal", "iteration limit"
  std::string message = {};          ///< further information
};

/// A job: a function of its index, from 0, and of its own random numbers. It runs in its own
/// process, so that nothing it changes is visible to others; it reports only through its result.
using Job = std::function<JobResult(int index, std::mt19937_64& random)>;

/// Which jobs to run, and how.
struct JobOptions {
  std::string name = {};                  ///< of the study, one line; distinguishes it from others
  std::uint64_t seed = 0;                 ///< of all random numbers
  int count = 1;                          ///< how many jobs
  std::vector<std::string> columns = {};  ///< names of a result's numbers
  std::filesystem::path table = {};       ///< file of results; empty: none
  int workers = 0;                        ///< processes at a time; 0: one per core
  double time_limit = std::numeric_limits<double>::infinity();  ///< of each job, s
  bool retry_failed = false;                   ///< repeats those that the table lists as failed
  int most = std::numeric_limits<int>::max();  ///< jobs to run now, at most; others may follow
  const std::atomic<bool>* stop = nullptr;     ///< ends running jobs soon after it becomes true
  /// Called in this process each time a job has ended.
  std::function<void(int index, const JobResult& result)> on_job = {};
};

}  // namespace hbar::study
