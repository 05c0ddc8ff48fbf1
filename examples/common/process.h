#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hbar::example {

/// Exit codes of the command and of the examples (doc/command.md).
enum class ExitCode {
  kOk = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadScene = 3,
  kSimulationFailed = 4,
  kNotConverged = 5,
  kInputOutput = 6,
  kOutOfMemory = 7,
  kInterrupted = 130
};

/// What ends a program: a line for standard error (none if empty) and an exit code.
class ProgramError : public std::runtime_error {
 public:
  ProgramError(ExitCode code, const std::string& message)
      : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Called first in main. Keeps closed standard streams from being reused for files; a reader that
/// has gone, or a file that grows too large, is an error of the write and no signal's; SIGINT and
/// SIGTERM end the process with kInterrupted, once nothing else is asked for (StopsGently).
///
/// @param program  its name, which begins its messages; must outlive the process
void prepare_process(const char* program);

/// While one of these lives there is something to save: the first SIGINT, SIGTERM or SIGHUP only
/// sets stop_flag(), the second ends the process.
class StopsGently {
 public:
  StopsGently();
  StopsGently(const StopsGently&) = delete;
  StopsGently& operator=(const StopsGently&) = delete;
  ~StopsGently();
};

/// Set by the first signal that asks the process to end.
[[nodiscard]] const std::atomic<bool>& stop_flag();

/// Writes to standard output. If that fails, the work goes on, since its results may be in files;
/// guarded reports it at the end.
void print(std::string_view text) noexcept;

/// Writes `PROGRAM: <text>` as one line to standard error.
void write_message(std::string_view text) noexcept;

/// Writes a result as scene::write_result_file does. If that fails, a message says where it was
/// saved instead, the work goes on, and guarded returns kInputOutput.
void write_result(const std::filesystem::path& path, std::string_view text);

/// What write_result does when it fails: a message, and kInputOutput in the end.
void report_lost(const std::exception& error) noexcept;

/// Makes a folder for results, and refuses before the work what could not be written into it, or is
/// an input.
///
/// @param files   names within the folder
/// @param inputs  files that the work reads
/// @throws IoError
void expect_results(const std::filesystem::path& folder, const std::vector<std::string>& files,
                    const std::vector<std::filesystem::path>& inputs = {});

/// Returns what `run` returns; an exception becomes one line on standard error and an exit code, as
/// does output that could not be written. Where the stack of the process is small (`ulimit -s`),
/// `run` gets a thread with one of its own.
[[nodiscard]] int guarded(const std::function<ExitCode()>& run);

}  // namespace hbar::example
