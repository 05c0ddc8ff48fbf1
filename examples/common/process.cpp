#include "process.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "hbar/core/base/error.h"
#include "hbar/core/files/result_file.h"
#include "hbar/solvers/linear/linear_solver.h"

namespace hbar::example {
namespace {

const char* name_of_program = nullptr;
std::atomic<bool> stop = false;
std::atomic<int> gentle = 0;  // how many StopsGently there are
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler uses them");
std::atomic<int> print_error = 0;  // the system's code of the first failure
std::atomic<bool> result_failed = false;

extern "C" void handle_stop(int) {
  if (stop.exchange(true) || gentle.load() == 0) {
    ::_exit(static_cast<int>(ExitCode::kInterrupted));
  }
}

/// How a signal was handled before.
struct sigaction handle(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  struct sigaction before = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal, &action, &before);
  return before;
}

constexpr const char* kNoMemory = "out of memory; take fewer steps or parameters";
std::atomic<bool> memory_failed = false;

/// As operator new does without a handler, but remembered.
void note_failed_memory() {
  memory_failed = true;
  throw std::bad_alloc();
}

/// What must not throw and runs out of memory (destructors of nlohmann-json, for one) ends here.
[[noreturn]] void end_without_memory() {
  if (memory_failed) {
    write_message(kNoMemory);
    ::_exit(static_cast<int>(ExitCode::kOutOfMemory));
  }
  std::abort();
}

// Objects that are made before main allocate, too: the libraries' as well as hbar's.
[[gnu::constructor(101)]] void end_well_without_memory() {
  std::set_new_handler(note_failed_memory);
  std::set_terminate(end_without_memory);
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

ExitCode say(const std::exception& error, ExitCode code) noexcept {
  if (*error.what() != '\0') {
    write_message(error.what());
  }
  return code;
}

/// What is thrown, as an exit code and a line on standard error.
ExitCode outcome_of(const std::function<ExitCode()>& run) noexcept {
  try {
    return run();
  } catch (const ProgramError& error) {
    return say(error, error.code());
  } catch (const IoError& error) {
    return say(error, ExitCode::kInputOutput);
  } catch (const Interrupted& error) {
    return say(error, ExitCode::kInterrupted);
  } catch (const InvalidInput& error) {
    return say(error, ExitCode::kBadScene);
  } catch (const solvers::OutOfMemory& error) {
    return say(error, ExitCode::kOutOfMemory);
  } catch (const NumericalFailure& error) {
    return say(error, stop ? ExitCode::kInterrupted : ExitCode::kSimulationFailed);
  } catch (const std::bad_alloc&) {
    write_message(kNoMemory);
    return ExitCode::kOutOfMemory;
  } catch (const std::exception& error) {
    return say(error, stop ? ExitCode::kInterrupted : ExitCode::kSimulationFailed);
  } catch (...) {
    write_message("failed for an unknown reason");
    return ExitCode::kSimulationFailed;
  }
}

/// The outcome, unless a good one was not told.
ExitCode told_outcome(ExitCode code) noexcept {
  const int error = print_error;
  if (error != 0 && error != EPIPE) {  // who closed the pipe needs no message
    std::array<char, 200> reason{};
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), "standard output: cannot be written: %s",
                  ::strerror_r(error, reason.data(), reason.size()));
    write_message(text.data());
  }
  const bool good =
      code == ExitCode::kOk || code == ExitCode::kCheckFailed || code == ExitCode::kNotConverged;
  return good && (error != 0 || result_failed) ? ExitCode::kInputOutput : code;
}

struct Call {
  const std::function<ExitCode()>& run;
  ExitCode code = ExitCode::kOk;
};

/// Runs in a thread whose stack the limit of the process does not bound.
ExitCode outcome_with_stack(const std::function<ExitCode()>& run, std::size_t bytes) {
  Call call{run};
  pthread_attr_t attributes;
  pthread_t thread = {};
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, bytes);
  const auto body = [](void* pointer) -> void* {
    auto& its = *static_cast<Call*>(pointer);
    its.code = outcome_of(its.run);
    return nullptr;
  };
  const int failed = ::pthread_create(&thread, &attributes, body, &call);
  ::pthread_attr_destroy(&attributes);
  if (failed != 0) {
    return outcome_of(run);
  }
  ::pthread_join(thread, nullptr);
  return call.code;
}

bool has_small_stack(std::size_t bytes) {
  rlimit limit = {};
  return ::getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
         limit.rlim_cur < bytes;
}

}  // namespace

void prepare_process(const char* program) {
  name_of_program = program;
  // A file opened later never gets the number of a standard stream. Standard output is taken by a
  // descriptor that cannot be written, so that what is lost is noticed.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) < 0) {
      static_cast<void>(::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY));
    }
  }
  handle(SIGPIPE, SIG_IGN);
  handle(SIGXFSZ, SIG_IGN);
  handle(SIGINT, handle_stop);
  handle(SIGTERM, handle_stop);
}

StopsGently::StopsGently() {
  gentle.fetch_add(1);
  const struct sigaction before = handle(SIGHUP, handle_stop);
  if (before.sa_handler == SIG_IGN) {  // nohup
    handle(SIGHUP, SIG_IGN);
  }
}

StopsGently::~StopsGently() { gentle.fetch_sub(1); }

const std::atomic<bool>& stop_flag() { return stop; }

void print(std::string_view text) noexcept {
  int none = 0;
  if (const int code = write_all(STDOUT_FILENO, text)) {
    print_error.compare_exchange_strong(none, code);
  }
}

void write_message(std::string_view text) noexcept {
  if (name_of_program != nullptr) {
    write_all(STDERR_FILENO, name_of_program);
    write_all(STDERR_FILENO, ": ");
  }
  write_all(STDERR_FILENO, text);
  write_all(STDERR_FILENO, "\n");
}

void write_result(const std::filesystem::path& path, std::string_view text) {
  try {
    scene::write_result_file(path, text);
  } catch (const IoError& error) {
    report_lost(error);
  }
}

void report_lost(const std::exception& error) noexcept {
  write_message(error.what());
  result_failed = true;
}

void expect_results(const std::filesystem::path& folder, const std::vector<std::string>& files,
                    const std::vector<std::filesystem::path>& inputs) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) {
    throw IoError(concat(folder.string(), ": the folder cannot be made: ", code.message()));
  }
  for (const std::string& file : files) {
    scene::expect_result_file(folder / file, inputs);
  }
}

int guarded(const std::function<ExitCode()>& run) {
  constexpr std::size_t kEnough = std::size_t{8} << 20U;
  const ExitCode code =
      has_small_stack(kEnough / 8) ? outcome_with_stack(run, kEnough) : outcome_of(run);
  return static_cast<int>(told_outcome(code));
}

}  // namespace hbar::example
