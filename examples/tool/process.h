#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "examples/common/process.h"

namespace hbar::tool {

/// Exit codes of the command (doc/command.md).
enum class ExitCode {
  kOk = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadScene = 3,
  kSimulationFailed = 4,
  kInputOutput = 6,
  kOutOfMemory = 7,
  kInterrupted = 130
};

/// What ends the command: a line for stderr (none if empty) and an exit code.
class ToolError : public std::runtime_error {
 public:
  ToolError(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

using example::prepare_process;
using example::stop_flag;

/// Writes to standard output.
/// @throws ToolError (kInputOutput) if that fails, without a message if the reader has gone
void write_stdout(std::string_view text);

/// Writes `hbar: <text>` as one line to standard error.
void write_message(std::string_view text) noexcept;

}  // namespace hbar::tool
