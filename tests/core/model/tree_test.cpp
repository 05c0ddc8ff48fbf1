#include "hbar/core/model/tree.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/random_model.h"

namespace hbar {
namespace {

/// Nodes from a node to the world, itself first.
std::vector<int> path(const Tree& tree, int i) {
  std::vector<int> out;
  for (; i >= 0; i = tree.node(i).parent) {
    out.push_back(i);
  }
  return out;
}

std::vector<CoordinateRange> ancestors(const Tree& tree, int i) {
  std::vector<CoordinateRange> out;
  for (const CoordinateRange& range : tree.ancestors(i)) {
    out.push_back(range);
  }
  return out;
}

class EveryRandomTree : public ::testing::TestWithParam<unsigned> {
 protected:
  const Model model = testing::random_model(GetParam());
  const Tree& tree = model.tree();
};

TEST_P(EveryRandomTree, ListsParentsBeforeChildrenAndCoordinatesInFileOrder) {
  int next_coordinate = 0;
  int link = 0;
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    EXPECT_LT(node.parent, i);
    EXPECT_EQ(node.coordinates.begin, next_coordinate);
    EXPECT_EQ(node.coordinates.end - node.coordinates.begin, motion_dof(node.motion));
    next_coordinate = node.coordinates.end;
    EXPECT_EQ(node.link, link);
    EXPECT_EQ(node.first, i == 0 || tree.node(i - 1).last);
    if (node.first) {
      const int parent = model.link(link).parent;
      EXPECT_EQ(node.parent, parent < 0 ? -1 : model.node_of_link(parent));
    } else {
      EXPECT_EQ(node.parent, i - 1);
    }
    if (node.last) {
      EXPECT_EQ(model.node_of_link(link), i);
      ++link;
    }
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      EXPECT_EQ(tree.node_of(c), i);
    }
  }
  EXPECT_EQ(next_coordinate, tree.dof());
  EXPECT_EQ(link, model.link_count());
}

TEST_P(EveryRandomTree, KnowsTheCoordinatesAboveANodeAsMaximalDescendingRanges) {
  for (int i = 0; i < tree.node_count(); ++i) {
    std::set<int> expected;
    for (const int above : path(tree, i)) {
      const CoordinateRange range = tree.node(above).coordinates;
      for (int c = range.begin; above != i && c < range.end; ++c) {
        expected.insert(c);
      }
    }
    std::set<int> found;
    int last_begin = tree.dof() + 1;
    for (const CoordinateRange& range : tree.ancestors(i)) {
      EXPECT_LT(range.begin, range.end);
      EXPECT_LT(range.end, last_begin) << "ranges that touch are one";
      last_begin = range.begin;
      for (int c = range.begin; c < range.end; ++c) {
        found.insert(c);
      }
    }
    EXPECT_EQ(found, expected) << "node " << i;
  }
}

TEST_P(EveryRandomTree, KnowsWhoIsOnWhosePath) {
  for (int below = 0; below < tree.node_count(); ++below) {
    const std::vector<int> on_path = path(tree, below);
    for (int above = 0; above < tree.node_count(); ++above) {
      const bool expected = std::find(on_path.begin(), on_path.end(), above) != on_path.end();
      EXPECT_EQ(tree.is_on_path(above, below), expected) << above << ' ' << below;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryRandomTree, ::testing::Range(1U, 6U));

TEST(Tree, MakesOneNodeOfAFixedJointAndAChainOfOthers) {
  Tree tree;
  EXPECT_EQ(tree.add_joint(FixedJoint{}, -1, 0), 0);
  EXPECT_EQ(tree.dof(), 0);
  EXPECT_EQ(tree.add_joint(Free3dExpJoint{}, 0, 1), 4);
  EXPECT_EQ(tree.dof(), 6);
  EXPECT_EQ(tree.node(4).motion, MotionKind::kExponential);
  EXPECT_EQ(ancestors(tree, 4), (std::vector<CoordinateRange>{{0, 3}}));
  EXPECT_EQ(tree.add_joint(RevoluteJoint{}, 0, 2), 5);
  EXPECT_TRUE(tree.ancestors(5).empty());
  EXPECT_EQ(tree.add_joint(RevoluteJoint{}, 4, 3), 6);
  EXPECT_EQ(ancestors(tree, 6), (std::vector<CoordinateRange>{{0, 6}}));
}

TEST(Tree, OfASpineWithRibsTakesMemoryInProportionToItsNodes) {
  // Every rib splits the spine's coordinates: with a list of its own, each of these nodes would
  // have thousands of ranges.
  Tree tree;
  constexpr int kSpine = 50'000;
  int spine = -1;
  for (int i = 0; i < kSpine; ++i) {
    const int below = tree.add_joint(RevoluteJoint{}, spine, 2 * i);
    tree.add_joint(RevoluteJoint{}, spine, 2 * i + 1);
    spine = below;
  }
  const std::vector<CoordinateRange> above = ancestors(tree, spine);
  ASSERT_EQ(above.size(), static_cast<std::size_t>(kSpine - 1));
  EXPECT_EQ(above.front(), (CoordinateRange{2 * kSpine - 4, 2 * kSpine - 3}));
  EXPECT_EQ(above.back(), (CoordinateRange{0, 1}));
}

}  // namespace
}  // namespace hbar
