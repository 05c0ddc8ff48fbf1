#include "hbar/solvers/linear/solver_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "hbar/suite.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;

TEST(SolverCatalogue, HasEverySolverOnceWithItsDefaultOrder) {
  std::set<std::string> names;
  for (const SolverEntry& entry : available_solvers()) {
    names.insert(entry.name);
    EXPECT_EQ(find_solver(entry.name).make, entry.make);
    EXPECT_FALSE(entry.sentence.empty() || entry.licence.empty() || entry.structures.empty());
    EXPECT_TRUE(entry.offers(Ordering::kDefault)) << entry.name;
  }
  EXPECT_EQ(names.size(), available_solvers().size());
}

TEST(SolverCatalogue, RefusesUnknownNamesWithThoseThereAre) {
  const std::string message =
      message_of<InvalidInput>([] { static_cast<void>(find_solver("kul")); });
  EXPECT_EQ(message.find("there is no solver \"kul\"; known: auto block_substitution"), 0U)
      << message;
  EXPECT_THROW(register_solver("kul", nullptr), InvalidInput);
}

TEST(SolverCatalogue, SaysWhereASolverIsThatTheProgramLacks) {
  const MakeSolver make = find_solver("eigen_sparse_lu").make;
  register_solver("eigen_sparse_lu", nullptr);
  EXPECT_EQ(message_of<InvalidInput>([] { static_cast<void>(find_solver("eigen_sparse_lu")); })
                .find("the solver \"eigen_sparse_lu\" is not in this program: include "
                      "\"hbar/suite.h\" and link hbar::suite; there are: auto block_substitution"),
            0U);
  const std::vector<SolverEntry> available = available_solvers();
  EXPECT_TRUE(std::none_of(available.begin(), available.end(), [](const SolverEntry& entry) {
    return entry.name == "eigen_sparse_lu";
  }));
  register_solver("eigen_sparse_lu", make);
  EXPECT_EQ(find_solver("eigen_sparse_lu").make, make);
}

}  // namespace
}  // namespace hbar::solvers
