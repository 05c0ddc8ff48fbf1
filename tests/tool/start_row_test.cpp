// hbar --time and --from: how long, and from where.

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using StartRow = ToolTest;

std::vector<std::string> simulate(const std::string& name,
                                  const std::vector<std::string>& options) {
  std::vector<std::string> words = {"simulate", scene(name)};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

TEST_F(StartRow, ATimeIsAsManyStepsAsReachIt) {
  const auto steps = [&](const std::string& time, const std::string& dt) {
    const Outcome outcome = hbar(simulate(
        "pendulum", {"--time", time, "--dt", dt, "--integrator", "bdf1", "--out", path("r")}));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("is no multiple") == std::string::npos, time != "1.01")
        << outcome.err;
    return result("r").at("steps").get<int>();
  };
  EXPECT_EQ(steps("1", "0.01"), 100);
  EXPECT_EQ(steps("0.3", "0.1"), 3);  // 0.1 three times is more than 0.3
  EXPECT_EQ(steps("1.01", "0.02"), 51);
  EXPECT_EQ(steps("0.02", "0.02"), 1);
  EXPECT_EQ(hbar(simulate("pendulum", {"--time", "1", "--steps", "2"})).code, 2);
  EXPECT_EQ(hbar(simulate("pendulum", {"--time", "-1"})).code, 2);
  EXPECT_EQ(hbar(simulate("pendulum", {"--time", "1e9", "--dt", "1e-9"})).code, 2);
}

TEST_F(StartRow, ASimulationFromARowIsTheRestOfTheFirst) {
  // BDF1 looks back on the state alone, so that both are the same.
  const std::vector<std::string> whole = {"--steps", "30",       "--integrator", "bdf1",
                                          "--q0",    "0.4 -0.7", "--csv",        path("whole.csv")};
  ASSERT_EQ(hbar(simulate("double_pendulum", whole)).code, 0);
  const auto rows = [&](const std::string& name) {
    std::vector<std::string> lines;
    std::ifstream file(path(name));
    for (std::string line; std::getline(file, line);) {
      lines.push_back(line.substr(line.find(',')));  // without the time
    }
    return lines;
  };
  const std::vector<std::string> expected = rows("whole.csv");
  ASSERT_EQ(expected.size(), 32U);
  for (const std::string row : {":10", ":-21"}) {
    const Outcome outcome =
        hbar(simulate("double_pendulum", {"--steps", "20", "--integrator", "bdf1", "--from",
                                          path("whole.csv") + row, "--csv", path("rest.csv")}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::vector<std::string> rest = rows("rest.csv");
    ASSERT_EQ(rest.size(), 22U);
    EXPECT_TRUE(std::equal(rest.begin() + 1, rest.end(), expected.begin() + 11)) << row;
  }
  const Outcome last = hbar(simulate(
      "double_pendulum", {"--steps", "1", "--from", path("whole.csv"), "--csv", path("rest.csv")}));
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_EQ(rows("rest.csv")[1], expected.back());
}

TEST_F(StartRow, ARowThatIsNoStartIsRefused) {
  const auto refusal = [&](const std::string& from) {
    const Outcome outcome = hbar(simulate("pendulum", {"--steps", "1", "--from", from}));
    EXPECT_TRUE(outcome.code == 3 || outcome.code == 6) << outcome.code;
    return outcome.err;
  };
  const std::string table = write("t.csv", "time,rate.hinge,hinge\n0,1,2\n0.1,3,4x\n");
  EXPECT_NE(refusal(table + ":7").find("there is no row 7; they are 0 to 1, or -2 to -1"),
            std::string::npos);
  EXPECT_NE(refusal(table + ":x").find("is not a whole number"), std::string::npos);
  EXPECT_NE(refusal(path("none.csv") + ":0").find("No such file"), std::string::npos);
  EXPECT_NE(refusal(write("e.csv", "")).find("the table is empty"), std::string::npos);
  EXPECT_NE(refusal(write("h.csv", "time,q.a\n")).find("there is no row below the heading"),
            std::string::npos);
  EXPECT_NE(refusal(write("c.csv", "time,q.a\n0,1\n")).find("there is no column "),
            std::string::npos);
  EXPECT_EQ(hbar(simulate("pendulum", {"--from", table, "--q0", "1"})).code, 2);
}

}  // namespace
}  // namespace hbar::tool
