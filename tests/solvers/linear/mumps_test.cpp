#include "hbar/solvers/linear/mumps.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/solvers/linear/structured_matrices.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_definite;
using testing::random_dense;
using testing::random_quasi_definite;
using testing::random_sparse;

std::unique_ptr<LinearSolver> factorized(const SparseMatrix& A, Structure structure) {
  auto solver = make_mumps({.structure = structure});
  solver->analyze(A);
  solver->factorize(A);
  return solver;
}

TEST(Mumps, TellsTheInertiaOfSymmetricMatrices) {
  const std::vector<int> blocks(6, 4);
  EXPECT_EQ(factorized(random_definite(blocks, 1), Structure::kDefinite)->factor_info().inertia,
            (Inertia{.positive = 24, .negative = 0, .zero = 0}));
  const SparseMatrix A = random_quasi_definite(blocks, 1);
  EXPECT_EQ(factorized(A, Structure::kQuasiDefinite)->factor_info().inertia,
            (Inertia{.positive = 12, .negative = 12, .zero = 0}));
  EXPECT_EQ(factorized(A, Structure::kGeneral)->factor_info().inertia, std::nullopt);
}

TEST(Mumps, DoesLessForASymmetricMatrix) {
  const SparseMatrix A = random_definite(std::vector<int>(20, 6), 1);
  EXPECT_LT(factorized(A, Structure::kDefinite)->factor_info().flops,
            0.7 * *factorized(A, Structure::kGeneral)->factor_info().flops);
}

TEST(Mumps, RefusesAnIndefiniteMatrixThatIsSaidToBeDefinite) {
  const SparseMatrix A = random_quasi_definite({4, 4}, 1);
  EXPECT_EQ(message_of<NumericalFailure>([&] { factorized(A, Structure::kDefinite); }),
            "mumps: factorize: the matrix (8 x 8) is not positive definite; use a solver for "
            "quasi-definite or general matrices");
}

TEST(Mumps, RefusesAnUnsymmetricPatternWhereItReadsOneTriangle) {
  const SparseMatrix A = testing::random_block_lower({2, 2}, 1);
  EXPECT_NE(message_of<InvalidInput>([&] {
              factorized(A, Structure::kQuasiDefinite);
            }).find("the pattern is not symmetric"),
            std::string::npos);
}

TEST(Mumps, SolvesWithoutADiagonal) {
  // A cycle: row i has column i + 1 alone, and a little beside it.
  const int size = 30;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, (i + 1) % size, 2.0);
    entries.emplace_back(i, (i + 5) % size, 0.5);
  }
  SparseMatrix A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  const auto solver = factorized(A, Structure::kGeneral);
  const Eigen::VectorXd b = random_dense(size, 1, 1);
  Eigen::VectorXd x(size);
  solver->solve(b, x);
  EXPECT_LT((A * x - b).norm(), 1e-13);
  solver->solve_transposed(b, x);
  EXPECT_LT((A.transpose() * x - b).norm(), 1e-13);
}

TEST(Mumps, RefusesOtherOrderings) {
  EXPECT_EQ(message_of<InvalidInput>(
                [] { static_cast<void>(make_mumps({.ordering = Ordering::kColamd})); }),
            "mumps: the ordering \"colamd\" is not offered; offered: default, natural, amd, metis");
}

}  // namespace
}  // namespace hbar::solvers
