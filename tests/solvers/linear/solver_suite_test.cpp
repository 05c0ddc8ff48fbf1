#include "hbar/solvers/linear/solver_suite.h"

#include <gtest/gtest.h>

#include "hbar/suite.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

TEST(SolverSuite, IsThereOnceItsHeaderIsIncluded) {
  for (const char* name : {"block_banded", "eigen_sparse_lu"}) {
    EXPECT_NE(find_solver(name).make, nullptr) << name;
  }
  EXPECT_TRUE(register_suite());  // a second time does no harm
}

TEST(SolverSuite, NamesThePackageOfWhatItWasBuiltWithout) {
  for (const auto& [name, package] : {std::pair{"umfpack", "libsuitesparse-dev"},
                                      {"mumps", "libmumps-seq-dev"},
                                      {"lapack_band", "liblapack-dev"}}) {
    const std::string reason =
        testing::message_of<InvalidInput>([&] { static_cast<void>(find_solver(name)); });
    EXPECT_TRUE(reason.empty() || reason.find(package) != std::string::npos) << reason;
  }
}

}  // namespace
}  // namespace hbar::solvers
