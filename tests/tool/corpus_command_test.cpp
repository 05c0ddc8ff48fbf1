// hbar corpus, and hbar solvers on what it writes.

#include <map>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class CorpusCommand : public ToolTest {
 protected:
  /// The files of a folder, by name.
  [[nodiscard]] std::map<std::string, std::string> files(const std::string& folder) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) {
      out[entry.path().filename()] = read_file(entry.path());
    }
    return out;
  }
};

TEST_F(CorpusCommand, WritesTheSameBytesAgainAndIsABenchmark) {
  const Outcome outcome = hbar({"corpus", path("a/b"), "--size", "small"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto first = files("a/b");
  std::size_t bytes = 0;
  for (const auto& [name, text] : first) {
    bytes += text.size();
  }
  EXPECT_LT(bytes, 15U << 20U);
  EXPECT_EQ(first.size() % 4, 0U);
  EXPECT_EQ(outcome.out,
            std::to_string(first.size() / 4) + " matrices written to " + path("a/b") + "\n");
  ASSERT_EQ(hbar({"corpus", path("again")}).code, 0);
  EXPECT_TRUE(files("again") == first);

  const json sidecar = json::parse(first.at("hand3_bdf2_6_kkt.json"));
  EXPECT_EQ(sidecar.at("source"), "hand3");
  EXPECT_EQ(sidecar.at("n"), 9);
  EXPECT_EQ(sidecar.at("T"), 6);
  EXPECT_EQ(sidecar.at("integrator"), "bdf2");
  EXPECT_EQ(sidecar.at("structure"), "quasi_definite");
  EXPECT_GT(sidecar.at("condition"), 1.0);
  EXPECT_LT(sidecar.at("solution_backward_error"), 1e-15);

  const Outcome benchmark = hbar({"solvers", "--matrices", path("a/b"), "--solver", "auto,klu",
                                  "--repeat", "1", "--json", path("r.json")});
  ASSERT_EQ(benchmark.code, 0) << benchmark.err;
  const json results = result("r.json");
  ASSERT_EQ(results.at("matrices").size(), first.size() / 4);
  for (const json& matrix : results.at("matrices")) {
    SCOPED_TRACE(matrix.at("name").get<std::string>());
    EXPECT_EQ(matrix.at("failure"), "");
    EXPECT_GT(matrix.at("dof"), 0);
    for (const json& solver : matrix.at("solvers")) {
      EXPECT_EQ(solver.at("failure"), "") << solver;
      EXPECT_LE(solver.at("backward_error"), 1e-14) << solver;
    }
  }
}

TEST_F(CorpusCommand, MatricesOfOthersAreMeasuredToo) {
  fs::create_directory(path("other"));
  const std::string definite = write("other/definite.mtx",
                                     "%%MatrixMarket matrix coordinate real symmetric\n"
                                     "3 3 5\n1 1 4\n2 1 -1\n2 2 4\n3 2 -1\n3 3 4\n");
  const std::string general = write("other/general.mtx",
                                    "%%MatrixMarket matrix coordinate integer general\n"
                                    "2 2 3\n1 1 2\n1 2 1\n2 1 1\n");
  const std::string broken = write("other/broken.mtx", "1 2 3\n");
  const Outcome outcome = hbar({"solvers", "--matrices", path("other"), "--json", path("r.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json matrices = result("r.json").at("matrices");
  ASSERT_EQ(matrices.size(), 3U);
  EXPECT_NE(matrices[0].at("failure").get<std::string>().find(broken + ":1: the first line"),
            std::string::npos)
      << matrices[0];
  EXPECT_EQ(matrices[1].at("structure"), "definite");
  EXPECT_EQ(matrices[2].at("structure"), "general");
  for (std::size_t i = 1; i < 3; ++i) {
    for (const json& solver : matrices[i].at("solvers")) {
      EXPECT_EQ(solver.at("failure"), "") << solver;
      EXPECT_LT(solver.at("forward_error"), 1e-14) << solver;
    }
  }
}

TEST_F(CorpusCommand, AStructureIsWhatTheLineSaysOrTheFileBeside) {
  fs::create_directory(path("other"));
  write("other/m.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 3\n2 2 -5\n");
  const auto structure = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"solvers", "--matrices", path("other"), "--solver",
                                      "klu",     "--json",     path("r.json")};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = hbar(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return result("r.json").at("matrices")[0].at("structure").get<std::string>();
  };
  EXPECT_EQ(structure({}), "general");
  EXPECT_EQ(structure({"--structure", "quasi_definite"}), "quasi_definite");
  write("other/m.json", R"({"structure": "definite"})");
  EXPECT_EQ(structure({}), "definite");
  EXPECT_EQ(structure({"--structure", "general"}), "general");
  // A solver's refusal counts rows as the file does.
  ASSERT_EQ(hbar({"solvers", "--matrices", path("other"), "--solver", "cholmod_llt", "--json",
                  path("r.json")})
                .code,
            0);
  const json solver = result("r.json").at("matrices")[0].at("solvers")[0];
  EXPECT_NE(solver.at("failure").get<std::string>().find("row 1 (2 in the file)"),
            std::string::npos)
      << solver;
  EXPECT_EQ(hbar({"solvers", "--structure", "general"}).code, 2);
  EXPECT_EQ(hbar({"solvers", "--matrices", path("other"), "--structure", "generel"}).err,
            "hbar: --structure: there is no \"generel\"; did you mean 'general'?\n");
}

TEST_F(CorpusCommand, AnInterruptEndsBetweenMatrices) {
  Program program(folder_, words({"corpus", path("c"), "--size", "large"}));
  program.interrupt();
  EXPECT_EQ(program.wait(), 130);
  EXPECT_NE(program.err().find("interrupted"), std::string::npos) << program.err();
  for (const auto& [name, text] : files("c")) {
    EXPECT_NE(text, "") << name;
  }
}

TEST_F(CorpusCommand, MistakesAreNamed) {
  const std::string file = write("file", "");
  const std::vector<std::tuple<std::vector<std::string>, std::string, int>> refusals = {
      {{"corpus"}, "corpus: DIR is required (see: hbar corpus --help)", 2},
      {{"corpus", "a", "b"},
       "corpus: what is \"b\" for? One folder is enough (see: hbar corpus --help)",
       2},
      {{"corpus", path("a"), "--size", "tiny"},
       "--size: there is no \"tiny\"; known: small, medium, large, all",
       2},
      {{"corpus", file + "/c"}, file + "/c: the folder cannot be made: Not a directory", 6},
      {{"corpus", path("a"), "--scenes", "/nowhere"},
       "/nowhere/pendulum.xml: cannot be opened: No such file or directory",
       6},
  };
  for (const auto& [arguments, message, code] : refusals) {
    SCOPED_TRACE(message);
    const Outcome outcome = hbar(arguments);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.err, "hbar: " + message + "\n");
  }
}

TEST_F(CorpusCommand, NeedsNoLargeStack) {
  EXPECT_EQ(with_small_stack("corpus " + path("matrices")), 0) << read_file(path("err"));
}

}  // namespace
}  // namespace hbar::tool
