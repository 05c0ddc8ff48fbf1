// The figures of the benchmark of solvers, drawn by gnuplot.

#include "examples/solver_benchmark/gnuplot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "examples/solver_benchmark/plots.h"
#include "examples/solver_benchmark/run_benchmark.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/text_file.h"

namespace hbar::solver_benchmark {
namespace {

namespace fs = std::filesystem;

class Gnuplot : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "hbar_plots.XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = fs::path(name) / "it's a folder";
    fs::create_directory(folder_);
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  fs::path folder_;
};

TEST_F(Gnuplot, DrawsEveryFigureOfABenchmark) {
  BenchmarkPlan plan;
  for (const int steps : {5, 10}) {
    for (const int joints : {2, 3}) {
      plan.cases.push_back({.family = "chain", .joints = joints, .steps = steps});
    }
  }
  plan.solvers = {"klu", "auto"};
  plan.options.repeat = 1;
  std::vector<Plot> spies;
  plan.on_matrix = [&spies](const BenchmarkMatrix& matrix) {
    if (spies.empty()) {
      spies.push_back(spy_plot(matrix));
    }
  };
  const BenchmarkResults results = run_benchmark(plan);
  std::vector<Plot> plots = benchmark_plots(results);
  plots.push_back(spies.at(0));
  std::set<std::string> names;
  for (const Plot& plot : plots) {
    names.insert(plot.name);
  }
  EXPECT_EQ(
      names,
      (std::set<std::string>{
          "time_against_steps_chain2_bdf2_adjoint", "memory_against_steps_chain2_bdf2_adjoint",
          "time_against_steps_chain3_bdf2_adjoint", "memory_against_steps_chain3_bdf2_adjoint",
          "time_against_dof_chain_bdf2_5_adjoint", "memory_against_dof_chain_bdf2_5_adjoint",
          "time_against_dof_chain_bdf2_10_adjoint", "memory_against_dof_chain_bdf2_10_adjoint",
          "performance_profile", "spy_chain2_bdf2_5_adjoint"}));
  write_plots(plots, folder_);
  for (const Plot& plot : plots) {
    const std::string svg = scene::read_text_file(folder_ / (plot.name + ".svg"));
    EXPECT_TRUE(svg.find("<svg") != std::string::npos && svg.ends_with("</svg>\n\n")) << plot.name;
    EXPECT_EQ(scene::read_text_file(folder_ / (plot.name + ".dat")), plot.data);
  }
  const std::string svg =
      scene::read_text_file(folder_ / "memory_against_steps_chain3_bdf2_adjoint.svg");
  EXPECT_NE(svg.find("klu: slope "), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "gnuplot.log"));
}

TEST_F(Gnuplot, SaysWhatIsWrong) {
  scene::write_file_atomically(folder_ / "bad.gp", "plot 'nothing.dat'\n");
  try {
    run_gnuplot(folder_, "bad.gp");
    FAIL() << "a script that reads no file that is there";
  } catch (const IoError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with((folder_ / "bad.gp").string() + ": gnuplot failed: "));
    EXPECT_NE(message.find("nothing.dat"), std::string::npos) << message;
  }
  EXPECT_EQ(quoted("it's"), "'it''s'");
  EXPECT_EQ(file_name("a/b c.xml"), "a-b-c-xml");
}

}  // namespace
}  // namespace hbar::solver_benchmark
