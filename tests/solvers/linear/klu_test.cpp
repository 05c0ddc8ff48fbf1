#include "hbar/solvers/linear/klu.h"

#include <gtest/gtest.h>

#include "tests/solvers/linear/solver_checks.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::kWidths;
using testing::message_of;
using testing::options_of;
using testing::random_sparse;

constexpr auto kOrderingsOfKlu = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                                  Ordering::kColamd};

TEST(Klu, AgreesWithDenseLuInEveryOrderingAndWidth) {
  testing::expect_agrees_in_every_ordering(make_klu, kOrderingsOfKlu);
}

TEST(Klu, ServesNewValuesAndNewPatterns) {
  testing::expect_serves_again_in_every_ordering(make_klu, kOrderingsOfKlu);
}

TEST(Klu, HeedsTheOrdering) {
  testing::expect_heeds_ordering(make_klu, random_sparse(400, 3, 1),
                                 {Ordering::kNatural, Ordering::kAmd, Ordering::kColamd},
                                 Ordering::kAmd);
  EXPECT_EQ(message_of<InvalidInput>([] { (void)make_klu(options_of(Ordering::kMetis)); }),
            "klu: the ordering \"metis\" is not offered; offered: default, natural, amd, colamd");
}

TEST(Klu, FillsAnArrowLessByMinimumDegree) {
  const double n = 300.0;
  const SparseMatrix A = testing::arrow_matrix(300);
  for (const IndexWidth width : kWidths) {
    const FactorInfo natural =
        testing::factorized(make_klu, options_of(Ordering::kNatural, width), A)->factor_info();
    const FactorInfo amd =
        testing::factorized(make_klu, options_of(Ordering::kAmd, width), A)->factor_info();
    EXPECT_EQ(natural.entries, n * n);
    EXPECT_EQ(amd.entries, 3.0 * n - 2.0);
    EXPECT_LT(amd.bytes, 0.1 * natural.bytes);
    ASSERT_TRUE(natural.flops && amd.flops);
    EXPECT_EQ(*amd.flops, 3.0 * (n - 1.0));  // a division, a product and a difference each
    EXPECT_NEAR(*natural.flops, 2.0 / 3.0 * n * n * n, 0.01 * *natural.flops);
  }
}

TEST(Klu, FindsTheBlocksOfATriangularMatrixUnlessTheOrderIsGiven) {
  // Below the diagonal blocks nothing has to be eliminated.
  const SparseMatrix A = testing::random_block_lower({6, 6, 6, 6}, 1);
  const auto entries_of = [&A](Ordering ordering) {
    return testing::factorized(make_klu, options_of(ordering), A)->factor_info();
  };
  EXPECT_EQ(entries_of(Ordering::kAmd).entries, static_cast<double>(A.nonZeros()));
  EXPECT_GT(*entries_of(Ordering::kNatural).flops, *entries_of(Ordering::kAmd).flops);
}

TEST(Klu, NamesTheRowAndColumnOfASingularMatrixWithBothWidths) {
  testing::expect_names_what_is_singular(make_klu, kOrderingsOfKlu);
}

TEST(Klu, GivesTheSameBitsInTwoThreads) {
  for (const IndexWidth width : kWidths) {
    testing::expect_the_same_in_two_threads(make_klu, options_of(Ordering::kDefault, width),
                                            random_sparse(100, 3, 3));
  }
}

TEST(Klu, KeepsThePivotOrderWhileItSuitsTheValues) {
  SparseMatrix A = random_sparse(40, 4, 1);
  const auto solver = make_klu();
  solver->analyze(A);
  solver->factorize(A);
  EXPECT_EQ(solver->statistics().refactorizations, 0);
  A.coeffs() *= 1.5;
  solver->factorize(A);
  EXPECT_EQ(solver->statistics().refactorizations, 1);
}

TEST(Klu, ChoosesANewPivotOrderWhereTheOldOneFails) {
  SparseMatrix A = Eigen::MatrixXd::Ones(2, 2).sparseView();
  A.coeffRef(0, 0) = 5.0;
  A.coeffRef(1, 1) = 5.0;
  const auto solver = make_klu();
  solver->analyze(A);
  solver->factorize(A);
  Eigen::VectorXd x(2);
  for (const double diagonal : {0.0, 1e-9}) {
    A.coeffRef(0, 0) = diagonal;
    A.coeffRef(1, 1) = diagonal;
    solver->factorize(A);
    solver->solve(Eigen::Vector2d(1.0, 2.0), x);
    EXPECT_NEAR(x[0], 2.0, 1e-8);
    EXPECT_NEAR(x[1], 1.0, 1e-8);
  }
  EXPECT_EQ(solver->statistics().factorizations, 3);
  EXPECT_LE(solver->statistics().refactorizations, 1);
}

TEST(Klu, RefusesAStructurallySingularMatrix) {
  // Rows 1 and 2 have their only entries in column 0.
  SparseMatrix A(3, 3);
  A.insert(0, 0) = 1.0;
  A.insert(1, 0) = 1.0;
  A.insert(2, 0) = 1.0;
  A.insert(0, 1) = 1.0;
  A.insert(0, 2) = 1.0;
  A.makeCompressed();
  const auto solver = make_klu();
  const std::string message = message_of<NumericalFailure>([&] {
    solver->analyze(A);
    solver->factorize(A);
  });
  EXPECT_NE(message.find("klu: "), std::string::npos);
  EXPECT_NE(message.find("singular"), std::string::npos) << message;
}

}  // namespace
}  // namespace hbar::solvers
