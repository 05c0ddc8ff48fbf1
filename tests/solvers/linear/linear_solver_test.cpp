#include "hbar/solvers/linear/linear_solver.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <thread>

#include "hbar/solvers/linear/block_substitution.h"
#include "hbar/solvers/linear/klu.h"
#ifdef HBAR_HAVE_UMFPACK
#include "hbar/solvers/linear/umfpack.h"
#endif
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_block_lower;
using testing::random_dense;
using testing::random_sparse;

const std::vector<int> kBlocks = {4, 1, 7, 4, 4, 12, 3, 4};

/// One row of the table of solvers.
struct GeneralEntry {
  std::string name;
  bool general;  ///< takes any pattern
  std::function<std::unique_ptr<LinearSolver>(const std::vector<int>&)> make;
};

std::vector<GeneralEntry> every_solver() {
  return {
      {"block_substitution", false, make_block_substitution},
      {"klu", true, [](const std::vector<int>&) { return make_klu(); }},
#ifdef HBAR_HAVE_UMFPACK
      {"umfpack", true, [](const std::vector<int>&) { return make_umfpack(); }},
#endif
  };
}

class EverySolver : public ::testing::TestWithParam<GeneralEntry> {
 protected:
  [[nodiscard]] static std::unique_ptr<LinearSolver> make(const std::vector<int>& blocks) {
    return GetParam().make(blocks);
  }
  [[nodiscard]] static std::unique_ptr<LinearSolver> factorized(const SparseMatrix& A,
                                                                const std::vector<int>& blocks) {
    auto solver = make(blocks);
    solver->analyze(A);
    solver->factorize(A);
    return solver;
  }
};

INSTANTIATE_TEST_SUITE_P(Solvers, EverySolver, ::testing::ValuesIn(every_solver()),
                         [](const auto& entry) { return entry.param.name; });

void expect_solves_like_dense(LinearSolver& solver, const SparseMatrix& A) {
  const Eigen::MatrixXd dense(A);
  for (const int count : {1, 5}) {
    const Eigen::MatrixXd B = random_dense(static_cast<int>(A.rows()), count, 11);
    Eigen::MatrixXd X(B.rows(), B.cols());
    solver.solve(B, X);
    const Eigen::MatrixXd expected = dense.partialPivLu().solve(B);
    EXPECT_LE((X - expected).lpNorm<Eigen::Infinity>(), 1e-12 * expected.lpNorm<Eigen::Infinity>());
    solver.solve_transposed(B, X);
    const Eigen::MatrixXd transposed = dense.transpose().partialPivLu().solve(B);
    EXPECT_LE((X - transposed).lpNorm<Eigen::Infinity>(),
              1e-12 * transposed.lpNorm<Eigen::Infinity>());
  }
}

TEST_P(EverySolver, IsNamedAsInTheTable) { EXPECT_EQ(make(kBlocks)->name(), GetParam().name); }

TEST_P(EverySolver, AgreesWithDenseLuOnBlockLowerTriangularMatrices) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const SparseMatrix A = random_block_lower(kBlocks, seed);
    expect_solves_like_dense(*factorized(A, kBlocks), A);
  }
}

TEST_P(EverySolver, AgreesWithDenseLuOnOneDenseBlock) {
  const SparseMatrix A = random_block_lower({20}, 5);
  expect_solves_like_dense(*factorized(A, {20}), A);
}

TEST_P(EverySolver, AgreesWithDenseLuOnUnsymmetricMatricesOrRefusesThem) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const SparseMatrix A = random_sparse(80, 4, seed);
    if (GetParam().general) {
      expect_solves_like_dense(*factorized(A, {}), A);
    } else {
      EXPECT_THROW(factorized(A, {40, 40}), InvalidInput);
    }
  }
}

TEST_P(EverySolver, SolvesAdjointSystems) {
  const SparseMatrix A = random_block_lower(kBlocks, 4);
  const auto solver = factorized(A, kBlocks);
  const Eigen::VectorXd x = random_dense(solver->size(), 1, 1);
  const Eigen::VectorXd y = random_dense(solver->size(), 1, 2);
  Eigen::VectorXd u(x.size());
  Eigen::VectorXd w(x.size());
  solver->solve(x, u);
  solver->solve_transposed(y, w);
  EXPECT_NEAR(u.dot(y), x.dot(w), 1e-13 * u.norm() * y.norm());
}

TEST_P(EverySolver, SolvesInPlaceAndSkipsZeros) {
  const SparseMatrix A = random_block_lower(kBlocks, 4);
  const auto solver = factorized(A, kBlocks);
  Eigen::MatrixXd B = random_dense(solver->size(), 3, 8);
  B.topRows(12).setZero();
  B.col(1).setZero();
  Eigen::MatrixXd X(B.rows(), B.cols());
  for (const System system : {System::kPlain, System::kTransposed}) {
    solver->solve(system, B, X);
    EXPECT_EQ(X.col(1).norm(), 0.0);
    Eigen::MatrixXd in_place = B;
    solver->solve(system, in_place, in_place);
    EXPECT_EQ(in_place, X);
  }
  solver->solve(B, X);
  EXPECT_EQ(X.topRows(12).norm(), 0.0);
}

TEST_P(EverySolver, AnalysesOnceForManyFactorisations) {
  SparseMatrix A = random_block_lower(kBlocks, 1);
  const auto solver = make(kBlocks);
  solver->analyze(A);
  for (const unsigned seed : {1U, 2U, 3U}) {
    A = random_block_lower(kBlocks, seed);
    solver->factorize(A);
    expect_solves_like_dense(*solver, A);
  }
  EXPECT_EQ(solver->statistics().analyses, 1);
  EXPECT_EQ(solver->statistics().factorizations, 3);
  EXPECT_EQ(solver->statistics().solves, 36);
  EXPECT_LT(solver->statistics().worst_residual, 1e-13);
}

TEST_P(EverySolver, NamesTheRowAndColumnOfASingularMatrix) {
  SparseMatrix A = random_block_lower({3, 3, 3}, 6);
  const auto solver = factorized(A, {3, 3, 3});
  // Column 4 twice column 3 within its diagonal block, and nothing below: the rank falls by one.
  for (SparseMatrix::InnerIterator entry(A, 4); entry; ++entry) {
    entry.valueRef() = 2.0 * A.coeff(entry.row(), 3);
  }
  const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
  EXPECT_NE(message.find(GetParam().name + ": factorize: "), std::string::npos) << message;
  EXPECT_NE(message.find("is singular to working precision: the pivot in row "), std::string::npos)
      << message;
  EXPECT_TRUE(message.find("column 3 is ") != std::string::npos ||
              message.find("column 4 is ") != std::string::npos)
      << message;
  Eigen::VectorXd x = Eigen::VectorXd::Ones(9);
  EXPECT_THROW(solver->solve(x, x), InvalidInput) << "a failed factorisation must not be usable";
}

TEST_P(EverySolver, RefusesAMatrixOfZeros) {
  SparseMatrix A = random_block_lower({2, 2}, 6);
  A.coeffs().setZero();
  const auto solver = make({2, 2});
  solver->analyze(A);
  const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
  EXPECT_NE(message.find("singular"), std::string::npos) << message;
}

TEST_P(EverySolver, RecoversAfterASingularMatrix) {
  const SparseMatrix good = random_block_lower({2, 2}, 6);
  SparseMatrix bad = good;
  bad.coeffs().setZero();
  const auto solver = factorized(good, {2, 2});
  EXPECT_THROW(solver->factorize(bad), NumericalFailure);
  solver->factorize(good);
  expect_solves_like_dense(*solver, good);
}

TEST_P(EverySolver, RefusesEntriesThatAreNotNumbers) {
  SparseMatrix A = random_block_lower({2, 2}, 6);
  const auto solver = make({2, 2});
  solver->analyze(A);
  A.coeffRef(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of<NumericalFailure>([&] { solver->factorize(A); }),
            GetParam().name +
                ": factorize: the entry in row 3, column 1 is nan; check the state the matrix was "
                "computed at");
}

TEST_P(EverySolver, RefusesAnotherPattern) {
  const auto solver = make({2, 2});
  solver->analyze(random_block_lower({2, 2}, 6));
  EXPECT_EQ(message_of<InvalidInput>([&] {
              solver->factorize(random_block_lower({3, 3}, 6));
            }),
            GetParam().name +
                ": factorize: the matrix (6 x 6, 27 entries) has another pattern than the one "
                "analysed (4 x 4, 12 entries); call analyze again");
}

TEST_P(EverySolver, WorksInTwoThreadsWithASolverEach) {
  const auto work = [](unsigned seed, bool& fine) {
    const SparseMatrix A = random_block_lower(kBlocks, seed);
    const auto solver = factorized(A, kBlocks);
    const Eigen::VectorXd b = random_dense(solver->size(), 1, seed);
    Eigen::VectorXd x(b.size());
    fine = true;
    for (int repeat = 0; repeat < 50; ++repeat) {
      solver->factorize(A);
      solver->solve(b, x);
      fine = fine && (A * x - b).lpNorm<Eigen::Infinity>() < 1e-11;
    }
  };
  bool first = false;
  bool second = false;
  std::thread other(work, 1U, std::ref(first));
  work(2U, second);
  other.join();
  EXPECT_TRUE(first && second);
}

TEST_P(EverySolver, RefusesCallsOutOfOrderAndShapesThatDisagree) {
  const std::string& name = GetParam().name;
  const SparseMatrix A = random_block_lower({2, 2}, 6);
  const auto solver = make({2, 2});
  Eigen::VectorXd x = Eigen::VectorXd::Ones(4);
  EXPECT_EQ(message_of<InvalidInput>([&] { solver->factorize(A); }),
            name + ": factorize: no pattern was analysed; call analyze first");
  EXPECT_EQ(message_of<InvalidInput>([&] { solver->solve(x, x); }),
            name + ": solve: no matrix is factorised; call factorize first");
  solver->analyze(A);
  solver->factorize(A);
  Eigen::VectorXd y(3);
  EXPECT_EQ(message_of<InvalidInput>([&] { solver->solve(x, y); }),
            name +
                ": solve: the right-hand sides are 4 x 1 and the solutions 3 x 1; expected 4 rows "
                "and equal shapes");
  x[2] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message_of<NumericalFailure>([&] { solver->solve(x, x); }),
            name + ": solve: row 2 of right-hand side 0 is inf; check what it was computed from");
}

TEST_P(EverySolver, RefusesPatternsItCannotUse) {
  const std::string where = GetParam().name + ": analyze: ";
  const auto solver = make({2, 2});
  EXPECT_EQ(message_of<InvalidInput>([&] { solver->analyze(SparseMatrix(2, 3)); }),
            where + "the matrix is 2 x 3; expected a square one with at least one row");
  SparseMatrix loose(4, 4);
  loose.insert(0, 0) = 1.0;
  loose.uncompress();
  EXPECT_EQ(message_of<InvalidInput>([&] { solver->analyze(loose); }),
            where + "the matrix is not compressed; call makeCompressed() first");
  loose.makeCompressed();
  EXPECT_EQ(message_of<NumericalFailure>([&] { solver->analyze(loose); }),
            where +
                "the matrix is singular: column 1 has no entry; look for an unknown that no "
                "equation uses");
  SparseMatrix rows(2, 2);
  rows.insert(0, 0) = 1.0;
  rows.insert(0, 1) = 1.0;
  rows.makeCompressed();
  EXPECT_EQ(message_of<NumericalFailure>([&] { solver->analyze(rows); }),
            where +
                "the matrix is singular: row 1 has no entry; look for an equation without "
                "unknowns");
}

/// A solver of the identity whose solutions are wrong by a factor.
class WrongByAFactor final : public LinearSolver {
 public:
  explicit WrongByAFactor(double factor) : factor_(factor) {}
  [[nodiscard]] std::string name() const override { return "wrong"; }
  [[nodiscard]] FactorInfo factor_info() const override { return {}; }

 private:
  void do_analyze() override {}
  void do_factorize() override {}
  void do_solve(System, MatrixSpan X) override { X *= factor_; }
  double factor_;
};

std::string solve_identity(double factor, SolverStatistics* statistics = nullptr,
                           Eigen::VectorXd* solution = nullptr) {
  SparseMatrix identity(3, 3);
  identity.setIdentity();
  WrongByAFactor solver(factor);
  solver.analyze(identity);
  solver.factorize(identity);
  Eigen::VectorXd x(3);
  const std::string message =
      message_of<NumericalFailure>([&] { solver.solve(Eigen::VectorXd::Ones(3), x); });
  if (statistics != nullptr) {
    *statistics = solver.statistics();
  }
  if (solution != nullptr) {
    *solution = x;
  }
  return message;
}

TEST(ResidualCheck, ConvictsASilentlyWrongSolution) {
  EXPECT_EQ(solve_identity(1.5),
            "wrong: the scaled residual of A x = b, right-hand side 0, is 0.142857 after "
            "refinement; allowed: 1e-10 (3 x 3 matrix); try another solver, or bring the unknowns "
            "to similar sizes");
  EXPECT_NE(solve_identity(1.0 + 1e-2), "");  // three refinements leave 1e-8
}

TEST(ResidualCheck, ConvictsSolutionsThatAreNotNumbers) {
  EXPECT_NE(solve_identity(std::numeric_limits<double>::quiet_NaN()).find("is nan"),
            std::string::npos);
  EXPECT_NE(solve_identity(std::numeric_limits<double>::infinity()), "");
}

TEST(ResidualCheck, RefinesAsLongAsThatHelps) {
  Eigen::VectorXd x;
  EXPECT_EQ(solve_identity(1.0 + 1e-4, nullptr, &x), "");
  EXPECT_LT((x - Eigen::VectorXd::Ones(3)).norm(), 1e-13);
}

TEST(ResidualCheck, RefinesWhereOneStepIsEnough) {
  SolverStatistics statistics;
  Eigen::VectorXd x;
  EXPECT_EQ(solve_identity(1.0 + 1e-7, &statistics, &x), "");
  EXPECT_EQ(statistics.refinements, 1);
  EXPECT_LT(statistics.worst_residual, 2e-14);
  EXPECT_LT((x - Eigen::VectorXd::Ones(3)).norm(), 1e-13);
}

TEST(ResidualCheck, HasBoundsThatCanBeSet) {
  WrongByAFactor solver(1.0);
  solver.set_residual_bounds({.refine_above = 0.0, .refuse_above = 1e-3});
  EXPECT_EQ(solver.residual_bounds().refuse_above, 1e-3);
  EXPECT_EQ(message_of<InvalidInput>([&] {
              solver.set_residual_bounds({1e-14, 0.0});
            }),
            "wrong: residual bounds: refine_above is 1e-14, refuse_above 0 and max_refinements 3; "
            "expected 0 or more, more than 0, and 0 or more");
}

}  // namespace
}  // namespace hbar::solvers
