#include "hbar/solvers/linear/block_substitution.h"

#include <gtest/gtest.h>

#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_block_lower;
using testing::random_dense;

TEST(BlockSubstitution, RefusesSizesThatAreNotPositive) {
  EXPECT_EQ(message_of<InvalidInput>([] { BlockSubstitution solver({}); }),
            "block_substitution: no block sizes; expected at least one");
  EXPECT_EQ(message_of<InvalidInput>([] {
              BlockSubstitution solver({2, 0});
            }),
            "block_substitution: block 1 has size 0; expected a positive number");
}

TEST(BlockSubstitution, RefusesEntriesAboveTheBlockDiagonal) {
  const SparseMatrix upper = random_block_lower({2, 3, 2}, 1).transpose();
  BlockSubstitution solver({2, 3, 2});
  EXPECT_EQ(message_of<InvalidInput>([&] { solver.analyze(upper); }),
            "block_substitution: analyze: the entry in row 0, column 2 is above the block diagonal "
            "(block row 0, block column 1); use klu or umfpack for such a matrix");
}

TEST(BlockSubstitution, RefusesAMatrixOfAnotherSize) {
  BlockSubstitution solver({2, 3});
  EXPECT_EQ(message_of<InvalidInput>([&] {
              solver.analyze(random_block_lower({2, 2}, 1));
            }),
            "block_substitution: analyze: the blocks have 5 rows in all, the matrix has 4");
}

TEST(BlockSubstitution, NamesTheSingularBlock) {
  SparseMatrix A = random_block_lower({2, 2}, 1);
  A.coeffRef(2, 2) = 0.0;
  A.coeffRef(3, 2) = 0.0;
  BlockSubstitution solver({2, 2});
  solver.analyze(A);
  const std::string message = message_of<NumericalFailure>([&] { solver.factorize(A); });
  EXPECT_NE(message.find("diagonal block 1 of 2 (2 x 2) is singular"), std::string::npos)
      << message;
  EXPECT_NE(message.find("column 2 is 0;"), std::string::npos) << message;
}

TEST(BlockSubstitution, AdoptsFactorsForOneFactorisation) {
  const SparseMatrix A = random_block_lower({3, 4}, 1);
  const Eigen::MatrixXd dense(A);
  const Eigen::VectorXd b = random_dense(7, 1, 2);
  BlockSubstitution solver({3, 4});
  Eigen::VectorXd expected(7);
  Eigen::VectorXd x(7);
  solver.analyze(A);
  solver.factorize(A);
  solver.solve(b, expected);
  solver.adopt_factors(1, BlockFactors(dense.bottomRightCorner(4, 4)));
  solver.factorize(A);
  solver.solve(b, x);
  EXPECT_EQ(x, expected);
  // Factors of a nearby block are refined; those of another block are rejected by the residual.
  solver.adopt_factors(1, BlockFactors((1.0 + 1e-7) * dense.bottomRightCorner(4, 4)));
  solver.factorize(A);
  solver.solve(b, x);
  EXPECT_LT((x - expected).norm(), 1e-12);
  solver.adopt_factors(1, BlockFactors(2.0 * dense.bottomRightCorner(4, 4)));
  solver.factorize(A);
  EXPECT_THROW(solver.solve(b, x), NumericalFailure);
  solver.factorize(A);
  solver.solve(b, x);
  EXPECT_EQ(x, expected) << "adopted factors must serve one factorisation only";
}

TEST(BlockSubstitution, RefusesFactorsThatDoNotFit) {
  BlockSubstitution solver({3, 4});
  const BlockFactors factors(Eigen::MatrixXd::Identity(3, 3));
  EXPECT_EQ(message_of<InvalidInput>([&] { solver.adopt_factors(2, factors); }),
            "block_substitution: adopt_factors: there is no block 2; blocks are 0 to 1");
  EXPECT_EQ(message_of<InvalidInput>([&] { solver.adopt_factors(1, factors); }),
            "block_substitution: adopt_factors: block 1 has size 4, the factors 3");
}

}  // namespace
}  // namespace hbar::solvers
