// The examples run and print what their documents say.

#include <cmath>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using Examples = ToolTest;

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

/// Equal word by word; numbers up to two units of the last digit that is printed.
void expect_same_text(const std::string& found, const std::string& expected) {
  const std::vector<std::string> ours = words_of(found);
  const std::vector<std::string> theirs = words_of(expected);
  ASSERT_EQ(ours.size(), theirs.size()) << found;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    char* end = nullptr;
    const double number = std::strtod(theirs[i].c_str(), &end);
    const std::size_t point = theirs[i].find('.');
    if (*end != '\0' || point == std::string::npos) {
      EXPECT_EQ(ours[i], theirs[i]);
      continue;
    }
    const auto digits = static_cast<double>(theirs[i].size() - point - 1);
    EXPECT_NEAR(std::strtod(ours[i].c_str(), nullptr), number, 2.001 * std::pow(10.0, -digits));
  }
}

TEST_F(Examples, PendulumPrintsWhatItSays) {
  Program program(folder_, {HBAR_PENDULUM});
  EXPECT_EQ(program.wait(), 0);
  const std::string expected = read_file(kSource / "examples/expected/pendulum.txt");
  expect_same_text(program.out(), expected);

  std::istringstream source(read_file(kSource / "examples/pendulum.cpp"));
  std::string said;
  int lines = 0;
  for (std::string line; std::getline(source, line); ++lines) {
    if (line.starts_with("//   ") && line.find("cmake") == std::string::npos) {
      said += line.substr(5) + '\n';
    }
  }
  EXPECT_EQ(words_of(said), words_of(expected));
  EXPECT_LT(lines, 60);
}

TEST_F(Examples, ThePendulumsSceneIsThePendulumOfTheProgram) {
  const Outcome outcome = hbar(
      {"gradient", scene("pendulum"), "--steps", "100", "--q0", "1.2", "--out", path("r.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<std::string> expected =
      words_of(read_file(kSource / "examples/expected/pendulum.txt"));
  const nlohmann::json r = result("r.json");
  EXPECT_NEAR(r.at("q").at(100).at(0), std::stod(expected.at(4)), 2e-6);
}

TEST_F(Examples, EverySceneSimulatesAndItsGradientIsConfirmed) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".xml") {
      continue;
    }
    SCOPED_TRACE(entry.path());
    const Outcome info = hbar({"info", entry.path()});
    EXPECT_EQ(info.code, 0);
    // Limits of some scenes are for their optimisations.
    EXPECT_EQ(std::count(info.err.begin(), info.err.end(), '\n'),
              info.err.find("it bounds optimisations alone") == std::string::npos ? 0 : 1)
        << info.err;
    const Outcome check = hbar({"check", entry.path(), "--steps", "10"});
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    ++scenes;
  }
  EXPECT_GE(scenes, 4);
}

}  // namespace
}  // namespace hbar::tool
