#include "gnuplot.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "hbar/core/base/error.h"
#include "hbar/core/files/text_file.h"

namespace hbar::solver_benchmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMissing =
    "gnuplot, which draws the plots, was not found (Debian: apt-get install gnuplot-nox)";

/// Empty if there is none.
fs::path find_gnuplot() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / "gnuplot";
    if (!folder.empty() && ::access(file.c_str(), X_OK) == 0) {
      return fs::absolute(file);
    }
  }
  return {};
}

/// What the child does: it only makes system calls, for a process with threads forked it.
[[noreturn]] void become(const char* program, const char* folder, const char* script,
                         const char* log) {
  if (::chdir(folder) != 0) {
    ::_exit(126);
  }
  const int nothing = ::open("/dev/null", O_RDONLY);
  const int output = ::open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (nothing < 0 || output < 0) {
    ::_exit(126);
  }
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execl(program, "gnuplot", script, static_cast<char*>(nullptr));
  ::_exit(127);
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      throw IoError(concat("gnuplot: ", std::generic_category().message(errno)));
    }
  }
  return status;
}

}  // namespace

bool has_gnuplot() { return !find_gnuplot().empty(); }

void run_gnuplot(const fs::path& folder, const std::string& script) {
  const std::string program = find_gnuplot().string();
  if (program.empty()) {
    throw IoError(kMissing);
  }
  const std::string place = folder.string();
  const std::string log = "gnuplot.log";
  const pid_t child = ::fork();
  if (child < 0) {
    throw IoError(concat("gnuplot: ", std::generic_category().message(errno)));
  }
  if (child == 0) {
    become(program.c_str(), place.c_str(), script.c_str(), log.c_str());
  }
  const int status = wait_for(child);
  std::error_code code;
  const fs::path said = folder / log;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const std::string text = fs::exists(said, code) ? scene::read_text_file(said) : "";
    throw IoError(concat((folder / script).string(), ": gnuplot failed: ",
                         text.empty() ? "it said nothing" : text.substr(0, 500)));
  }
  fs::remove(said, code);
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    out += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  }
  return out + '\'';
}

std::string file_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) {
        const bool plain = ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') ||
                           ('0' <= c && c <= '9') || c == '_' || c == '-';
        return !plain;
      },
      '-');
  return text;
}

}  // namespace hbar::solver_benchmark
