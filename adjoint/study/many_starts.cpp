#include "hbar/adjoint/study/many_starts.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <list>
#include <system_error>
#include <thread>

#include "hbar/adjoint/study/job_table.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/result_file.h"
#include "hbar/core/files/text_file.h"

namespace hbar::study {
namespace {

using Clock = std::chrono::steady_clock;

// So that it fits in the table's first line.
constexpr std::size_t kLongestName = 60;

JobResult failed_job(std::string message) {
  return {.failed = true, .numbers = {}, .status = "failed", .message = std::move(message)};
}

/// A job's result, or why it cannot be entered in the table.
JobResult checked_result(JobResult result, const std::vector<std::string>& columns) {
  if (result.failed) {
    return result;
  }
  if (result.numbers.size() != columns.size()) {
    return failed_job(concat("the job returned ", result.numbers.size(), " numbers for ",
                             columns.size(), " columns"));
  }
  if (!std::isfinite(result.objective)) {
    return failed_job("the objective is not finite");
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!std::isfinite(result.numbers[i])) {
      return failed_job(columns[i] + " is not finite");
    }
  }
  return result;
}

JobResult result_of(const Job& job, int index, const JobOptions& options) {
  try {
    std::mt19937_64 random = job_random(options.seed, index);
    return checked_result(job(index, random), options.columns);
  } catch (const std::exception& error) {
    return failed_job(concat("threw: ", error.what()));
  } catch (...) {
    return failed_job("threw what is no std::exception");
  }
}

/// Runs in the child: does its job, writes one line into the pipe, and exits without running any of
/// the parent's cleanup.
[[noreturn]] void work(const Job& job, int index, const JobOptions& options, int pipe,
                       [[maybe_unused]] pid_t parent) {
  // Signals to the whole process group are the parent's to answer: a job that died of one would
  // count as done.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    ::signal(signal, SIG_IGN);
  }
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) {
    ::_exit(1);
  }
#endif
  const std::string line =
      job_line(index, result_of(job, index, options), options.columns.size()) + '\n';
  std::string_view left = line;
  while (!left.empty()) {
    const ssize_t count = ::write(pipe, left.data(), left.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      ::_exit(1);
    }
    left.remove_prefix(static_cast<std::size_t>(count));
  }
  ::_exit(0);
}

/// A process that does one job; killed when this goes out of scope, if it still runs.
class Worker {
 public:
  Worker(const Job& job, int index, const JobOptions& options)
      : index_(index), options_(options), start_(Clock::now()) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
      fail_to_start();
    }
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0) {
      ::close(ends[0]);
      work(job, index, options, ends[1], parent);
    }
    ::close(ends[1]);
    pipe_ = ends[0];
    if (process_ < 0) {
      ::close(pipe_);
      fail_to_start();
    }
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() {
    ::close(pipe_);
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      reap();
    }
  }

  [[nodiscard]] int index() const { return index_; }
  [[nodiscard]] pollfd polled() const { return {.fd = pipe_, .events = POLLIN, .revents = 0}; }
  [[nodiscard]] bool is_late() const {
    return std::chrono::duration<double>(Clock::now() - start_).count() > options_.time_limit;
  }
  /// Reads what the process wrote.
  /// @returns whether it has closed its end
  bool listen() {
    std::array<char, 4096> block{};
    const ssize_t count = ::read(pipe_, block.data(), block.size());
    if (count > 0) {
      text_.append(block.data(), static_cast<std::size_t>(count));
    }
    return count == 0 || (count < 0 && errno != EINTR);
  }
  /// Its result, after it closed its end.
  JobResult result() {
    const int status = reap();
    if (WIFSIGNALED(status)) {
      const int signal = WTERMSIG(status);
      return failed_job(concat("ended by signal ", signal, " (", ::strsignal(signal), ')'));
    }
    const std::vector<scene::CsvRow> rows = scene::parse_csv(text_, options_.name);
    if (rows.size() != 1 || text_.back() != '\n') {
      return failed_job(concat("ended with code ", WEXITSTATUS(status), " and without a result"));
    }
    return read_job(rows[0], options_, options_.name).second;
  }

 private:
  [[noreturn]] static void fail_to_start() {
    throw IoError(
        concat("run_jobs: a process cannot be started: ", std::generic_category().message(errno)));
  }
  int reap() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }

  int index_;
  const JobOptions& options_;
  Clock::time_point start_;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::string text_;
};

/// The running processes and the finished results.
class Crew {
 public:
  Crew(const JobOptions& options, const Job& job, JobReport& report)
      : options_(options), job_(job), report_(report) {}

  void start(int index) { workers_.emplace_back(job_, index, options_); }
  [[nodiscard]] int size() const { return static_cast<int>(workers_.size()); }

  /// Whether the table holds all that is recorded.
  [[nodiscard]] bool written() const { return written_; }

  /// Waits a moment, and records jobs that have ended or exceeded their time limit.
  void attend() {
    constexpr int kMoment = 20;  // ms: how late a limit or the stop flag is noticed
    std::vector<pollfd> polled;
    for (const Worker& worker : workers_) {
      polled.push_back(worker.polled());
    }
    ::poll(polled.data(), static_cast<nfds_t>(polled.size()), kMoment);
    std::size_t i = 0;
    for (auto worker = workers_.begin(); worker != workers_.end(); ++i) {
      if (polled[i].revents != 0 && worker->listen()) {
        record(worker->index(), worker->result());
        worker = workers_.erase(worker);
      } else if (worker->is_late()) {
        record(worker->index(),
               failed_job(concat("exceeded the limit of ", options_.time_limit, " s")));
        worker = workers_.erase(worker);
      } else {
        ++worker;
      }
    }
  }

 private:
  void record(int index, JobResult result) {
    std::optional<JobResult>& slot = report_.results[static_cast<std::size_t>(index)];
    slot = std::move(result);
    ++report_.ran;
    if (!options_.table.empty()) {
      try {
        scene::write_file_atomically(options_.table, job_table(options_, report_.results));
        written_ = true;
      } catch (const IoError&) {  // the next one, or the end of the study, may succeed
        written_ = false;
      }
    }
    if (options_.on_job) {
      options_.on_job(index, *slot);
    }
  }

  const JobOptions& options_;
  const Job& job_;
  JobReport& report_;
  std::list<Worker> workers_;
  bool written_ = true;
};

void check_job_options(const JobOptions& options) {
  if (options.count < 1) {
    throw InvalidInput(concat("run_jobs: ", options.count, " jobs; at least 1 is needed"));
  }
  if (options.name.size() > kLongestName || scene::quotable(options.name) != options.name) {
    throw InvalidInput(concat("run_jobs: the study's name \"", scene::quotable(options.name),
                              "\" must be one line of at most ", kLongestName, " characters"));
  }
  if (options.workers < 0) {
    throw InvalidInput(concat("run_jobs: ", options.workers, " workers; 0 means one per core"));
  }
  if (!(options.time_limit > 0.0)) {
    throw InvalidInput(
        concat("run_jobs: the time limit is ", options.time_limit, " s, but must be positive"));
  }
}

/// The results already in the table.
JobReport earlier_jobs(const JobOptions& options) {
  JobReport report;
  report.results.resize(static_cast<std::size_t>(options.count));
  if (options.table.empty() || !std::filesystem::exists(options.table)) {
    return report;
  }
  report.results =
      read_job_table(scene::read_text_file(options.table), options, options.table.string());
  for (std::optional<JobResult>& result : report.results) {
    if (result && result->failed && options.retry_failed) {
      result.reset();
    }
    report.kept += result.has_value() ? 1 : 0;
  }
  return report;
}

}  // namespace

bool JobReport::complete() const {
  return std::all_of(results.begin(), results.end(),
                     [](const auto& result) { return result.has_value(); });
}

std::optional<int> JobReport::best() const {
  std::optional<int> best;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!results[i] || results[i]->failed || !results[i]->converged) {
      continue;
    }
    if (!best || results[i]->objective < results[static_cast<std::size_t>(*best)]->objective) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

std::mt19937_64 job_random(std::uint64_t seed, int index) {
  std::seed_seq mixed = {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                         static_cast<std::uint32_t>(index)};
  return std::mt19937_64(mixed);
}

JobReport run_jobs(const JobOptions& options, const Job& job) {
  require_given("run_jobs", "job", job);
  check_job_options(options);
  if (!options.table.empty()) {
    scene::expect_result_file(options.table);
  }
  JobReport report = earlier_jobs(options);
  std::vector<int> waiting;
  for (int i = 0; i < options.count; ++i) {
    if (!report.results[static_cast<std::size_t>(i)]) {
      waiting.push_back(i);
    }
  }
  waiting.resize(std::min(waiting.size(), static_cast<std::size_t>(std::max(0, options.most))));
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int workers = options.workers > 0 ? options.workers : cores;

  Crew crew(options, job, report);
  auto next = waiting.begin();
  while (next != waiting.end() || crew.size() > 0) {
    if (options.stop != nullptr && *options.stop) {
      break;
    }
    while (next != waiting.end() && crew.size() < workers) {
      crew.start(*next++);
    }
    crew.attend();
  }
  if (!crew.written()) {
    scene::write_result_file(options.table, job_table(options, report.results));
  }
  return report;
}

}  // namespace hbar::study
