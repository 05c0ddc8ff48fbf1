#include "hbar/solvers/umfpack.h"

#include <gtest/gtest.h>

#include "tests/solvers/random_matrices.h"

namespace hbar::solvers {
namespace {

TEST(Umfpack, RefusesAStructurallySingularMatrix) {
  SparseMatrix A(3, 3);
  A.insert(0, 0) = 1.0;
  A.insert(1, 0) = 1.0;
  A.insert(2, 0) = 1.0;
  A.insert(0, 1) = 1.0;
  A.insert(0, 2) = 1.0;
  A.makeCompressed();
  const auto solver = make_umfpack();
  const std::string message = testing::message_of<NumericalFailure>([&] {
    solver->analyze(A);
    solver->factorize(A);
  });
  EXPECT_NE(message.find("umfpack: factorize: the matrix (3 x 3) is singular"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace hbar::solvers
