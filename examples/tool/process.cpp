#include "process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace hbar::tool {
namespace {

std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

extern "C" void handle_interrupt(int) {
  if (stop.exchange(true)) {
    ::_exit(static_cast<int>(ExitCode::kInterrupted));
  }
}

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

void prepare_process() {
  // A file opened later never gets the number of a standard stream. Standard output is taken by a
  // descriptor that cannot be written, so that what is lost is noticed.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) < 0) {
      static_cast<void>(::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY));
    }
  }
  ::signal(SIGPIPE, SIG_IGN);
  struct sigaction action = {};
  action.sa_handler = handle_interrupt;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
}

const std::atomic<bool>& stop_flag() { return stop; }

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
