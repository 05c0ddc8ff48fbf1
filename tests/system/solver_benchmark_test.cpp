// What the benchmark of solvers is made of: families, corpus, elimination, performance profiles,
// fits.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>

#include "examples/common/progress_bar.h"
#include "examples/solver_benchmark/corpus.h"
#include "examples/solver_benchmark/elimination.h"
#include "examples/solver_benchmark/families.h"
#include "examples/solver_benchmark/measure.h"
#include "examples/solver_benchmark/performance_profile.h"
#include "examples/solver_benchmark/scaling.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/base/error.h"

namespace hbar::solver_benchmark {
namespace {

using solvers::SparseMatrix;

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(BenchmarkFamilies, HaveTheirJointsAndMoveForManySteps) {
  for (const Family& family : families()) {
    for (const int joints : {family.smallest, 7, 18}) {
      SCOPED_TRACE(family.name + std::to_string(joints));
      const Model model = make_model(family, joints);
      EXPECT_EQ(model.dof(), joints + (family.name == "hand" ? 6 : 0));
      EXPECT_EQ(model.control_count(), joints);
      Horizon horizon(model, ParameterSet::named(model, {}),
                      {.integrator = "bdf2", .h = family.h, .steps = 300});
      Inputs inputs = horizon.nominal_inputs();
      set_gentle_motion(family, model, inputs);
      const Rollout rollout = simulate(horizon, inputs);
      ASSERT_TRUE(rollout.converged()) << rollout.report().message;
      EXPECT_GT(rollout.partial().qdot_at_step(300).norm(), 1e-3);
    }
  }
  EXPECT_THROW(static_cast<void>(find_family("chian")), InvalidInput);
  EXPECT_THROW(static_cast<void>(make_model(find_family("hand"), 2)), InvalidInput);
}

TEST(BenchmarkFamilies, ContactCouplesTheHandsFingersWithTheBall) {
  CaseAssembler assembler;
  const BenchmarkMatrix matrix =
      assembler.assemble({.family = "hand", .joints = 6, .steps = 20, .integrator = "bdf1"});
  const Eigen::MatrixXd last = Eigen::MatrixXd(matrix.A).bottomRightCorner(12, 12);
  // Joints come first, the ball's coordinates last; two fingers meet through the ball alone.
  for (int finger = 0; finger < 3; ++finger) {
    EXPECT_GT(last.block(2 * finger, 6, 2, 6).cwiseAbs().maxCoeff(), 0.0) << finger;
  }
}

TEST(Corpus, HasHundredsOfCasesOfDifferentNames) {
  std::set<std::string> names;
  std::set<std::string> sources;
  std::size_t count = 0;
  for (const CorpusSize size : {CorpusSize::kSmall, CorpusSize::kMedium, CorpusSize::kLarge}) {
    for (const Case& which : corpus_cases(size, "scenes")) {
      names.insert(name_of(which));
      sources.insert(which.family + which.scene.stem().string());
      ++count;
    }
  }
  EXPECT_GE(count, 200U);
  EXPECT_EQ(names.size(), count);
  // Every family and every scene of the examples is there.
  for (const Family& family : families()) {
    EXPECT_TRUE(sources.contains(family.name)) << family.name;
  }
  for (const auto& entry :
       std::filesystem::directory_iterator(HBAR_SOURCE_DIR "/examples/scenes")) {
    if (entry.path().extension() == ".xml") {
      EXPECT_TRUE(sources.contains(entry.path().stem().string())) << entry.path();
    }
  }
}

TEST(PerformanceProfile, IsTheOneWorkedOutByHand) {
  // Best: 1, 2, 3, and nobody on the fourth; c was not tried on the third.
  const CostTable table = {
      {"a", "b", "c"}, {{1.0, 2.0, 4.0}, {4.0, 2.0, kInf}, {3.0, 3.0, -1.0}, {kInf, kInf, kInf}}};
  const std::vector<ProfileLine> lines = performance_profiles(table);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].ratios, (std::vector<double>{1.0, 1.0, 2.0}));
  EXPECT_EQ(lines[1].ratios, (std::vector<double>{1.0, 1.0, 2.0}));
  EXPECT_EQ(lines[2].ratios, (std::vector<double>{4.0}));
  EXPECT_EQ(lines[0].matrices, 3);
  EXPECT_EQ(lines[2].matrices, 2);
  EXPECT_EQ(lines[0].wins, 2);
  EXPECT_EQ(lines[2].wins, 0);
  EXPECT_NEAR(lines[0].mean, std::cbrt(2.0), 1e-15);
  EXPECT_NEAR(lines[2].mean, 4.0, 1e-15);
  EXPECT_EQ(lines[0].share(1.0), 2.0 / 3.0);
  EXPECT_EQ(lines[0].share(1.99), 2.0 / 3.0);
  EXPECT_EQ(lines[0].share(2.0), 1.0);
  EXPECT_EQ(lines[2].share(1e9), 0.5);
  // Of a: 1/2, 4/2, 3/3.
  EXPECT_NEAR(mean_ratio_to_best_other(table, "a"), 1.0, 1e-15);
  EXPECT_EQ(mean_ratio_to_best_other(table, "c"), kInf);
  EXPECT_EQ(mean_ratio_to_best_other(table, "none"), 0.0);
}

TEST(Scaling, FindsTheExponentOfAPowerLaw) {
  EXPECT_NEAR(fitted_exponent({1.0, 10.0, 100.0}, {3.0, 3000.0, 3e6}), 3.0, 1e-13);
  EXPECT_NEAR(fitted_exponent({2.0, 8.0}, {5.0, 5.0}), 0.0, 1e-15);
}

TEST(ProgressBar, FillsUpAndStaysInItsWidth) {
  using example::bar_line;
  EXPECT_EQ(bar_line(0, 4, "one", 80, false), "[--------------------] 0/4 one");
  EXPECT_EQ(bar_line(1, 4, "two", 80, false), "[#####---------------] 1/4 two");
  EXPECT_EQ(bar_line(4, 4, "", 80, false), "[####################] 4/4 ");
  EXPECT_EQ(bar_line(1, 4, std::string(100, 'x'), 40, false).size(), 40U);
  EXPECT_EQ(bar_line(0, 0, "", 80, false), "[--------------------] 0/0 ");
  EXPECT_EQ(bar_line(2, 4, "", 80, true).find('\033'), 1U);
}

/// What Gaussian elimination of A + Aᵀ, done on a dense matrix of marks, leaves below the diagonal.
std::vector<std::vector<int>> dense_elimination(const SparseMatrix& A) {
  const auto n = static_cast<int>(A.cols());
  Eigen::MatrixXd marks = Eigen::MatrixXd(A).cwiseAbs() + Eigen::MatrixXd(A).cwiseAbs().transpose();
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    columns[static_cast<std::size_t>(k)].push_back(k);
    for (int i = k + 1; i < n; ++i) {
      if (marks(i, k) != 0.0) {
        columns[static_cast<std::size_t>(k)].push_back(i);
        for (int j = k + 1; j < n; ++j) {
          marks(i, j) = marks(i, j) != 0.0 || marks(k, j) != 0.0 ? 1.0 : 0.0;
        }
      }
    }
  }
  return columns;
}

/// A square matrix with few random entries.
SparseMatrix random_sparse(int n, double density, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 4.0 + uniform(random));
    for (int j = 0; j < n; ++j) {
      if (i != j && uniform(random) < density) {
        entries.emplace_back(i, j, uniform(random) - 0.5);
      }
    }
  }
  SparseMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

TEST(Elimination, FillsInWhatDenseEliminationDoes) {
  std::size_t given = 0;
  std::size_t minimum = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const SparseMatrix A = random_sparse(40, 0.04, seed);
    EXPECT_EQ(symbolic_factor(A), dense_elimination(A)) << seed;
    const std::vector<int> order = minimum_degree_order(A);
    const SparseMatrix B = reordered(A, order);
    EXPECT_EQ(B.coeff(3, 5), A.coeff(order[3], order[5]));
    EXPECT_EQ(B.nonZeros(), A.nonZeros());
    for (const auto& column : symbolic_factor(A)) {
      given += column.size();
    }
    for (const auto& column : symbolic_factor(B)) {
      minimum += column.size();
    }
  }
  EXPECT_LT(minimum, given);
}

}  // namespace
}  // namespace hbar::solver_benchmark
