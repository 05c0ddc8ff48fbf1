// The swing-up, run as a program.

#include <algorithm>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

class SwingUpProgram : public ToolTest {
 protected:
  /// Runs a short one with the results in a folder of its own.
  Outcome swing_up(std::vector<std::string> arguments, int steps = 40) {
    arguments.insert(arguments.begin(), {HBAR_SWING_UP, "--out", results().string(), "--steps",
                                         std::to_string(steps)});
    Program program(folder_, arguments);
    const int code = program.wait();
    return {code, program.out(), program.err()};
  }
  [[nodiscard]] std::filesystem::path results() const { return folder_ / "made/results"; }
  [[nodiscard]] long rows_of(const std::string& file) const {
    const std::string text = read_file(results() / file);
    return std::count(text.begin(), text.end(), '\n') - 1;
  }
};

TEST_F(SwingUpProgram, ShowsItsProgressAndWritesWhatItFoundAndResumesThere) {
  const Outcome first = swing_up({});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("all-at-once: 163 variables"), std::string::npos) << first.out;
  EXPECT_NE(first.out.find("ipopt: optimal"), std::string::npos);
  EXPECT_NE(first.out.find("active constraints"), std::string::npos);
  EXPECT_NE(first.out.find("upright and at rest to"), std::string::npos);
  EXPECT_TRUE(first.err.empty()) << first.err;
  EXPECT_EQ(rows_of("trajectory.csv"), 40 + 1);
  EXPECT_EQ(read_file(results() / "solution.csv").rfind("hbar-solution,3\nstatus,optimal,", 0), 0U);
  const long iterations = rows_of("iterations.csv");
  const Outcome second = swing_up({"--resume", (results() / "solution.csv").string()});
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_LE(rows_of("iterations.csv"), std::min(4L, iterations - 1));
}

TEST_F(SwingUpProgram, ChecksDerivativesAndTakesEveryFormulation) {
  for (const char* formulation : {"all-at-once", "multiple-shooting", "shooting"}) {
    const Outcome outcome = swing_up({"--check-derivatives", "--formulation", formulation,
                                      "--segments", "2", "--max-iterations", "1"},
                                     6);
    EXPECT_EQ(outcome.code, 5) << outcome.err;
    EXPECT_NE(outcome.out.find("finds no error in the first and second derivatives"),
              std::string::npos)
        << formulation << '\n'
        << outcome.out;
    EXPECT_NE(outcome.out.find(std::string(formulation) + ": "), std::string::npos);
  }
}

TEST_F(SwingUpProgram, ComparesTheHessians) {
  const Outcome outcome = swing_up({"--compare", "--max-iterations", "3"}, 10);
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  for (const char* kind : {"exact", "gauss-newton", "limited-memory"}) {
    EXPECT_NE(outcome.out.find("\n" + std::string(kind) + " "), std::string::npos) << outcome.out;
    EXPECT_EQ(rows_of(std::string(kind) + "/iterations.csv"), 4);
  }
}

TEST_F(SwingUpProgram, RefusesWrongOptionsScenesAndSolutions) {
  EXPECT_EQ(swing_up({"--formulation", "shoting"}).code, 2);
  EXPECT_EQ(swing_up({"--hessian", "none"}).code, 2);
  EXPECT_EQ(swing_up({"--compare", "--scaling"}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(results()));
  EXPECT_EQ(swing_up({"--scene", (kScenes / "pendulum.xml").string()}).code, 3);
  EXPECT_EQ(swing_up({"--resume", "/nowhere.csv"}).code, 6);
  ASSERT_EQ(swing_up({"--max-iterations", "0"}, 10).code, 5);
  const Outcome other = swing_up({"--resume", (results() / "solution.csv").string()}, 12);
  EXPECT_EQ(other.code, 3);
  EXPECT_NE(other.err.find("another program's solution"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace hbar::tool
