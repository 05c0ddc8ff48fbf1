#include "hbar/solvers/linear/spqr.h"

#include <gtest/gtest.h>

#include "hbar/solvers/linear/klu.h"
#include "tests/solvers/linear/solver_checks.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::arrow_matrix;
using testing::expect_agrees_with_dense;
using testing::factorized;
using testing::message_of;
using testing::nearly_identity;
using testing::options_of;
using testing::random_block_lower;
using testing::random_sparse;

constexpr auto kOrderingsOfSpqr = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                                   Ordering::kColamd, Ordering::kMetis};

TEST(Spqr, AgreesWithDenseLuInEveryOrdering) {
  for (const Ordering ordering : kOrderingsOfSpqr) {
    for (const IndexWidth width : {IndexWidth::k32, IndexWidth::k64}) {
      SCOPED_TRACE(name_of(ordering));
      for (const SparseMatrix& A :
           {random_sparse(60, 3, 1), random_block_lower({4, 1, 7, 12, 3}, 2),
            random_block_lower({20}, 3), nearly_identity(1, {})}) {
        const auto solver = factorized(make_spqr, options_of(ordering, width), A);
        EXPECT_EQ(solver->name(), "spqr");
        expect_agrees_with_dense(*solver, A);
      }
    }
  }
}

TEST(Spqr, ServesNewValuesAndNewPatterns) {
  const SparseMatrix A = random_sparse(60, 3, 1);
  SparseMatrix B = A;
  B.diagonal() *= -1.5;
  SparseMatrix zero = A;
  zero.coeffs().setZero();
  for (const Ordering ordering : kOrderingsOfSpqr) {
    const auto solver = make_spqr(options_of(ordering));
    testing::expect_serves_again(*solver, A, B, zero, random_sparse(90, 2, 1));
  }
}

TEST(Spqr, HeedsTheOrdering) {
  testing::expect_heeds_ordering(
      make_spqr, random_sparse(100, 3, 1),
      {Ordering::kNatural, Ordering::kAmd, Ordering::kColamd, Ordering::kMetis}, Ordering::kColamd);
}

TEST(Spqr, FillsAnArrowLessByMinimumDegree) {
  // AᵀA of this one is an arrow that points up; R has its pattern.
  const int n = 300;
  const SparseMatrix A = arrow_matrix(n).triangularView<Eigen::Lower>();
  const FactorInfo natural =
      factorized(make_spqr, options_of(Ordering::kNatural), A)->factor_info();
  const FactorInfo amd = factorized(make_spqr, options_of(Ordering::kAmd), A)->factor_info();
  EXPECT_GE(natural.entries, n * (n + 1) / 2.0);
  EXPECT_GE(amd.entries, 2 * n - 1);
  EXPECT_LT(amd.entries, 0.1 * natural.entries);
  EXPECT_LT(amd.bytes, 0.5 * natural.bytes);
  ASSERT_TRUE(natural.flops && amd.flops);
  EXPECT_GT(*amd.flops, n);
  EXPECT_LT(*amd.flops, 0.1 * *natural.flops);
  EXPECT_FALSE(natural.inertia);
}

TEST(Spqr, DoesNotCareForTheUnitsOfRowsAndColumns) {
  const SparseMatrix A = random_sparse(40, 3, 5);
  Eigen::VectorXd scale(A.rows());
  for (int i = 0; i < scale.size(); ++i) {
    scale[i] = std::pow(10.0, i % 7 - 3);
  }
  for (const System system : {System::kPlain, System::kTransposed}) {
    for (const bool rows : {true, false}) {
      const SparseMatrix B =
          rows ? SparseMatrix(scale.asDiagonal() * A) : SparseMatrix(A * scale.asDiagonal());
      const auto solver = factorized(make_spqr, {}, B);
      const Eigen::VectorXd expected = testing::random_dense(40, 1, 6);
      const Eigen::VectorXd b = system == System::kPlain
                                    ? Eigen::VectorXd(B * expected)
                                    : Eigen::VectorXd(B.transpose() * expected);
      Eigen::VectorXd x(40);
      solver->solve(system, b, x);
      EXPECT_LT((x - expected).norm(), 1e-9);
    }
  }
  Eigen::VectorXd extreme(A.rows());
  for (int i = 0; i < extreme.size(); ++i) {
    extreme[i] = std::pow(10.0, 30 * (i % 3 - 1));
  }
  EXPECT_NO_THROW((void)factorized(make_spqr, {}, SparseMatrix(extreme.asDiagonal() * A)));
  Eigen::VectorXd one_tiny = Eigen::VectorXd::Ones(A.cols());
  one_tiny[5] = 1e-20;
  EXPECT_NO_THROW((void)factorized(make_spqr, {}, SparseMatrix(A * one_tiny.asDiagonal())));
}

TEST(Spqr, NamesTheColumnOfASingularMatrix) {
  // Columns 11 and 12 are alike: whichever comes last depends on the other.
  const SparseMatrix A =
      nearly_identity(30, {{11, 12, 0.5}, {12, 11, 1.0}, {11, 11, 0.5}, {12, 12, 1.0}});
  for (const Ordering ordering : kOrderingsOfSpqr) {
    const auto solver = make_spqr(options_of(ordering));
    solver->name_unknowns([](int index) { return concat("joint ", index); });
    solver->analyze(A);
    const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
    const std::string before =
        "spqr: factorize: the matrix (30 x 30) is singular to working precision: the pivot in row ";
    EXPECT_EQ(message.substr(0, before.size()), before);
    EXPECT_TRUE(message.find("column 11 (joint 11)") != std::string::npos ||
                message.find("column 12 (joint 12)") != std::string::npos)
        << message;
  }
  const auto solver = make_spqr(options_of(Ordering::kNatural));
  solver->analyze(A);
  EXPECT_NE(message_of<NumericalFailure>([&] { solver->factorize(A); }).find("column 12"),
            std::string::npos);
}

TEST(Spqr, RefusesADependenceThatRoundingHides) {
  // Column 7 is a sum of the others; then each gets a unit of its own, without rounding.
  Eigen::MatrixXd dense(random_block_lower({12}, 8));
  dense.col(7).setZero();
  dense.col(7) = dense.rowwise().sum();
  for (int j = 0; j < 12; ++j) {
    dense.col(j) *= std::pow(2.0, 5 * (j % 5 - 2));
  }
  const SparseMatrix A = dense.sparseView();
  for (const Ordering ordering : kOrderingsOfSpqr) {
    EXPECT_THROW((void)factorized(make_spqr, options_of(ordering), A), NumericalFailure);
  }
}

TEST(Spqr, RefusesAStructurallySingularMatrix) {
  // Rows 1 and 2 have their only entries in column 0.
  Eigen::Matrix3d dense = Eigen::Matrix3d::Zero();
  dense.row(0).setOnes();
  dense.col(0).setOnes();
  const SparseMatrix A = dense.sparseView();
  for (const Ordering ordering : kOrderingsOfSpqr) {
    EXPECT_THROW((void)factorized(make_spqr, options_of(ordering), A), NumericalFailure);
  }
}

TEST(Spqr, SolvesWhatIsIllConditioned) {
  const SparseMatrix A = testing::hilbert_matrix(8);  // condition 2e10
  const auto solver = factorized(make_spqr, {}, A);
  Eigen::VectorXd x(8);
  for (const System system : {System::kPlain, System::kTransposed}) {
    solver->solve(system, Eigen::VectorXd::Ones(8), x);
  }
  EXPECT_LT(solver->statistics().worst_residual, 1e-14);
}

TEST(Spqr, NamesTheOrderingsItOffers) {
  EXPECT_EQ(message_of<InvalidInput>([] { (void)make_spqr(options_of(Ordering::kNested)); }),
            "spqr: the ordering \"nested\" is not offered; offered: default, natural, amd, colamd, "
            "metis");
}

TEST(Spqr, GivesTheSameBitsInTwoThreads) {
  testing::expect_the_same_in_two_threads(make_spqr, {}, random_sparse(100, 3, 3));
  testing::expect_the_same_in_two_threads(make_spqr, options_of(Ordering::kMetis),
                                          random_sparse(400, 1, 3));
}

}  // namespace
}  // namespace hbar::solvers
