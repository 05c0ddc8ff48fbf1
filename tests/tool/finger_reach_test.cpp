// The main example, run as a program.

#include <tinyxml2.h>

#include <algorithm>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

class FingerReachProgram : public ToolTest {
 protected:
  /// Runs it with the results in a folder of its own.
  int run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {HBAR_FINGER_REACH, "--out", results().string()});
    Program program(folder_, arguments);
    const int code = program.wait();
    out_ = program.out();
    err_ = program.err();
    return code;
  }
  [[nodiscard]] std::filesystem::path results() const { return folder_ / "made/results"; }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(read_file(results() / "result.json"));
  }
  [[nodiscard]] long lines_of(const char* file) const {
    const std::string text = read_file(results() / file);
    return std::count(text.begin(), text.end(), '\n');
  }

  /// How many groups of a class its picture has; −1 if it is no SVG.
  [[nodiscard]] int drawn(const std::string& name) const {
    tinyxml2::XMLDocument picture;
    if (picture.LoadFile((results() / "finger.svg").c_str()) != tinyxml2::XML_SUCCESS ||
        picture.RootElement()->Name() != std::string("svg")) {
      return -1;
    }
    int count = 0;
    for (const auto* group = picture.RootElement()->FirstChildElement("g"); group != nullptr;
         group = group->NextSiblingElement("g")) {
      count += group->Attribute("class", name.c_str()) != nullptr ? 1 : 0;
    }
    return count;
  }

  std::string out_;
  std::string err_;
};

TEST_F(FingerReachProgram, ShowsItsProgressAndWritesWhatItFound) {
  ASSERT_EQ(run({"--steps", "60"}), 0) << err_;
  const nlohmann::json found = result();
  EXPECT_EQ(found["status"], "optimal");
  EXPECT_TRUE(found["feasible"]);
  ASSERT_EQ(found["targets"].size(), 4U);
  for (const auto& target : found["targets"]) {
    EXPECT_LT(target["error_per_length"].get<double>(), 0.01);
  }
  EXPECT_LT(found["objective"]["after"].get<double>(), found["objective"]["before"].get<double>());
  const int iterations = found["iterations"].get<int>();
  EXPECT_EQ(lines_of("iterations.csv"), iterations + 2);
  EXPECT_EQ(lines_of("trajectory.csv"), 60 + 2);
  EXPECT_EQ(drawn("target"), 4);
  EXPECT_EQ(drawn("finger"), 5);  // at rest before, at the targets after
  EXPECT_LT(std::filesystem::file_size(results() / "finger.svg"), 60000U);
  // A heading, a line per iterate, plain ones because this is no terminal.
  EXPECT_GT(std::count(out_.begin(), out_.end(), '\n'), iterations + 2);
  EXPECT_EQ(out_.find('\r'), std::string::npos);
  EXPECT_NE(out_.find("constraints: all"), std::string::npos);
  EXPECT_TRUE(err_.empty()) << err_;
}

TEST_F(FingerReachProgram, SolvesAllAtOnceAndResumes) {
  ASSERT_EQ(
      run({"--steps", "60", "--formulation", "all-at-once", "--hessian", "exact", "--sensitivity"}),
      0)
      << err_;
  EXPECT_NE(out_.find("effort by a payload: +"), std::string::npos) << out_;
  const double effort = result()["objective"]["after"].get<double>();
  ASSERT_EQ(run({"--steps", "60", "--formulation", "all-at-once", "--hessian", "exact",
                 "--sensitivity", "--resume", (results() / "solution.csv").string()}),
            0)
      << err_;
  EXPECT_LE(result()["iterations"].get<int>(), 5);
  EXPECT_NEAR(result()["objective"]["after"].get<double>(), effort, 1e-6);
}

TEST_F(FingerReachProgram, WalksAlongTheFrontOfEffortAndMass) {
  ASSERT_EQ(
      run({"--steps", "60", "--formulation", "all-at-once", "--hessian", "exact", "--pareto"}), 0)
      << err_;
  std::istringstream table(read_file(results() / "pareto.csv"));
  std::string line;
  std::getline(table, line);
  double last_effort = 0.0;
  double last_mass = 1.0;
  int points = 0;
  for (; std::getline(table, line); ++points) {
    std::istringstream cells(line);
    double weight = 0.0;
    double effort = 0.0;
    double mass = 0.0;
    char comma = 0;
    cells >> weight >> comma >> effort >> comma >> mass;
    EXPECT_GE(effort, last_effort);
    EXPECT_LE(mass, last_mass);
    last_effort = effort;
    last_mass = mass;
  }
  EXPECT_EQ(points, 9);
}

TEST_F(FingerReachProgram, SaysThatItDidNotConvergeAndWritesItsBest) {
  EXPECT_EQ(run({"--steps", "60", "--max-iterations", "1"}), 5);
  EXPECT_EQ(result()["status"], "iteration limit");
  EXPECT_FALSE(result()["violated"].empty());
  EXPECT_EQ(drawn("target"), 4);
}

TEST_F(FingerReachProgram, KeepsItsBestWhenInterrupted) {
  Program program(folder_, {HBAR_FINGER_REACH, "--out", results().string()});
  program.interrupt();
  EXPECT_EQ(program.wait(), 130);
  EXPECT_EQ(result()["status"], "interrupted");
}

TEST_F(FingerReachProgram, RefusesWrongOptionsScenesAndFolders) {
  EXPECT_EQ(run({"--steps", "61"}), 2);
  EXPECT_EQ(run({"--step", "60"}), 2);
  EXPECT_FALSE(std::filesystem::exists(results()));
  EXPECT_EQ(run({"--scene", (kScenes / "pendulum.xml").string()}), 3);
  EXPECT_EQ(run({"--scene", "/nowhere.xml"}), 6);
  Program no_folder(folder_, {HBAR_FINGER_REACH, "--out", "/proc/results"});
  EXPECT_EQ(no_folder.wait(), 6);
  Program full(folder_, {HBAR_FINGER_REACH, "--out", results().string()}, "/dev/full");
  EXPECT_EQ(full.wait(), 6);
}

}  // namespace
}  // namespace hbar::tool
