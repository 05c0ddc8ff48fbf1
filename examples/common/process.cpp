#include "process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>

#include "hbar/core/base/error.h"

namespace hbar::example {
namespace {

std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

extern "C" void handle_interrupt(int) {
  if (stop.exchange(true)) {
    ::_exit(static_cast<int>(ExitCode::kInterrupted));
  }
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

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw IoError("standard output: cannot be written");
  }
}

int guarded(std::string_view program, const std::function<ExitCode()>& run) {
  const auto say = [program](const std::exception& error, ExitCode code) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return static_cast<int>(code);
  };
  try {
    return static_cast<int>(run());
  } catch (const IoError& error) {
    return say(error, ExitCode::kInputOutput);
  } catch (const InvalidInput& error) {
    return say(error, ExitCode::kBadScene);
  } catch (const std::exception& error) {
    return say(error, stop ? ExitCode::kInterrupted : ExitCode::kSimulationFailed);
  }
}

}  // namespace hbar::example
