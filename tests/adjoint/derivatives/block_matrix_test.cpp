#include "hbar/adjoint/derivatives/block_matrix.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace hbar {
namespace {

TEST(BlockMatrix, HoldsItsBlocksWherePatternAndPlaceSay) {
  const std::vector<std::vector<int>> pattern = {{0, 1}, {1}};
  BlockMatrix matrix(3, 2, {{0, 0}, {1, 0}, {2, 1}}, pattern);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 4);
  const std::vector<std::pair<int, int>> places = {{0, 0}, {1, 0}, {2, 1}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Random(2, 2);
    matrix.set_block(i, block);
    block(0, 1) = 0.0;  // outside the pattern
    expected.block(2 * places[i].first, 2 * places[i].second, 2, 2) = block;
  }
  EXPECT_EQ(Eigen::MatrixXd(matrix.matrix()), expected);
  EXPECT_EQ(matrix.matrix().nonZeros(), 9);
  EXPECT_TRUE(matrix.matrix().isCompressed());
}

TEST(ZerosWithPattern, HasTheRowsItWasGiven) {
  Eigen::VectorXi counts(3);
  counts << 2, 0, 1;
  const solvers::SparseMatrix matrix = zeros_with_pattern(5, counts, [](int column, int* rows) {
    rows[0] = column == 0 ? 1 : 3;
    if (column == 0) {
      rows[1] = 4;
    }
  });
  EXPECT_EQ(matrix.nonZeros(), 3);
  EXPECT_EQ(matrix.rows(), 5);
  EXPECT_EQ(matrix.innerIndexPtr()[1], 4);
  EXPECT_EQ(matrix.innerIndexPtr()[2], 3);
  EXPECT_EQ(Eigen::MatrixXd(matrix).norm(), 0.0);
}

}  // namespace
}  // namespace hbar
