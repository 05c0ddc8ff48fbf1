#include "hbar/solvers/linear/solver_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hbar/suite.h"
#include "tests/solvers/linear/structured_matrices.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_of;

std::string refusal(std::string_view name, const SolverOptions& options) {
  return message_of<InvalidInput>([&] { static_cast<void>(make_solver(name, options, {})); });
}

TEST(MakeSolver, RefusesWhatASolverDoesNotOffer) {
  EXPECT_EQ(refusal("klu", {.ordering = Ordering::kMetis}),
            "make_solver: klu has no ordering \"metis\"; it offers: default, natural, amd, colamd");
  EXPECT_EQ(
      refusal("block_substitution", {.block_sizes = {2}}),
      "make_solver: block_substitution is not for matrices of structure \"general\"; it takes: "
      "block_triangular");
  EXPECT_EQ(
      refusal("block_substitution", {.structure = Structure::kBlockTriangular}),
      "make_solver: block_substitution needs the sizes of the diagonal blocks; there are none");
  EXPECT_EQ(refusal("block_banded", {.structure = Structure::kPeriodic}),
            "make_solver: block_banded is not for matrices of structure \"periodic\"; it takes: "
            "general, block_triangular, definite, quasi_definite");
  for (const SolverEntry& entry : available_solvers()) {
    SolverOptions options = {
        .index_width = IndexWidth::k64, .structure = entry.structures[0], .block_sizes = {2}};
    EXPECT_EQ(refusal(entry.name, options).empty(), entry.has_64_bit_indices) << entry.name;
  }
}

struct Wish {
  Structure structure;
  std::vector<int> blocks;
  std::vector<std::string> names;  ///< the first of them that was built
};

TEST(ChooseSolver, GoesByTheStructure) {
  const std::vector<int> tiny(80, 2);
  const std::vector<int> small(40, 4);
  const std::vector<int> large(10, 40);
  const std::vector<Wish> wishes = {
      {Structure::kBlockTriangular, tiny, {"lapack_band", "block_substitution"}},
      {Structure::kBlockTriangular, small, {"block_substitution"}},
      {Structure::kBlockTriangular, large, {"block_substitution"}},
      {Structure::kPeriodic, small, {"klu"}},
      {Structure::kPeriodic, large, {"eigen_sparse_lu"}},
      {Structure::kDefinite, small, {"lapack_band", "block_banded"}},
      {Structure::kDefinite, large, {"block_banded"}},
      {Structure::kQuasiDefinite, small, {"cholmod_ldlt", "klu"}},
      {Structure::kGeneral, small, {"klu"}},
  };
  for (const Wish& wish : wishes) {
    const SparseMatrix A = random_of(wish.structure, wish.blocks, 1);
    const SolverOptions options = {.structure = wish.structure, .block_sizes = wish.blocks};
    const SolverChoice choice = choose_solver(options, A);
    std::string expected;
    for (const std::string& name : wish.names) {
      const auto suite = available_solvers();
      const bool has = std::any_of(suite.begin(), suite.end(),
                                   [&](const SolverEntry& entry) { return entry.name == name; });
      if (expected.empty() && has) {
        expected = name;
      }
    }
    EXPECT_EQ(choice.name, expected) << name_of(wish.structure) << ' ' << wish.blocks[0];
    EXPECT_FALSE(choice.reason.empty());
    const auto solver = make_solver("auto", options, A);
    EXPECT_EQ(solver->name(), choice.name);
    solver->analyze(A);
    solver->factorize(A);
    Eigen::VectorXd x(A.rows());
    solver->solve(Eigen::VectorXd::Ones(A.rows()), x);
    EXPECT_LE(solver->statistics().worst_residual, 1e-14);
  }
}

TEST(ChooseSolver, SeesTrianglesAndDoesNotBelieveInThem) {
  const std::vector<int> blocks(10, 4);
  const SparseMatrix lower = random_of(Structure::kBlockTriangular, blocks, 1);
  const SparseMatrix periodic = random_of(Structure::kPeriodic, blocks, 1);
  EXPECT_EQ(choose_solver({.block_sizes = blocks}, lower).name, "block_substitution");
  EXPECT_EQ(choose_solver({.block_sizes = std::vector<int>(9, 4)}, lower).name, "klu");
  EXPECT_EQ(choose_solver({.block_sizes = std::vector<int>(20, 2)}, lower).name, "klu");
  EXPECT_EQ(choose_solver({}, lower).name, "klu");
  EXPECT_EQ(
      choose_solver({.structure = Structure::kBlockTriangular, .block_sizes = blocks}, periodic)
          .name,
      "klu");
}

TEST(ChooseSolver, HeedsAnOrderingThatIsAskedFor) {
  const std::vector<int> blocks(10, 4);
  const SparseMatrix A = random_of(Structure::kBlockTriangular, blocks, 1);
  const SolverChoice choice =
      choose_solver({.ordering = Ordering::kColamd, .block_sizes = blocks}, A);
  EXPECT_EQ(choice.name, "klu");
  EXPECT_EQ(choice.ordering, Ordering::kColamd);
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { static_cast<void>(choose_solver({.ordering = Ordering::kNested}, A)); }),
            "auto: no solver for structure \"general\" with ordering \"nested\"; use ordering "
            "\"default\", or choose a solver by its name");
}

TEST(SolverFactory, MakesWhatItsNameSays) {
  const std::vector<int> blocks(10, 4);
  const SparseMatrix A = random_of(Structure::kBlockTriangular, blocks, 1);
  EXPECT_EQ(solver_factory("eigen_sparse_lu", Ordering::kAmd)({}, A)->name(), "eigen_sparse_lu");
  EXPECT_EQ(solver_factory("auto")({.block_sizes = blocks}, A)->name(), "block_substitution");
  EXPECT_THROW(static_cast<void>(solver_factory("klu", Ordering::kMetis)({}, A)), InvalidInput);
}

}  // namespace
}  // namespace hbar::solvers
