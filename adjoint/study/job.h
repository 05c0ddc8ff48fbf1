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

}  // namespace hbar::study
