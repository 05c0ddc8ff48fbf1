#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

namespace hbar::example {

/// Exit codes of the optimisation examples.
enum class ExitCode {
  kOk = 0,
  kUsage = 2,
  kBadScene = 3,
  kSimulationFailed = 4,
  kNotConverged = 5,
  kInputOutput = 6,
  kInterrupted = 130
};

/// Keeps closed standard streams from being reused for files; the first SIGINT sets stop_flag(),
/// the second ends the process at once.
void prepare_process();

/// Set by the first SIGINT.
[[nodiscard]] const std::atomic<bool>& stop_flag();

/// Writes to standard output.
/// @throws IoError if that fails
void print(const std::string& text);

/// Returns what `run` returns; an exception becomes one line on standard error that begins with the
/// program's name, and an exit code.
[[nodiscard]] int guarded(std::string_view program, const std::function<ExitCode()>& run);

}  // namespace hbar::example
