// hbar solvers: what it measures, writes and refuses.

#include <algorithm>
#include <set>

#include "hbar/suite.h"
#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using nlohmann::json;

class SolversCommand : public ToolTest {
 protected:
  /// Runs `hbar solvers` with these arguments; the results as JSON.
  [[nodiscard]] json measured(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "solvers");
    arguments.insert(arguments.end(), {"--repeat", "1", "--json", path("r.json")});
    outcome_ = hbar(arguments);
    EXPECT_EQ(outcome_.code, 0) << outcome_.err;
    EXPECT_EQ(outcome_.err, "");
    return outcome_.code == 0 ? result("r.json") : json();
  }

  Outcome outcome_;
};

/// What a solver's backward errors must stay below. The normal equations square the condition, and
/// the refinement that mends it ends where a solver's residual counts as small.
double bound(const std::string& solver) { return solver == "cholmod_normal" ? 1e-12 : 1e-14; }

TEST_F(SolversCommand, EverySolverSolvesTheSystemsItIsMeantFor) {
  const json results =
      measured({"--family", "chain,hand", "--dof", "3", "--steps", "12", "--clock", "cpu"});
  EXPECT_EQ(results.at("clock"), "cpu");
  ASSERT_EQ(results.at("matrices").size(), 8U);
  std::set<std::string> seen;
  for (const json& matrix : results.at("matrices")) {
    EXPECT_EQ(matrix.at("failure"), "");
    EXPECT_GE(matrix.at("condition"), 1.0);
    for (const json& solver : matrix.at("solvers")) {
      SCOPED_TRACE(matrix.at("name").get<std::string>() + ' ' + solver.dump());
      const std::string name = solver.at("solver");
      seen.insert(name);
      if (name == "cholmod_normal" && solver.at("failure") != "") {
        EXPECT_GT(matrix.at("condition"), 1e6);  // of which it takes the square
        continue;
      }
      ASSERT_EQ(solver.at("failure"), "");
      EXPECT_LE(solver.at("backward_error"), bound(name));
      EXPECT_LE(solver.at("transposed_error"), bound(name));
      EXPECT_GT(solver.at("seconds").at("factorise"), 0.0);
      EXPECT_GT(solver.at("seconds").at("solve_many"), 0.0);
      EXPECT_GT(solver.at("factor_entries"), 0.0);
      EXPECT_LT(solver.at("forward_error"), 1e-3);
      if (name == "auto") {
        EXPECT_NE(outcome_.out.find("auto (" + solver.at("chosen").get<std::string>() + ")"),
                  std::string::npos);
      }
    }
  }
  EXPECT_TRUE(seen.contains("auto"));
  for (const solvers::SolverEntry& entry : solvers::available_solvers()) {
    EXPECT_TRUE(seen.contains(entry.name)) << entry.name;
    EXPECT_NE(outcome_.out.find("  " + entry.name), std::string::npos) << entry.name;
  }
  EXPECT_GE(results.at("auto_over_best"), 0.0);
}

TEST_F(SolversCommand, TableJsonAndCsvTellTheSame) {
  const json results =
      measured({scene("arm"), "--family", "tree", "--dof", "4", "--steps", "8", "--system",
                "adjoint,kkt", "--ordering", "default,amd", "--csv", path("r.csv")});
  std::istringstream csv(read_file(path("r.csv")));
  std::string line;
  ASSERT_TRUE(std::getline(csv, line));
  EXPECT_TRUE(line.starts_with("matrix,source,family,system,integrator,dof,steps,"));
  const auto columns = std::count(line.begin(), line.end(), ',');
  ASSERT_EQ(results.at("matrices").size(), 4U);
  EXPECT_EQ(results.at("matrices").at(0).at("name"), "arm_bdf2_8_adjoint");
  EXPECT_EQ(results.at("matrices").at(3).at("name"), "tree4_bdf2_8_kkt");
  bool amd = false;
  for (const json& matrix : results.at("matrices")) {
    EXPECT_NE(outcome_.out.find(matrix.at("name").get<std::string>() + ": "), std::string::npos);
    for (const json& solver : matrix.at("solvers")) {
      ASSERT_TRUE(std::getline(csv, line));
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
      EXPECT_TRUE(line.starts_with(matrix.at("name").get<std::string>() + ","));
      EXPECT_NE(line.find("," + solver.at("solver").get<std::string>() + "," +
                          solver.at("ordering").get<std::string>() + ","),
                std::string::npos)
          << line;
      EXPECT_NE(line.find("," + solver.at("backward_error").dump()), std::string::npos) << line;
      amd = amd || solver.at("ordering") == "amd";
    }
  }
  EXPECT_TRUE(amd);
  EXPECT_FALSE(std::getline(csv, line));
  for (const json& profile : results.at("profiles")) {
    EXPECT_EQ(profile.at("ratios").size(), profile.at("solved"));
    for (const json& ratio : profile.at("ratios")) {
      EXPECT_GE(ratio, 1.0);
    }
  }
}

TEST_F(SolversCommand, GrowthIsFittedAlongStepsAndCoordinates) {
  const json results = measured({"--family", "chain", "--dof", "2,4", "--steps", "10,20,40",
                                 "--system", "adjoint", "--solver", "klu"});
  std::set<std::string> groups;
  for (const json& line : results.at("scaling")) {
    groups.insert(line.at("group"));
    const bool steps = line.at("axis") == "steps";
    EXPECT_EQ(line.at("at"), steps ? json({10.0, 20.0, 40.0}) : json({2.0, 4.0}));
    EXPECT_TRUE(line.at("time_exponent").is_number());
    // The factors of twice the steps take about twice the memory.
    if (steps) {
      EXPECT_NEAR(line.at("memory_exponent"), 1.0, 0.3);
    }
  }
  EXPECT_EQ(groups, (std::set<std::string>{"chain2_bdf2_adjoint", "chain4_bdf2_adjoint",
                                           "chain_bdf2_10_adjoint", "chain_bdf2_20_adjoint",
                                           "chain_bdf2_40_adjoint"}));
  EXPECT_NE(outcome_.out.find("exponent of time and of memory in T"), std::string::npos);
  EXPECT_NE(outcome_.out.find("exponent of time and of memory in n"), std::string::npos);
}

TEST_F(SolversCommand, WhatASolverRefusesIsSaidAndTheRestGoesOn) {
  const json results = measured({"--family", "chain", "--dof", "2", "--steps", "5", "--system",
                                 "kkt", "--solver", "block_substitution,klu"});
  const json& solvers = results.at("matrices").at(0).at("solvers");
  ASSERT_EQ(solvers.size(), 2U);
  const std::string refusal = solvers[0].at("failure");
  EXPECT_NE(refusal, "");
  EXPECT_NE(outcome_.out.find(refusal), std::string::npos);
  EXPECT_FALSE(solvers[0].contains("seconds"));
  EXPECT_EQ(solvers[1].at("failure"), "");
}

TEST_F(SolversCommand, StandardOutputHoldsEitherTheTableOrTheFile) {
  const std::vector<std::string> small = {"solvers",  scene("pendulum"), "--steps",  "5",
                                          "--system", "adjoint",         "--solver", "klu"};
  std::vector<std::string> arguments = small;
  arguments.insert(arguments.end(), {"--json", "-"});
  EXPECT_TRUE(json::accept(hbar(arguments).out));
  arguments = small;
  arguments.insert(arguments.end(), {"--csv", "-"});
  EXPECT_TRUE(hbar(arguments).out.starts_with("matrix,source,"));
}

TEST_F(SolversCommand, AnInterruptKeepsWhatWasMeasured) {
  Program program(folder_, words({"solvers", "--family", "chain", "--dof", "12", "--steps", "10000",
                                  "--json", path("r.json")}));
  program.interrupt();
  EXPECT_EQ(program.wait(), 130);
  EXPECT_NE(program.err().find("interrupted after "), std::string::npos) << program.err();
  EXPECT_EQ(result("r.json").at("interrupted"), true);
}

struct Mistake {
  std::vector<std::string> arguments;
  std::string message;
  int code = 2;
};

TEST_F(SolversCommand, EveryMistakeIsNamed) {
  const std::vector<Mistake> mistakes = {
      {{"--family", "chian"}, "--family: there is no \"chian\"; did you mean 'chain'?"},
      {{"--family", " "}, "--family: it is empty"},
      {{"--family", "hand", "--dof", "2"}, "--dof: family hand needs at least 3 joints, not 2"},
      {{"--dof", "7,x"}, "--dof: \"x\" is not a whole number"},
      {{"--steps", "100,0"}, "--steps: 0 is not at least 1"},
      {{"--steps", "1,,2"}, "--steps: entry 2 is missing between commas"},
      {{"--integrator", "bdf3"}, "--integrator: there is no \"bdf3\"; did you mean 'bdf1'?"},
      {{"--system", "adjiont"}, "--system: there is no \"adjiont\"; did you mean 'adjoint'?"},
      {{"--solver", "auto,kluu"}, "--solver: there is no \"kluu\"; did you mean 'klu'?"},
      {{"--ordering", "amdd"}, "--ordering: there is no \"amdd\"; did you mean 'amd'?"},
      {{"--solver", "auto", "--ordering", "metis"},
       "--ordering: none of these solvers offers any of these orderings; take default"},
      {{"--clock", "cup"}, "--clock: there is no \"cup\"; did you mean 'cpu'?"},
      {{"--rhs", "0"}, "--rhs: 0 is not at least 1"},
      {{"--rhs", "10001"}, "--rhs: 10001 is above 10000, the largest that is allowed"},
      {{"--repeat", "10001"}, "--repeat: 10001 is above 10000, the largest that is allowed"},
      {{"--dof", "7,10001"}, "--dof: 10001 is above 10000, the largest that is allowed"},
      {{"--steps", "1000001"}, "--steps: 1000001 is above 1000000, the largest that is allowed"},
      {{"--repeat", "many"}, "--repeat: \"many\" is not a whole number"},
      {{"--json", "-", "--csv", "-"}, "--json and --csv cannot both go to standard output"},
      {{"--json", "r", "--csv", "r"}, "--json and --csv name the same file"},
      {{"--step", "3"},
       "solvers: there is no option --step; did you mean '--steps'? (see: hbar solvers --help)"},
      {{"/nowhere.xml"}, "/nowhere.xml: cannot be opened: No such file or directory", 6},
      {{"--json", "/nowhere/r.json"},
       "/nowhere/r.json: cannot be written: there is no folder /nowhere",
       6},
      {{"--matrices", "/nowhere"}, "/nowhere: cannot be read: No such file or directory", 6},
      {{"--plots", "/proc/plots"},
       "/proc/plots: the folder cannot be made: No such file or directory",
       6},
  };
  for (Mistake mistake : mistakes) {
    SCOPED_TRACE(mistake.message);
    mistake.arguments.insert(mistake.arguments.begin(), "solvers");
    const Outcome outcome = hbar(mistake.arguments);
    if (mistake.arguments[1] == "--plots" && outcome.err.find("gnuplot-nox") != std::string::npos) {
      continue;  // which is said before
    }
    EXPECT_EQ(outcome.code, mistake.code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "hbar: " + mistake.message + "\n");
  }
}

TEST_F(SolversCommand, ABadSceneOrEmptyFolderExitsWithThree) {
  const std::string bad = write("bad.xml", "<redmax>\n<robot>\n<lnk/>\n</robot>\n</redmax>\n");
  const Outcome scene = hbar({"solvers", bad});
  EXPECT_EQ(scene.code, 3);
  EXPECT_EQ(scene.err.find("hbar: bad.xml:3: "), 0U) << scene.err;
  std::filesystem::create_directory(path("empty"));
  const Outcome empty = hbar({"solvers", "--matrices", path("empty")});
  EXPECT_EQ(empty.code, 3);
  EXPECT_EQ(empty.err, "hbar: " + path("empty") +
                           ": there is no Matrix Market file (NAME.mtx or NAME.mtx.gz)\n");
}

TEST_F(SolversCommand, NeedsNoLargeStack) {
  EXPECT_EQ(with_small_stack("solvers --dof 3 --steps 5"), 0) << read_file(path("err"));
}

}  // namespace
}  // namespace hbar::tool
