#include "hbar/solvers/linear/lapack_band.h"

#include <gtest/gtest.h>

#include "hbar/solvers/linear/block_banded.h"
#include "tests/solvers/linear/structured_matrices.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_definite;
using testing::random_dense;
using testing::sparse_of;

TEST(LapackBand, AgreesWithBlockBanded) {
  for (const int size : {1, 5, 40}) {
    const SparseMatrix A = random_definite(std::vector<int>(6, size), 2);
    const auto band = make_lapack_band();
    const auto blocks = make_block_banded();
    const Eigen::MatrixXd B = random_dense(6 * size, 3, 1);
    for (const auto& solver : {band.get(), blocks.get()}) {
      solver->analyze(A);
      solver->factorize(A);
    }
    for (const System system : {System::kPlain, System::kTransposed}) {
      Eigen::MatrixXd X(B.rows(), 3);
      Eigen::MatrixXd Y(B.rows(), 3);
      band->solve(system, B, X);
      blocks->solve(system, B, Y);
      EXPECT_LT((X - Y).norm(), 1e-13 * Y.norm());
    }
  }
}

TEST(LapackBand, KeepsABandThatGrowsByTheLowerOne) {
  // One diagonal below, two above: 1 + 2 + 1 + 1 rows.
  Eigen::MatrixXd dense = 4.0 * Eigen::MatrixXd::Identity(6, 6);
  for (int i = 0; i + 1 < 6; ++i) {
    dense(i + 1, i) = 1.0;
  }
  for (int i = 0; i + 2 < 6; ++i) {
    dense(i, i + 2) = 1.0;
  }
  const auto solver = make_lapack_band();
  solver->analyze(sparse_of(dense));
  solver->factorize(sparse_of(dense));
  EXPECT_EQ(solver->factor_info().entries, 30.0);
}

TEST(LapackBand, NamesTheRowThatAPivotWasTakenFrom) {
  // Rows 0 and 2 are interchanged first; then rows 1 and 0 have nothing in column 1.
  Eigen::MatrixXd dense(3, 3);
  dense << 1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 2.0, 4.0, 1.0;
  const auto solver = make_lapack_band();
  solver->name_unknowns([](int index) { return concat("number ", index); });
  solver->analyze(sparse_of(dense));
  const std::string message =
      message_of<NumericalFailure>([&] { solver->factorize(sparse_of(dense)); });
  EXPECT_NE(message.find("the pivot in row 1 (number 1), column 1 (number 1) is 0;"),
            std::string::npos)
      << message;
}

TEST(LapackBand, RefusesABandThatIsNoneAndOrderings) {
  SparseMatrix A(40000, 40000);
  A.setIdentity();
  A.insert(39999, 0) = 1.0;
  A.makeCompressed();
  const std::string message = message_of<InvalidInput>([&] { make_lapack_band()->analyze(A); });
  EXPECT_NE(message.find("lapack_band: analyze: the band of the 40000 x 40000 matrix would take "),
            std::string::npos)
      << message;
  EXPECT_EQ(message_of<InvalidInput>(
                [] { static_cast<void>(make_lapack_band({.ordering = Ordering::kMetis})); }),
            "lapack_band: the ordering \"metis\" is not offered; offered: default, natural");
}

}  // namespace
}  // namespace hbar::solvers
