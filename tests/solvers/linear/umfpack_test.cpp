#include "hbar/solvers/linear/umfpack.h"

#include <gtest/gtest.h>

#include "tests/solvers/linear/solver_checks.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::options_of;
using testing::random_sparse;

constexpr auto kOrderingsOfUmfpack = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                                      Ordering::kColamd, Ordering::kMetis};

TEST(Umfpack, AgreesWithDenseLuInEveryOrderingAndWidth) {
  testing::expect_agrees_in_every_ordering(make_umfpack, kOrderingsOfUmfpack);
}

TEST(Umfpack, ServesNewValuesAndNewPatterns) {
  testing::expect_serves_again_in_every_ordering(make_umfpack, kOrderingsOfUmfpack);
}

TEST(Umfpack, HeedsTheOrdering) {
  const std::vector<Ordering> orderings(kOrderingsOfUmfpack.begin() + 1, kOrderingsOfUmfpack.end());
  testing::expect_heeds_ordering(make_umfpack, random_sparse(400, 3, 1), orderings,
                                 Ordering::kColamd);
  EXPECT_EQ(message_of<InvalidInput>([] { (void)make_umfpack(options_of(Ordering::kNested)); }),
            "umfpack: the ordering \"nested\" is not offered; offered: default, natural, amd, "
            "colamd, metis");
}

TEST(Umfpack, FillsLessByMinimumDegree) {
  const SparseMatrix A = testing::random_definite(300, 1, 2);
  const FactorInfo natural =
      testing::factorized(make_umfpack, options_of(Ordering::kNatural), A)->factor_info();
  const FactorInfo amd =
      testing::factorized(make_umfpack, options_of(Ordering::kAmd), A)->factor_info();
  EXPECT_LT(amd.entries, 0.8 * natural.entries);
  EXPECT_GE(amd.entries, static_cast<double>(A.nonZeros()));
  ASSERT_TRUE(natural.flops && amd.flops);
  EXPECT_LT(*amd.flops, 0.8 * *natural.flops);
}

TEST(Umfpack, NamesTheRowAndColumnOfASingularMatrixWithBothWidths) {
  testing::expect_names_what_is_singular(make_umfpack, kOrderingsOfUmfpack);
}

TEST(Umfpack, GivesTheSameBitsInTwoThreads) {
  testing::expect_the_same_in_two_threads(make_umfpack, {}, random_sparse(100, 3, 3));
  testing::expect_the_same_in_two_threads(make_umfpack, options_of(Ordering::kMetis),
                                          random_sparse(400, 1, 3));
}

TEST(Umfpack, RefusesAStructurallySingularMatrix) {
  SparseMatrix A(3, 3);
  A.insert(0, 0) = 1.0;
  A.insert(1, 0) = 1.0;
  A.insert(2, 0) = 1.0;
  A.insert(0, 1) = 1.0;
  A.insert(0, 2) = 1.0;
  A.makeCompressed();
  const auto solver = make_umfpack();
  const std::string message = message_of<NumericalFailure>([&] {
    solver->analyze(A);
    solver->factorize(A);
  });
  EXPECT_NE(message.find("umfpack: factorize: the matrix (3 x 3) is singular"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace hbar::solvers
