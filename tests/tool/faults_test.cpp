// The hbar command while allocations and system calls fail, one after the other. By default a
// sample of the places; HBAR_EVERY_FAULT in the environment asks for all (tests/run.sh --full).

#include <algorithm>
#include <map>
#include <random>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

struct FaultyCommand {
  std::string name;
  std::vector<std::string> arguments;
  bool repeats;  // the same results in every run: those of `solvers` hold times
};

void PrintTo(const FaultyCommand& command, std::ostream* out) { *out << command.name; }

bool every_place() { return std::getenv("HBAR_EVERY_FAULT") != nullptr; }

/// Short runs where every place is tried, and runs that use more of hbar where a sample is.
std::vector<FaultyCommand> faulty_commands() {
  const std::string contact = scene(every_place() ? "pendulum" : "walker");
  const std::string arm = scene(every_place() ? "double_pendulum" : "arm");
  std::vector<FaultyCommand> out = {
      {"info", {"info", contact}, true},
      {"simulate", {"simulate", contact, "--steps", "2", "--out", "r", "--csv", "c"}, true},
      {"gradient",
       {"gradient", arm, "--steps", "1", "--params", "all", "--out", "r", "--csv", "c"},
       true},
      {"check",
       {"check", scene("pendulum"), "--steps", "1", "--q0", "0.5", "--params", "gravity", "--out",
        "r"},
       true}};
#ifdef HBAR_HAVE_SUITE
  out.push_back(
      {"adjoint",
       {"gradient", scene("pendulum"), "--steps", "3", "--linear-solver", "auto", "--out", "r"},
       true});
  // Without MUMPS and Eigen's sparse LU, which do not survive an allocation that fails.
  out.push_back({"solvers",
                 {"solvers", "--family", "chain", "--dof", "1", "--steps", "1", "--system",
                  "adjoint", "--solver", "auto,klu,lapack_band,block_banded", "--repeat", "1",
                  "--rhs", "1", "--json", "r"},
                 false});
#endif
  return out;
}

class Faults : public ToolTest, public ::testing::WithParamInterface<FaultyCommand> {
 protected:
  /// Runs the command in its folder, where old results are.
  Outcome run(const std::string& fault, bool count = false) {
    std::filesystem::remove_all(work());
    std::filesystem::create_directory(work());
    for (const char* file : {"r", "c"}) {
      std::ofstream(work() / file) << "old";
    }
    std::string line = "cd " + work().string() + "; " +
                       (count ? "HBAR_FAULT_COUNT=" + path("counts") + " " : "") +
                       "HBAR_FAULT=" + fault + " LD_PRELOAD=" HBAR_INJECT " exec " HBAR_TOOL;
    for (const std::string& argument : GetParam().arguments) {
      line += " '" + argument + "'";
    }
    Program program(folder_, {"/bin/sh", "-c", line});
    const int code = program.wait();
    return {code, program.out(), program.err()};
  }

  /// Counts what a run without faults does, and keeps its results.
  void SetUp() override {
    ToolTest::SetUp();
    reference_ = run("none:0", true);
    ASSERT_EQ(reference_.code, 0) << reference_.err;
    std::ifstream counts(path("counts"));
    for (std::string name; counts >> name;) {
      counts >> counts_[name];
    }
    results_ = results();
  }

  /// The files in the folder, by their names.
  [[nodiscard]] std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> out;
    for (const auto& entry : std::filesystem::directory_iterator(work())) {
      out[entry.path().filename()] = read_file(entry.path());
    }
    return out;
  }

  /// Places 1 … count, or some of them.
  [[nodiscard]] static std::vector<long> places(long count, long sample) {
    std::vector<long> out;
    if (count <= sample || every_place()) {
      for (long k = 1; k <= count; ++k) {
        out.push_back(k);
      }
      return out;
    }
    std::mt19937 random(static_cast<unsigned>(count));
    for (long i = 0; i < sample; ++i) {  // one in each of as many equal parts
      const long begin = count * i / sample;
      const long end = count * (i + 1) / sample;
      out.push_back(1 + begin + static_cast<long>(random()) % std::max(1L, end - begin));
    }
    return out;
  }

  /// Nothing is half written: each result is the old one or the new one, and no other file is there
  /// but a rescued one, which is whole.
  void expect_whole_results(const std::string& fault) const {
    for (const auto& [name, text] : results()) {
      const std::string plain = name.substr(0, name.find(".rescued"));
      const auto expected = results_.find(plain);
      ASSERT_NE(expected, results_.end()) << fault << " left " << name;
      if (GetParam().repeats) {
        EXPECT_TRUE(text == "old" || text == expected->second) << fault << ": " << name;
      } else {
        EXPECT_TRUE(text == "old" || nlohmann::json::accept(text)) << fault << ": " << name;
      }
    }
  }

  [[nodiscard]] std::filesystem::path work() const { return folder_ / "work"; }

  Outcome reference_;
  std::map<std::string, long> counts_;
  std::map<std::string, std::string> results_;
};

TEST_P(Faults, MemoryThatFailsAtAnyPlaceEndsWithSeven) {
  for (const char* kind : {"malloc:", "malloc+:"}) {
    for (const long place : places(counts_.at("malloc"), 12)) {
      const std::string fault = kind + std::to_string(place);
      const Outcome outcome = run(fault);
      if (outcome.code == 0) {  // somebody went on without: with the same result
        EXPECT_TRUE(!GetParam().repeats || outcome.out == reference_.out) << fault;
        EXPECT_TRUE(!GetParam().repeats || results() == results_) << fault;
      } else {
        EXPECT_EQ(outcome.code, 7) << fault << ": " << outcome.err;
        EXPECT_NE(outcome.err.find("out of memory"), std::string::npos) << fault << outcome.err;
      }
      expect_whole_results(fault);
    }
  }
}

TEST_P(Faults, AFileThatFailsAtAnyPlaceEndsWithSix) {
  for (const char* kind : {"write", "fsync", "rename", "fchmod", "mkstemp", "close"}) {
    for (const long place : places(counts_.at(kind), 30)) {
      const std::string fault = kind + (":" + std::to_string(place));
      const Outcome outcome = run(fault);
      if (outcome.code == 0) {  // a file that was read, or a folder: nothing is lost
        EXPECT_TRUE(!GetParam().repeats || results() == results_) << fault;
      } else {
        EXPECT_EQ(outcome.code, 6) << fault << ": " << outcome.err;
        EXPECT_EQ(outcome.err.find("hbar: "), 0U) << fault << outcome.err;
      }
      expect_whole_results(fault);
    }
  }
}

TEST_P(Faults, WritesThatAreCutShortOrInterruptedGoOn) {
  const Outcome outcome = run("short:1");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(!GetParam().repeats || results() == results_);
  expect_whole_results("short");
}

INSTANTIATE_TEST_SUITE_P(EveryCommand, Faults, ::testing::ValuesIn(faulty_commands()),
                         [](const auto& which) { return which.param.name; });

}  // namespace
}  // namespace hbar::tool
