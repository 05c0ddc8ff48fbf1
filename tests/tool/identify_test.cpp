// The identification example, run as a program.

#include <algorithm>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

class IdentifyProgram : public ToolTest {
 protected:
  Outcome identify(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {HBAR_IDENTIFY, "--out", (folder_ / "results").string()});
    Program program(folder_, arguments);
    const int code = program.wait();
    return {code, program.out(), program.err()};
  }
  [[nodiscard]] std::string text_of(const char* file) const {
    return read_file(folder_ / "results" / file);
  }
};

TEST_F(IdentifyProgram, FitsWhatItSimulatedAndWhatItIsGiven) {
  const Outcome simulated = identify({});
  ASSERT_EQ(simulated.code, 0) << simulated.err;
  EXPECT_NE(simulated.out.find("402 data, 5 unknowns"), std::string::npos);
  EXPECT_NE(simulated.out.find("contact.brake.mu"), std::string::npos);
  EXPECT_NE(simulated.out.find("correlation"), std::string::npos);
  for (const char* file : {"solution.csv", "iterations.csv", "trajectory.csv"}) {
    EXPECT_FALSE(text_of(file).empty()) << file;
  }
  const std::string table = text_of("measured.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 202);

  const Outcome given = identify({"--data", write("mine.csv", table)});
  ASSERT_EQ(given.code, 0) << given.err;
  const auto chi_square = [](const Outcome& outcome) {
    return outcome.out.substr(outcome.out.find("chi square"));
  };
  EXPECT_EQ(chi_square(given), chi_square(simulated));
}

TEST_F(IdentifyProgram, RepeatsFitsAndKeepsThem) {
  const Outcome few = identify({"--steps", "100", "--repeat", "3"});
  ASSERT_EQ(few.code, 0) << few.err;
  EXPECT_NE(few.out.find("3 fits"), std::string::npos) << few.out;
  EXPECT_FALSE(text_of("repeat.csv").empty());
}

TEST_F(IdentifyProgram, SaysWhatCannotBeKnown) {
  const Outcome outcome = identify({"--no-sliding", "--steps", "40"});
  EXPECT_NE(outcome.out.find("the data say nothing of contact.brake.mu"), std::string::npos)
      << outcome.out;
}

TEST_F(IdentifyProgram, RefusesWrongOptionsAndTables) {
  EXPECT_EQ(identify({"--repeat", "1"}).code, 2);
  EXPECT_EQ(identify({"--unknown", "body.rod.masss"}).code, 3);
  EXPECT_EQ(identify({"--data", write("bad.csv", "time,rails\n0.01,1\n")}).code, 3);
  EXPECT_EQ(identify({"--data", "/nowhere.csv"}).code, 6);
}

}  // namespace
}  // namespace hbar::tool
