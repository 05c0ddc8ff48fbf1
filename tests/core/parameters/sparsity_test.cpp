#include "hbar/core/parameters/sparsity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/core/parameters/two_limbs.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using testing::Random;

/// Whether two coordinates lie on one path.
bool related(const Model& model, int a, int b) {
  const Tree& tree = model.tree();
  return tree.is_on_path(tree.node_of(a), tree.node_of(b)) ||
         tree.is_on_path(tree.node_of(b), tree.node_of(a));
}

/// Whether a coordinate moves a link's body.
bool moves(const Model& model, int l, int link) {
  return link >= 0 && model.tree().is_on_path(model.tree().node_of(l), model.node_of_link(link));
}

class EveryModelsPattern : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Nonzeros of the Newton matrix over random points, by dual numbers.
  MatrixXd nonzeros(const Model& model, int points) {
    const auto constants = nominal_mechanism<Dual>(model);
    StageResidual<Dual> stage(model);
    MatrixXd sum = MatrixXd::Zero(model.dof(), model.dof());
    for (int k = 0; k < points; ++k) {
      const StagePoint<Dual> at = testing::as_dual(model, testing::random_point(model, random));
      sum += testing::dual_jacobian(
                 [&](const VectorX<Dual>& x) -> VectorX<Dual> {
                   StagePoint<Dual> moved = at;
                   moved.q += x;
                   moved.qdot += 3.0 * x;
                   moved.a += 7.0 * x;
                   VectorX<Dual> out = VectorX<Dual>::Zero(model.dof());
                   stage.residual(constants, moved, out);
                   return out;
                 },
                 Eigen::VectorXd::Zero(model.dof()))
                 .cwiseAbs();
    }
    return sum;
  }

  Random random{GetParam()};
};

TEST_P(EveryModelsPattern, OfItsTreeCouplesWhatIsOnOnePathAndNothingElse) {
  const Model model = testing::random_model(GetParam());
  const auto pattern = tree_pattern(model.tree());
  ASSERT_EQ(pattern.size(), static_cast<std::size_t>(model.dof()));
  for (int c = 0; c < model.dof(); ++c) {
    std::vector<int> expected;
    for (int l = 0; l < model.dof(); ++l) {
      if (related(model, l, c)) {
        expected.push_back(l);
      }
    }
    EXPECT_EQ(pattern[static_cast<std::size_t>(c)], expected) << c;
  }
  EXPECT_EQ(residual_pattern(model), pattern);
}

TEST_P(EveryModelsPattern, HoldsEveryNonzeroThatDualsFind) {
  const Model model = testing::random_contact_model(GetParam());
  const auto pattern = residual_pattern(model);
  const auto tree = tree_pattern(model.tree());
  const MatrixXd found = nonzeros(model, 8);
  int beyond_the_tree = 0;
  for (int c = 0; c < model.dof(); ++c) {
    const std::vector<int>& rows = pattern[static_cast<std::size_t>(c)];
    const std::vector<int>& own = tree[static_cast<std::size_t>(c)];
    for (int l = 0; l < model.dof(); ++l) {
      if (found(l, c) != 0.0) {
        EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), l)) << l << ' ' << c;
        beyond_the_tree += std::binary_search(own.begin(), own.end(), l) ? 0 : 1;
      }
    }
  }
  EXPECT_GT(beyond_the_tree, 20);
}

TEST_P(EveryModelsPattern, CouplesDeclaredPairsAndNothingElse) {
  // With one contact: the coordinates that move either body, both ways.
  const Model bare = testing::random_model(GetParam(), true);
  for (const Contact& contact : bare.contacts()) {
    ModelBuilder builder(bare.name());
    for (const Link& link : bare.links()) {
      builder.add_link(link.parent, link.joint, link.body, link.name);
    }
    builder.add_contact(contact);
    const Model model = builder.build();
    const auto pattern = residual_pattern(model);
    const std::vector<int> coupled = coupled_coordinates(model, model.contact(0));
    EXPECT_TRUE(std::is_sorted(coupled.begin(), coupled.end()));
    for (int c = 0; c < model.dof(); ++c) {
      const auto is_coupled = [&](int l) {
        return moves(model, l, contact.link) || moves(model, l, contact.other);
      };
      EXPECT_EQ(std::binary_search(coupled.begin(), coupled.end(), c), is_coupled(c));
      std::vector<int> expected;
      for (int l = 0; l < model.dof(); ++l) {
        if (related(model, l, c) || (is_coupled(l) && is_coupled(c))) {
          expected.push_back(l);
        }
      }
      EXPECT_EQ(pattern[static_cast<std::size_t>(c)], expected) << contact.name << ' ' << c;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsPattern, ::testing::Values(1U, 2U, 3U));

TEST(ResidualPattern, IsAsWorkedOutByHand) {
  using Pattern = std::vector<std::vector<int>>;
  const Model model = testing::two_limbs();
  EXPECT_EQ(tree_pattern(model.tree()),
            (Pattern{{0, 1, 2}, {0, 1}, {0, 2}, {3, 4, 5}, {3, 4, 5}, {3, 4, 5}}));
  EXPECT_EQ(residual_pattern(model), (Pattern{{0, 1, 2, 3, 4, 5},
                                              {0, 1, 3, 4, 5},
                                              {0, 2},
                                              {0, 1, 3, 4, 5},
                                              {0, 1, 3, 4, 5},
                                              {0, 1, 3, 4, 5}}));
  EXPECT_EQ(coupled_coordinates(model, model.contact(0)), (std::vector<int>{0, 1, 3, 4, 5}));
  EXPECT_EQ(coupled_coordinates(model, model.contact(1)), (std::vector<int>{3, 4, 5}));
}

}  // namespace
}  // namespace hbar
