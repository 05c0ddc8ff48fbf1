#include "hbar/solvers/linear/accuracy.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "hbar/solvers/linear/klu.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_block_lower;
using testing::random_dense;
using testing::random_sparse;
using testing::sparse_of;

std::unique_ptr<LinearSolver> factorized(const SparseMatrix& A) {
  auto solver = make_klu();
  solver->analyze(A);
  solver->factorize(A);
  return solver;
}

/// A Hilbert matrix times the least common multiple of its denominators: its entries are whole.
Eigen::MatrixXd whole_hilbert(int n, double multiple) {
  Eigen::MatrixXd H(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      H(i, j) = multiple / (i + j + 1);
    }
  }
  return H;
}

TEST(BackwardErrors, AreThoseOfAHandComputedExample) {
  const SparseMatrix A = sparse_of((Eigen::MatrixXd(2, 2) << 1.0, 2.0, 3.0, 4.0).finished());
  const Eigen::VectorXd x = Eigen::Vector2d(1.0, -1.0);
  const Eigen::VectorXd b = Eigen::Vector2d(0.0, 1.0);
  // b − A x = (1, 2) and b − Aᵀ x = (2, 3); ‖A‖∞ = 7, ‖Aᵀ‖∞ = 6.
  EXPECT_DOUBLE_EQ(normwise_backward_error(A, System::kPlain, x, b), 2.0 / 8.0);
  EXPECT_DOUBLE_EQ(normwise_backward_error(A, System::kTransposed, x, b), 3.0 / 7.0);
  EXPECT_DOUBLE_EQ(componentwise_backward_error(A, System::kPlain, x, b), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(componentwise_backward_error(A, System::kTransposed, x, b), 2.0 / 4.0);
}

TEST(BackwardErrors, AreZeroWhereNothingIsWrong) {
  const SparseMatrix A = sparse_of(Eigen::MatrixXd::Identity(3, 3) * 2.0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(3);
  const Eigen::VectorXd b = Eigen::Vector3d(2.0, 0.0, 4.0);
  EXPECT_EQ(normwise_backward_error(A, System::kPlain, zero, zero), 0.0);
  EXPECT_EQ(componentwise_backward_error(A, System::kPlain, zero, zero), 0.0);
  EXPECT_EQ(componentwise_backward_error(A, System::kPlain, 0.5 * b, b), 0.0);
}

TEST(BackwardErrors, FollowTheSizeOfTheError) {
  const SparseMatrix A = random_sparse(40, 3, 1);
  const Eigen::VectorXd b = random_dense(40, 1, 2);
  Eigen::VectorXd x(40);
  factorized(A)->solve(b, x);
  EXPECT_LT(normwise_backward_error(A, System::kPlain, x, b), 1e-15);
  EXPECT_LT(componentwise_backward_error(A, System::kPlain, x, b), 1e-13);
  x[7] *= 1.0 + 1e-6;
  EXPECT_GT(normwise_backward_error(A, System::kPlain, x, b), 1e-9);
  EXPECT_GT(componentwise_backward_error(A, System::kPlain, x, b), 1e-8);
  // Seen by entries alone: a tiny row that is not solved.
  SparseMatrix scaled = A;
  scaled = Eigen::VectorXd::Unit(40, 7)
               .unaryExpr([](double unit) { return unit > 0.0 ? 1e-20 : 1.0; })
               .asDiagonal() *
           A;
  Eigen::VectorXd rhs = b;
  rhs[7] = 0.0;
  EXPECT_LT(normwise_backward_error(scaled, System::kPlain, Eigen::VectorXd::Ones(40),
                                    scaled * Eigen::VectorXd::Ones(40)),
            1e-15);
  Eigen::VectorXd wrong = scaled * Eigen::VectorXd::Ones(40);
  wrong[7] = 1e-20 * 123.0;
  EXPECT_LT(normwise_backward_error(scaled, System::kPlain, Eigen::VectorXd::Ones(40), wrong),
            1e-15);
  EXPECT_GT(componentwise_backward_error(scaled, System::kPlain, Eigen::VectorXd::Ones(40), wrong),
            0.1);
}

TEST(BackwardErrors, ShowSolutionsThatAreNotNumbers) {
  const SparseMatrix A = sparse_of(Eigen::MatrixXd::Identity(2, 2));
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(2);
  const Eigen::VectorXd x = Eigen::Vector2d(1.0, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(normwise_backward_error(A, System::kPlain, x, b)));
  EXPECT_TRUE(std::isnan(componentwise_backward_error(A, System::kPlain, x, b)));
}

TEST(BackwardErrors, RefuseShapesThatDisagree) {
  const SparseMatrix A = sparse_of(Eigen::MatrixXd::Identity(2, 2));
  EXPECT_EQ(message_of<InvalidInput>([&] {
              static_cast<void>(normwise_backward_error(A, System::kPlain, Eigen::VectorXd(3),
                                                        Eigen::VectorXd(2)));
            }),
            "normwise_backward_error: the matrix is 2 x 2, x has 3 and b 2 rows; expected a square "
            "matrix and as many rows");
  EXPECT_THROW(static_cast<void>(componentwise_backward_error(A, System::kPlain, Eigen::VectorXd(2),
                                                              Eigen::VectorXd(1))),
               InvalidInput);
}

TEST(RefinedSolution, IsRightToTheLastDigitWhereAPlainOneIsNot) {
  // 360360 = lcm(1 … 15); the condition number of the 8 x 8 Hilbert matrix is 3e10. The solution is
  // known since entries, solution and right-hand side are whole numbers, exact in a double.
  const Eigen::MatrixXd H = whole_hilbert(8, 360360.0);
  const Eigen::VectorXd exact = (Eigen::VectorXd(8) << 1, -2, 3, -4, 5, -6, 7, -8).finished();
  const Eigen::VectorXd b = H * exact;
  const SparseMatrix A = sparse_of(H);
  const auto solver = factorized(A);
  Eigen::VectorXd plain(8);
  solver->solve(b, plain);
  EXPECT_GT((plain - exact).lpNorm<Eigen::Infinity>(), 1e-9) << "or the test shows nothing";
  EXPECT_LE((refined_solution(*solver, A, b) - exact).lpNorm<Eigen::Infinity>(), 1e-15);
}

TEST(RefinedSolution, AgreesWithLongDoubles) {
  const SparseMatrix A = random_block_lower({4, 1, 7, 12}, 3);
  const Eigen::VectorXd b = random_dense(24, 1, 5);
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Long dense = Eigen::MatrixXd(A).cast<long double>();
  const Eigen::VectorXd expected =
      dense.fullPivLu().solve(Long(b.cast<long double>())).cast<double>();
  const Eigen::VectorXd x = refined_solution(*factorized(A), A, b);
  EXPECT_LE((x - expected).lpNorm<Eigen::Infinity>(), 3e-16 * expected.lpNorm<Eigen::Infinity>());
}

TEST(RefinedSolution, OfNothingIsNothing) {
  const SparseMatrix A = random_block_lower({4}, 3);
  EXPECT_EQ(refined_solution(*factorized(A), A, Eigen::VectorXd::Zero(4)).norm(), 0.0);
  EXPECT_THROW(static_cast<void>(refined_solution(*factorized(A), A, Eigen::VectorXd::Zero(5))),
               InvalidInput);
}

double true_condition(const SparseMatrix& A) {
  const Eigen::MatrixXd dense(A);
  const Eigen::MatrixXd inverse = dense.fullPivLu().inverse();
  return dense.cwiseAbs().colwise().sum().maxCoeff() *
         inverse.cwiseAbs().colwise().sum().maxCoeff();
}

TEST(EstimateCondition, IsALowerBoundWithinAFactorOfThree) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const SparseMatrix A =
        seed % 2 == 0 ? random_sparse(50, 4, seed) : random_block_lower({4, 1, 7, 12, 6}, seed);
    const double estimate = estimate_condition(*factorized(A), A);
    const double expected = true_condition(A);
    EXPECT_LE(estimate, expected * (1.0 + 1e-10));
    EXPECT_GE(estimate, expected / 3.0) << seed;
  }
}

TEST(EstimateCondition, KnowsHilbertMatrices) {
  // Of the 1-norm, as in Higham, Accuracy and Stability of Numerical Algorithms: for n = 2 and 3
  // 27 and 748, for n = 6 about 2.907e7.
  for (const auto& [n, expected] : {std::pair{2, 27.0}, {3, 748.0}, {6, 2.907e7}}) {
    const SparseMatrix A = sparse_of(whole_hilbert(n, 360360.0));
    EXPECT_NEAR(estimate_condition(*factorized(A), A), expected, 2e-4 * expected);
  }
}

TEST(EstimateCondition, IsNotFooledByCancellation) {
  // The ascent alone starts at the mean of the columns, which is zero for this inverse.
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(6, 6);
  for (int j = 0; j < 6; ++j) {
    inverse(0, j) = j % 2 == 0 ? 1e6 : -1e6;
  }
  const SparseMatrix A = sparse_of(inverse.inverse());
  EXPECT_GE(estimate_condition(*factorized(A), A), true_condition(A) / 3.0);
}

TEST(EstimateCondition, OfANumberIsOne) {
  const SparseMatrix A = sparse_of(Eigen::MatrixXd::Constant(1, 1, -5.0));
  EXPECT_DOUBLE_EQ(estimate_condition(*factorized(A), A), 1.0);
}

}  // namespace
}  // namespace hbar::solvers
