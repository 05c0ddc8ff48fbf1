#include "hbar/solvers/linear/solver_options.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;

constexpr std::array kEveryOrdering = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                                       Ordering::kColamd,  Ordering::kMetis,   Ordering::kNested};

TEST(SolverOptions, OrderingsAreFoundByTheirNames) {
  std::set<std::string_view> names;
  for (const Ordering ordering : kEveryOrdering) {
    EXPECT_EQ(find_ordering(name_of(ordering)), ordering);
    names.insert(name_of(ordering));
  }
  EXPECT_EQ(names.size(), kEveryOrdering.size());
  EXPECT_EQ(name_of(Ordering::kNested), "nested");
}

TEST(SolverOptions, AnUnknownOrderingIsRefusedWithThoseThereAre) {
  EXPECT_EQ(message_of<InvalidInput>([] { static_cast<void>(find_ordering("amdd")); }),
            "there is no ordering \"amdd\"; known: default natural amd colamd metis nested");
  EXPECT_NE(message_of<InvalidInput>([] { static_cast<void>(find_ordering("")); }), "");
}

TEST(SolverOptions, StructuresHaveNames) {
  EXPECT_EQ(name_of(Structure::kGeneral), "general");
  EXPECT_EQ(name_of(Structure::kBlockTriangular), "block_triangular");
  EXPECT_EQ(name_of(Structure::kPeriodic), "periodic");
  EXPECT_EQ(name_of(Structure::kDefinite), "definite");
  EXPECT_EQ(name_of(Structure::kQuasiDefinite), "quasi_definite");
}

TEST(SolverOptions, AskForNothingSpecialByDefault) {
  const SolverOptions options;
  EXPECT_EQ(options.ordering, Ordering::kDefault);
  EXPECT_EQ(options.structure, Structure::kGeneral);
  EXPECT_EQ(options.index_width, IndexWidth::k32);
  EXPECT_TRUE(options.block_sizes.empty());
}

}  // namespace
}  // namespace hbar::solvers
