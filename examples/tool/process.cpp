#include "process.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace hbar::tool {
namespace {

/// 0, or the system's error code.
int write_all(int descriptor, std::string_view text) noexcept {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      return errno;
    }
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace

void write_stdout(std::string_view text) {
  const int code = write_all(STDOUT_FILENO, text);
  if (code == EPIPE) {
    throw ToolError(ExitCode::kInputOutput, "");
  }
  if (code != 0) {
    throw ToolError(ExitCode::kInputOutput, fmt::format("standard output: cannot be written: {}",
                                                        std::generic_category().message(code)));
  }
}

void write_message(std::string_view text) noexcept {
  constexpr std::string_view kStart = "hbar: ";
  write_all(STDERR_FILENO, kStart);
  write_all(STDERR_FILENO, text);
  write_all(STDERR_FILENO, "\n");
}

}  // namespace hbar::tool
