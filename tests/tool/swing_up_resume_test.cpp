// Programs that are killed while they work, and go on from what they left.

#include <random>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using Clock = std::chrono::steady_clock;

class Resume : public ToolTest {
 protected:
  [[nodiscard]] std::string results() const { return folder_ / "results"; }
  [[nodiscard]] std::string solution() const { return results() + "/solution.csv"; }

  /// A run from the beginning, or from what an earlier one left.
  [[nodiscard]] std::vector<std::string> line(bool resume) const {
    std::vector<std::string> out = {HBAR_SWING_UP, "--out",        results(), "--steps",
                                    "60",          "--save-every", "0"};
    if (resume) {
      out.insert(out.end(), {"--resume", solution()});
    }
    return out;
  }
};

TEST_F(Resume, AProgramThatWasKilledAtAnyMomentGoesOn) {
  const auto start = Clock::now();
  ASSERT_EQ(Program(folder_, line(false)).wait(), 0);
  const double whole = std::chrono::duration<double>(Clock::now() - start).count();
  const std::string optimum = read_file(solution());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int resumed = 0;
  const int moments = std::getenv("HBAR_EVERY_FAULT") != nullptr ? 20 : 6;
  for (int i = 0; i < moments; ++i) {
    std::filesystem::remove_all(results());
    Program killed(folder_, line(false));
    std::this_thread::sleep_for(std::chrono::duration<double>(share(random) * whole));
    killed.kill(SIGKILL);
    killed.wait();
    const bool left = std::filesystem::exists(solution());
    resumed += left ? 1 : 0;
    Program second(folder_, line(left));
    ASSERT_EQ(second.wait(), 0) << second.err() << second.out();
    EXPECT_NE(read_file(solution()).find("status,optimal,"), std::string::npos);
    for (const auto& entry : std::filesystem::directory_iterator(results())) {
      EXPECT_FALSE(entry.path().filename().string().starts_with(".hbar-tmp-")) << entry.path();
    }
  }
  EXPECT_GE(resumed, moments / 4);
}

TEST_F(Resume, SigtermIsAsSigint) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(results());
    std::vector<std::string> words = line(false);
    words[4] = "2000";  // longer than the test waits
    Program program(folder_, words);
    for (int tries = 0; tries < 6000 && !std::filesystem::exists(solution()); ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    program.interrupt(signal);
    EXPECT_EQ(program.wait(), 130) << program.err();
    EXPECT_NE(read_file(solution()).find("status,interrupted,"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(results() + "/trajectory.csv"));
  }
}

TEST_F(Resume, OutputThatNobodyReadsStopsNoSolve) {
  const std::string command = std::string("exec 3>") + path("err") + "; { " + HBAR_SWING_UP +
                              " --steps 40 --out " + results() + " 2>&3; echo $? >" + path("code") +
                              "; } | true";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_file(path("code")), "6\n");
  EXPECT_EQ(read_file(path("err")), "");
  EXPECT_NE(read_file(solution()).find("status,optimal,"), std::string::npos);

  Program full(folder_, line(false), "/dev/full");
  EXPECT_EQ(full.wait(), 6);
  EXPECT_EQ(full.err(), "swing_up: standard output: cannot be written: No space left on device\n");
  EXPECT_NE(read_file(solution()).find("status,optimal,"), std::string::npos);
}

TEST_F(Resume, ResultsThatCannotBeWrittenAreRefusedBeforeTheWork) {
  std::ofstream(results()) << "a file where the folder should be";
  Program program(folder_, line(false));
  EXPECT_EQ(program.wait(), 6);
  EXPECT_EQ(program.err(),
            "swing_up: " + results() + ": the folder cannot be made: Not a directory\n");
  EXPECT_EQ(program.out().find("iter "), std::string::npos) << program.out();
}

}  // namespace
}  // namespace hbar::tool
