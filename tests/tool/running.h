#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace hbar::tool {

const std::filesystem::path kSource = HBAR_SOURCE_DIR;
const std::filesystem::path kScenes = kSource / "examples/scenes";

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A program that was started; its standard streams go to files in a folder.
class Program {
 public:
  /// @param memory  limit of its address space in bytes; 0: none
  Program(const std::filesystem::path& folder, std::vector<std::string> words,
          const std::string& out = "", rlim_t memory = 0)
      : out_(out.empty() ? (folder / "stdout").string() : out), err_(folder / "stderr") {
    std::vector<char*> argv;
    for (std::string& word : words) {
      argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
      ::signal(SIGHUP, SIG_DFL);  // the tests may have been started by nohup, which ignores it
      redirect(out_, STDOUT_FILENO);
      redirect(err_, STDERR_FILENO);
      if (memory > 0) {
        const rlimit limit = {memory, memory};
        ::setrlimit(RLIMIT_AS, &limit);
      }
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Waits until the program has something to save, then sends a signal. The command and the
  /// examples catch SIGHUP from then on.
  void interrupt(int signal = SIGINT) const {
    wait_until_caught(SIGHUP);
    ::kill(process_, signal);
  }

  /// Waits until the program catches SIGINT, which it does from the beginning, then sends a signal.
  void interrupt_early(int signal = SIGINT) const {
    wait_until_caught(SIGINT);
    ::kill(process_, signal);
  }

  /// Sends a signal, whatever the program does.
  void kill(int signal) const { ::kill(process_, signal); }

  /// Waits for its end. Exit status, or 1000 + the signal that ended it.
  int wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }

  [[nodiscard]] std::string out() const { return read_file(out_); }
  [[nodiscard]] std::string err() const { return read_file(err_); }

 private:
  void wait_until_caught(int signal) const {
    const std::string file = "/proc/" + std::to_string(process_) + "/status";
    for (int tries = 0; tries < 6000; ++tries) {
      const std::string status = read_file(file);
      const std::size_t place = status.find("SigCgt:");
      if (place != std::string::npos &&
          (std::stoull(status.substr(place + 7), nullptr, 16) >> (signal - 1)) % 2 == 1) {
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }

  static void redirect(const std::string& file, int descriptor) {
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(opened, descriptor);
    ::close(opened);
  }

  std::string out_;
  std::string err_;
  pid_t process_ = -1;
};

/// What a run of the command gave.
struct Outcome {
  int code = 0;
  std::string out;
  std::string err;
};

/// A test with a folder of its own that runs the hbar command.
class ToolTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "hbar_tool.XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] static std::vector<std::string> words(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), HBAR_TOOL);
    return arguments;
  }

  [[nodiscard]] Outcome hbar(const std::vector<std::string>& arguments,
                             const std::string& out = "") const {
    Program program(folder_, words(arguments), out);
    const int code = program.wait();
    return {code, out.empty() ? program.out() : "", program.err()};
  }

  /// The exit code of the command with a stack of 64 KiB; its errors go to the file err.
  [[nodiscard]] int with_small_stack(const std::string& arguments) const {
    const std::string line = std::string("ulimit -s 64; exec ") + HBAR_TOOL + ' ' + arguments +
                             " >/dev/null 2>" + path("err");
    return WEXITSTATUS(std::system(line.c_str()));
  }

  /// A file in the test's folder.
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return path(name);
  }

  [[nodiscard]] nlohmann::json result(const std::string& name) const {
    return nlohmann::json::parse(read_file(folder_ / name));
  }

  std::filesystem::path folder_;
};

/// A scene of the examples.
inline std::string scene(const std::string& name) { return kScenes / (name + ".xml"); }

}  // namespace hbar::tool
