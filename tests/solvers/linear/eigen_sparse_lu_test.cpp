#include "hbar/solvers/linear/eigen_sparse_lu.h"

#include <gtest/gtest.h>

#include "tests/solvers/linear/structured_matrices.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_dense;
using testing::random_sparse;

std::unique_ptr<LinearSolver> factorized(const SparseMatrix& A, const SolverOptions& options) {
  auto solver = make_eigen_sparse_lu(options);
  solver->analyze(A);
  solver->factorize(A);
  return solver;
}

/// A full first row and column, and a diagonal: in the natural order everything fills in.
SparseMatrix arrow(int size) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 2.0 * size);
    if (i > 0) {
      entries.emplace_back(i, 0, 1.0);
    }
    if (i > 0) {
      entries.emplace_back(0, i, 1.0);
    }
  }
  SparseMatrix A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

TEST(EigenSparseLu, MinimumDegreeHasNoFillWhereThereNeedBeNone) {
  const SparseMatrix A = arrow(60);
  EXPECT_GE(factorized(A, {.ordering = Ordering::kNatural})->factor_info().entries, 3600.0);
  EXPECT_LT(factorized(A, {.ordering = Ordering::kAmd})->factor_info().entries, 400.0);
}

TEST(EigenSparseLu, MinimumDegreeStaysSmallOnAGrid) {
  // Laplace's equation on a square: the inverse of a good order is about as bad as none.
  const int side = 24;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < side * side; ++i) {
    entries.emplace_back(i, i, 4.5);
    for (const int j : {i + 1, i + side}) {
      if (j >= side * side || (j == i + 1 && j % side == 0)) {
        continue;
      }
      entries.emplace_back(i, j, -1.0);
      entries.emplace_back(j, i, -1.0);
    }
  }
  SparseMatrix A(side * side, side * side);
  A.setFromTriplets(entries.begin(), entries.end());
  const double natural = factorized(A, {.ordering = Ordering::kNatural})->factor_info().entries;
  const double amd = factorized(A, {.ordering = Ordering::kAmd})->factor_info().entries;
  EXPECT_LT(amd, 0.6 * natural);
}

TEST(EigenSparseLu, CountsInEitherWidthToTheSameBits) {
  const SparseMatrix A = random_sparse(80, 4, 3);
  const Eigen::VectorXd b = random_dense(80, 1, 1);
  for (const Ordering ordering : {Ordering::kNatural, Ordering::kAmd, Ordering::kColamd}) {
    Eigen::VectorXd narrow(80);
    Eigen::VectorXd wide(80);
    factorized(A, {.ordering = ordering})->solve(b, narrow);
    factorized(A, {.ordering = ordering, .index_width = IndexWidth::k64})->solve(b, wide);
    EXPECT_EQ(narrow, wide);
  }
}

TEST(EigenSparseLu, NamesAColumnThatBecomesZero) {
  Eigen::MatrixXd dense(3, 3);
  dense << 1.0, 2.0, 3.0, 4.0, 8.0, 1.0, 2.0, 4.0, 1.0;
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  const auto solver = make_eigen_sparse_lu({.ordering = Ordering::kNatural});
  solver->name_unknowns([](int index) { return concat("number ", index); });
  solver->analyze(A);
  const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
  EXPECT_NE(message.find("column 1 (number 1) is 0;"), std::string::npos) << message;
  EXPECT_EQ(solver->factor_info().entries, 0.0);
}

TEST(EigenSparseLu, RefusesOtherOrderings) {
  EXPECT_EQ(message_of<InvalidInput>(
                [] { static_cast<void>(make_eigen_sparse_lu({.ordering = Ordering::kMetis})); }),
            "eigen_sparse_lu: the ordering \"metis\" is not offered; offered: default, natural, "
            "amd, colamd");
}

}  // namespace
}  // namespace hbar::solvers
