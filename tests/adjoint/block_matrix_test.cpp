#include "hbar/adjoint/block_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/adjoint/small_problems.h"

namespace hbar {
namespace {

TEST(TreePattern, CouplesWhatIsOnOnePathAndNothingElse) {
  const Model model = testing::small_model();
  const Tree& tree = model.tree();
  const auto pattern = tree_pattern(tree);
  for (int c = 0; c < tree.dof(); ++c) {
    std::vector<int> expected;
    for (int l = 0; l < tree.dof(); ++l) {
      const int a = tree.node_of(l);
      const int b = tree.node_of(c);
      if (tree.is_on_path(a, b) || tree.is_on_path(b, a)) {
        expected.push_back(l);
      }
    }
    EXPECT_EQ(pattern[static_cast<std::size_t>(c)], expected) << c;
  }
  const int arm = model.coordinates_of_link(model.find_link("arm")).begin;
  const int weight = model.coordinates_of_link(model.find_link("weight")).begin;
  const auto& of_arm = pattern[static_cast<std::size_t>(arm)];
  EXPECT_EQ(std::count(of_arm.begin(), of_arm.end(), weight), 0);
}

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
