#include "hbar/adjoint/study/solution_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <vector>

#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/text_file.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/programs.h"
#include "tests/support/temporary_folder.h"

namespace hbar::study {
namespace {

using solvers::testing::Hs071;

Solution odd_solution() {
  Solution solution;
  solution.point = {.x = Eigen::Vector2d(1.0 / 3.0, -5e-324),
                    .constraint_multipliers = Eigen::VectorXd::Constant(1, -0.1),
                    .lower_multipliers = Eigen::Vector2d(1e300, 0.0),
                    .upper_multipliers = Eigen::Vector2d(0.0, 2.5),
                    .mu = 1e-9};
  solution.variable_names = {"length, m", "u[3] \"grip\""};
  solution.constraint_names = {"reach"};
  solution.objective = 0.1 + 0.2;
  solution.status = "iteration limit";
  solution.about = {{"scene", "finger.xml"}, {"note", "two\nlines"}};
  return solution;
}

class SolutionFile : public ::testing::Test {
 protected:
  /// Why a file of that text is refused by Hs071; empty if it is not.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    scene::write_file_atomically(folder_ / "s", text);
    const std::string message =
        testing::message_of<InvalidInput>([&] { (void)load_solution(folder_ / "s", Hs071()); });
    return message.empty() ? message : message.substr((folder_ / "s").string().size());
  }
  scene::TemporaryFolder folder_;
};

TEST_F(SolutionFile, IsReadToTheLastBit) {
  const Solution written = odd_solution();
  save_solution(folder_ / "s", written);
  const Solution read = read_solution(folder_ / "s");
  EXPECT_EQ(read.point.x, written.point.x);
  EXPECT_EQ(read.point.constraint_multipliers, written.point.constraint_multipliers);
  EXPECT_EQ(read.point.lower_multipliers, written.point.lower_multipliers);
  EXPECT_EQ(read.point.upper_multipliers, written.point.upper_multipliers);
  EXPECT_EQ(read.point.mu, written.point.mu);
  EXPECT_EQ(read.objective, written.objective);
  EXPECT_EQ(read.status, written.status);
  EXPECT_EQ(read.about, written.about);
  EXPECT_EQ(read.variable_names, written.variable_names);
  EXPECT_EQ(read.constraint_names, written.constraint_names);
}

TEST_F(SolutionFile, IsATextThatCanBeRead) {
  save_solution(folder_ / "s", odd_solution());
  EXPECT_EQ(scene::read_text_file(folder_ / "s"),
            "hbar-solution,3\n"
            "status,iteration limit,b841a395\n"
            "objective,0.30000000000000004,11182cd9\n"
            "mu,1e-09,b4b16c8b\n"
            "about,note,\"two\nlines\",5ef60154\n"
            "about,scene,finger.xml,674e75e5\n"
            "# variable, name, value, multiplier of its lower bound, of its upper bound, checksum\n"
            "variable,\"length, m\",0.3333333333333333,1e+300,0,8f970acb\n"
            "variable,\"u[3] \"\"grip\"\"\",-5e-324,0,2.5,34689f56\n"
            "# constraint, name, multiplier, checksum\n"
            "constraint,reach,-0.1,c479ebd1\n"
            "end,2,1\n");
}

TEST_F(SolutionFile, OfAnotherProgramIsRefusedWithWhatDiffers) {
  const std::string head = "hbar-solution,3\n";
  const std::string x012 = "variable,x0,1,0,0,\nvariable,x1,1,0,0,\nvariable,x2,1,0,0,\n";
  const std::string x3 = "variable,x3,1,0,0,\n";
  const std::string c = "constraint,product,1,\nconstraint,sphere,1,\n";
  const std::string end = "end,4,2\n";
  EXPECT_EQ(refusal(head + x012 + x3 + c + end), "");
  EXPECT_EQ(refusal(head + x012 + "variable,y3,1,0,0,\n" + c + end),
            ":5:10: another program's solution: variable 3 is \"y3\", not \"x3\"");
  EXPECT_EQ(refusal(head + x012 + c + "end,3,2\n"),
            ":7:7: another program's solution: it has 3 variables, the program 4");
  EXPECT_EQ(refusal(head + x012 + x3 + "variable,x4,1,0,0,\n" + c + "end,5,2\n"),
            ":6:10: another program's solution: it has 5 variables, the program 4");
  EXPECT_EQ(refusal(head + x012 + x3 + "constraint,sphere,1,\nconstraint,product,1,\n" + end),
            ":6:12: another program's solution: constraint 0 is \"sphere\", not \"product\"");
}

TEST_F(SolutionFile, ThatIsNoneIsRefusedWithThePlace) {
  EXPECT_EQ(refusal(""), ":1: this is no solution, which begins with \"hbar-solution,3\"");
  EXPECT_EQ(refusal("<redmax/>\n"),
            ":1: this is no solution, which begins with \"hbar-solution,3\"");
  EXPECT_EQ(refusal("hbar-solution,2\n"), ":1:15: version 2 of the format; known is 3");
  EXPECT_EQ(refusal("hbar-solution,3\nvariable,x0,inf,0,0,\n"),
            ":2:13: \"inf\" is not a finite number");
  EXPECT_EQ(refusal("hbar-solution,3\nvariable,x0,1\n"),
            ":2:13: \"variable\" has 2 entries; it takes 5");
  EXPECT_EQ(refusal("hbar-solution,3\nangle,x0,1\n"),
            ":2:1: \"angle\" is nothing that a solution has");
}

TEST_F(SolutionFile, IsRefusedWhereverItWasCut) {
  Hs071 program;
  static_cast<void>(solve_and_save(program, {}, folder_ / "s"));
  const std::string whole = scene::read_text_file(folder_ / "s");
  EXPECT_EQ(refusal(whole), "");
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    EXPECT_NE(refusal(whole.substr(0, length)), "") << length << " of " << whole.size() << " bytes";
  }
  EXPECT_EQ(refusal("hbar-solution,3\nvariable,x0,1,0,0,\nconstraint,c,0.13,\n"),
            ":3:19: this solution is not whole: after 1 variables and 1 constraints there is no "
            "line \"end\" that counts them");
}

TEST_F(SolutionFile, TellsWhichLineIsDamaged) {
  Hs071 program;
  static_cast<void>(solve_and_save(program, {}, folder_ / "s"));
  const std::string whole = scene::read_text_file(folder_ / "s");
  const auto line = static_cast<long>(whole.find("variable,x2"));
  const std::string number =
      ':' + std::to_string(1 + std::count(whole.begin(), whole.begin() + line, '\n')) + ':';
  const std::size_t end = whole.find('\n', static_cast<std::size_t>(line));
  for (std::size_t at = static_cast<std::size_t>(line); at < end; ++at) {
    std::string spoiled = whole;
    spoiled[at] = spoiled[at] == '1' ? '2' : '1';
    EXPECT_EQ(refusal(spoiled).find(number), 0U) << refusal(spoiled);
  }
  std::string twice = whole;
  twice.replace(static_cast<std::size_t>(line) + 9, 2, "x3");
  EXPECT_NE(refusal(twice).find("this line was changed or damaged after it was written: its "
                                "checksum is \""),
            std::string::npos)
      << refusal(twice);
  std::string edited = whole;
  edited.replace(end - 8, 8, "");
  EXPECT_EQ(refusal(edited), "") << "an emptied checksum";
}

TEST_F(SolutionFile, TakesOnlyFiniteNumbersOfTheRightCount) {
  Solution solution = odd_solution();
  solution.point.x[1] = testing::kNan;
  EXPECT_THROW(save_solution(folder_ / "s", solution), InvalidInput);
  solution = odd_solution();
  solution.point.constraint_multipliers.resize(0);
  EXPECT_THROW(save_solution(folder_ / "s", solution), InvalidInput);
  EXPECT_EQ(folder_.count(), 0);
}

TEST_F(SolutionFile, IsAWarmStart) {
  Hs071 program;
  const solvers::IpoptResult cold = solve_and_save(program, {}, folder_ / "s", {{"by", "a test"}});
  ASSERT_TRUE(cold.converged());
  EXPECT_EQ(read_solution(folder_ / "s").status, "optimal");
  EXPECT_EQ(read_solution(folder_ / "s").about.at("by"), "a test");

  solvers::IpoptOptions options;
  options.warm_start = load_solution(folder_ / "s", program);
  const solvers::IpoptResult warm = solve_and_save(program, options, folder_ / "s");
  EXPECT_TRUE(warm.converged());
  EXPECT_LT(2 * warm.iterations, cold.iterations);
  EXPECT_LT((warm.x - solvers::testing::kHs071Optimum).norm(), 1e-6);
}

TEST_F(SolutionFile, IsWrittenWhenIpoptIsInterrupted) {
  Hs071 program;
  const std::atomic<bool> stop = true;
  solvers::IpoptOptions options;
  options.stop = &stop;
  const solvers::IpoptResult result = solve_and_save(program, options, folder_ / "s");
  EXPECT_EQ(result.status, solvers::IpoptStatus::kInterrupted);
  EXPECT_EQ(read_solution(folder_ / "s").status, to_string(result.status));
  EXPECT_EQ(load_solution(folder_ / "s", program).x, result.x);
}

/// Hs071 that looks at the file at each evaluation of its objective.
struct Watched final : Hs071 {
  explicit Watched(std::filesystem::path path) : file(std::move(path)) {}
  double objective(const Eigen::VectorXd& x) override {
    if (std::filesystem::exists(file)) {
      const Solution saved = read_solution(file);  // refuses what is not whole
      found.push_back(saved.objective);
      EXPECT_EQ(load_solution(file, *this).x, saved.point.x);
      multipliers = saved.point.constraint_multipliers;
      EXPECT_EQ(saved.status, "interrupted");
    }
    return Hs071::objective(x);
  }
  std::filesystem::path file;
  std::vector<double> found;
  Eigen::VectorXd multipliers;
};

TEST_F(SolutionFile, HoldsTheBestSoFarAllTheWhile) {
  Watched program(folder_ / "s");
  solvers::IpoptOptions options;
  options.checkpoint_every = 0.0;
  const solvers::IpoptResult result = solve_and_save(program, options, folder_ / "s");
  ASSERT_TRUE(result.converged());
  ASSERT_GE(program.found.size(), 5U);
  // What is in the file before the last evaluation is the last but one, with multipliers that fit.
  EXPECT_NEAR(program.found.back(), result.objective, 1e-4);
  EXPECT_LT((program.multipliers - result.constraint_multipliers).norm(), 1e-3);
  EXPECT_GT(result.constraint_multipliers.norm(), 0.1);
  EXPECT_EQ(folder_.count(), 1);
}

TEST_F(SolutionFile, IsRefusedBeforeTheWorkWhereItCannotBeWritten) {
  Hs071 program;
  int calls = 0;
  solvers::IpoptOptions options;
  options.on_iteration = [&calls](const solvers::IterationInfo&) { return ++calls > 0; };
  EXPECT_EQ(testing::message_of<IoError>(
                [&] { (void)solve_and_save(program, options, "/no/such/folder/s"); }),
            "/no/such/folder/s: cannot be written: there is no folder /no/such/folder");
  EXPECT_EQ(calls, 0);
}

TEST_F(SolutionFile, ThatCannotBeWrittenInTheEndIsSavedElsewhere) {
  std::filesystem::create_directory(folder_ / "out");
  Hs071 program;
  solvers::IpoptOptions options;
  options.on_iteration = [this](const solvers::IterationInfo&) {
    std::filesystem::remove_all(folder_ / "out");
    return true;
  };
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  const std::string message = testing::message_of<IoError>(
      [&] { (void)solve_and_save(program, options, folder_ / "out/s"); });
  std::filesystem::current_path(before);
  EXPECT_EQ(message, (folder_ / "out/s").string() +
                         ": cannot be written: No such file or directory; saved as ./s.rescued "
                         "instead");
  EXPECT_EQ(read_solution(folder_ / "s.rescued").status, "optimal");
}

}  // namespace
}  // namespace hbar::study
