// Co-design of a four-joint finger: the sizes of its phalanges and the torques of its motors, such
// that the tip visits four targets in 3 s with the least effort.
//
//   cmake --build build/release --target finger_reach
//   build/release/examples/finger_reach/finger_reach
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, trajectory.csv and
// iterations.csv into results/finger_reach. doc/finger_reach.md tells what is solved and found.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "hbar/core/error.h"
#include "hbar/scene/atomic_file.h"
#include "report.h"

namespace hbar::finger_reach {
namespace {

enum class ExitCode {
  kOk = 0,
  kUsage = 2,
  kBadScene = 3,
  kSimulationFailed = 4,
  kNotConverged = 5,
  kInputOutput = 6,
  kInterrupted = 130
};

struct Arguments {
  std::filesystem::path out = "results/finger_reach";
  std::filesystem::path scene = HBAR_SOURCE_DIR "/examples/scenes/finger.xml";
  int max_iterations = 200;
  int steps = 600;
};

std::atomic<bool> stop = false;

extern "C" void handle_interrupt(int) {
  if (stop.exchange(true)) {
    ::_exit(static_cast<int>(ExitCode::kInterrupted));
  }
}

/// Standard streams that are closed cannot be taken for files; the first SIGINT sets `stop`.
void prepare_process() {
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

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw IoError("standard output: cannot be written");
  }
}

/// A line per iterate; on a terminal one line that is overwritten, and kept every tenth time.
class Progress {
 public:
  void show(const solvers::IterationInfo& info) {
    iterations_.push_back(info);
    const std::string line = progress_line(info);
    if (!terminal_) {
      print(line + '\n');
    } else {
      print("\r\033[K" + line + (info.iteration % 10 == 0 ? "\n" : ""));
    }
  }
  void end() const {
    if (terminal_) {
      print("\n");
    }
  }
  [[nodiscard]] const std::vector<solvers::IterationInfo>& iterations() const {
    return iterations_;
  }

 private:
  bool terminal_ = ::isatty(STDOUT_FILENO) == 1;
  std::vector<solvers::IterationInfo> iterations_;
};

/// Makes the folder at once, so that a wrong name is known before the work.
void make_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) {
    throw IoError(concat(folder.string(), ": the folder cannot be made: ", code.message()));
  }
}

ExitCode run(const Arguments& arguments) {
  // 1. The problem.
  make_folder(arguments.out);
  Reach reach = make_reach(arguments.scene, arguments.steps);
  DesignProblem& problem = *reach.problem;
  Outcome outcome;
  outcome.start = problem.variables().start;
  outcome.start_objective = problem.objective(outcome.start);
  print(fmt::format("finger_reach: {} variables, {} constraints, {} steps of {:g} s\n{}\n",
                    outcome.start.size(), problem.constraint_limits().lower.size(), arguments.steps,
                    kDuration / arguments.steps, progress_heading()));

  // 2. Ipopt.
  Progress progress;
  solvers::IpoptOptions options = ipopt_options(arguments.max_iterations);
  options.stop = &stop;
  options.on_iteration = [&](const solvers::IterationInfo& info) {
    progress.show(info);
    return true;
  };
  outcome.result = solvers::solve_with_ipopt(problem, options);
  progress.end();

  // 3. What came out, converged or not.
  outcome.iterations = progress.iterations();
  outcome.times = problem.times();
  outcome.values = problem.trajectory_values(outcome.result.x);
  scene::write_file_atomically(arguments.out / "result.json", result_json(reach, outcome));
  scene::write_file_atomically(arguments.out / "trajectory.csv",
                               trajectory_csv(reach, outcome.values));
  scene::write_file_atomically(arguments.out / "iterations.csv",
                               iterations_csv(outcome.iterations));
  print(summary(reach, outcome));
  print(fmt::format("written:     {}/result.json, trajectory.csv, iterations.csv\n",
                    arguments.out.string()));
  if (outcome.result.status == solvers::IpoptStatus::kInterrupted) {
    return ExitCode::kInterrupted;
  }
  return outcome.result.converged() ? ExitCode::kOk : ExitCode::kNotConverged;
}

ExitCode run_line(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Co-design of a finger that reaches four targets with the least effort.",
               "finger_reach");
  app.add_option("--out", arguments.out, "Folder for the results.")->capture_default_str();
  app.add_option("--scene", arguments.scene, "The finger.");
  app.add_option("--max-iterations", arguments.max_iterations, "Of Ipopt.")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  app.add_option("--steps", arguments.steps, "Of the 3 s, a multiple of 60.")
      ->check(CLI::Range(60, 60000))
      ->check([](const std::string& text) {
        return std::stol(text) % 60 == 0 ? "" : "must be a multiple of 60";
      })
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  return run(arguments);
}

/// What is thrown, as an exit code and a line on standard error.
ExitCode guarded(int argc, char** argv) {
  const auto say = [](const std::exception& error) {
    fmt::print(stderr, "finger_reach: {}\n", error.what());
  };
  try {
    return run_line(argc, argv);
  } catch (const IoError& error) {
    say(error);
    return ExitCode::kInputOutput;
  } catch (const InvalidInput& error) {
    say(error);
    return ExitCode::kBadScene;
  } catch (const std::exception& error) {
    say(error);
    return stop ? ExitCode::kInterrupted : ExitCode::kSimulationFailed;
  }
}

}  // namespace
}  // namespace hbar::finger_reach

int main(int argc, char** argv) {
  hbar::finger_reach::prepare_process();
  return static_cast<int>(hbar::finger_reach::guarded(argc, argv));
}
