#include "hbar/solvers/linear/cached_solver.h"

#include <gtest/gtest.h>

#include "hbar/solvers/linear/klu.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_block_lower;
using testing::random_sparse;

MatrixDescription of_three_blocks() {
  return {{.structure = Structure::kBlockTriangular, .block_sizes = {3, 3, 2}}, {}};
}

MatrixDescription nothing_known() { return {}; }

TEST(CachedSolver, TakesBlockSubstitutionWhereItCanAndKluOtherwise) {
  CachedSolver cached(nullptr);
  EXPECT_EQ(cached.factorize(random_block_lower({3, 3, 2}, 1), 1, of_three_blocks).name(),
            "block_substitution");
  EXPECT_EQ(cached.factorize(random_sparse(8, 3, 1), 2, nothing_known).name(), "klu");
}

TEST(CachedSolver, AnalysesOncePerPattern) {
  int made = 0;
  CachedSolver cached([&](const SolverOptions& options, const SparseMatrix&) {
    ++made;
    return make_klu(options);
  });
  for (unsigned seed = 1; seed <= 5; ++seed) {
    cached.factorize(random_block_lower({3, 3, 2}, seed), 1, of_three_blocks);
  }
  EXPECT_EQ(made, 1);
  EXPECT_EQ(cached.solver().statistics().analyses, 1);
  EXPECT_EQ(cached.solver().statistics().factorizations, 5);
  cached.factorize(random_sparse(8, 3, 1), 2, nothing_known);
  EXPECT_EQ(made, 2);
}

TEST(CachedSolver, RefusesAnotherPatternUnderTheSameNumber) {
  CachedSolver cached(nullptr);
  cached.factorize(random_sparse(8, 3, 1), 1, nothing_known);
  EXPECT_NE(message_of<InvalidInput>([&] {
              cached.factorize(random_sparse(9, 3, 1), 1, nothing_known);
            }).find("another pattern"),
            std::string::npos);
}

TEST(CachedSolver, GivesNamesToTheMessages) {
  SparseMatrix A = random_sparse(4, 0, 1);
  A.coeffs()[2] = 0.0;
  CachedSolver cached(nullptr);
  const auto name = [](int index) { return concat("coordinate ", "abcd"[index]); };
  EXPECT_NE(message_of<NumericalFailure>([&] {
              cached.factorize(A, 1, [&] { return MatrixDescription{{}, name}; });
            }).find("row 2 (coordinate c)"),
            std::string::npos);
}

}  // namespace
}  // namespace hbar::solvers
