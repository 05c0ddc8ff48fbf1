#include "hbar/solvers/klu.h"

#include <gtest/gtest.h>

#include "tests/solvers/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_sparse;

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
