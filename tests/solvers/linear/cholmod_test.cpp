#include "hbar/solvers/linear/cholmod.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "hbar/solvers/linear/klu.h"
#include "tests/solvers/linear/solver_checks.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::arrow_matrix;
using testing::expect_agrees_with_dense;
using testing::factorized;
using testing::hilbert_matrix;
using testing::kWidths;
using testing::message_of;
using testing::nearly_identity;
using testing::options_of;
using testing::random_definite;
using testing::random_quasi_definite;
using testing::random_sparse;

SparseMatrix any_definite(unsigned seed) { return random_definite(60, 2, seed); }
SparseMatrix any_quasi_definite(unsigned seed) { return random_quasi_definite(40, 20, seed); }
SparseMatrix any_general(unsigned seed) { return random_sparse(60, 3, seed); }
/// Its A Aᵀ is an arrow.
SparseMatrix half_an_arrow(int size) { return arrow_matrix(size).triangularView<Eigen::Upper>(); }

/// One row of the table of factories.
struct CholmodEntry {
  std::string name;
  testing::Maker make;
  SparseMatrix (*matrix)(unsigned seed);  ///< one that it is meant for
  SparseMatrix (*arrow)(int size);        ///< one that fills
  std::vector<Ordering> orderings;        ///< kDefault first
  Ordering usual;                         ///< what kDefault means
};

const std::vector<Ordering> kSymmetric = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                                          Ordering::kMetis, Ordering::kNested};
const std::vector<Ordering> kAll = {Ordering::kDefault, Ordering::kNatural, Ordering::kAmd,
                                    Ordering::kColamd,  Ordering::kMetis,   Ordering::kNested};

std::vector<CholmodEntry> every_factory() {
  return {
      {"cholmod_llt", make_cholmod_llt, any_definite, arrow_matrix, kSymmetric, Ordering::kAmd},
      {"cholmod_supernodal", make_cholmod_supernodal, any_definite, arrow_matrix, kSymmetric,
       Ordering::kAmd},
      {"cholmod_ldlt", make_cholmod_ldlt, any_quasi_definite, arrow_matrix, kSymmetric,
       Ordering::kNatural},
      {"cholmod_normal", make_cholmod_normal, any_general, half_an_arrow, kAll, Ordering::kColamd},
  };
}

class EveryCholmod : public ::testing::TestWithParam<CholmodEntry> {};

INSTANTIATE_TEST_SUITE_P(Factories, EveryCholmod, ::testing::ValuesIn(every_factory()),
                         [](const auto& entry) { return entry.param.name; });

TEST_P(EveryCholmod, AgreesWithDenseLuInEveryOrderingAndWidth) {
  for (const Ordering ordering : GetParam().orderings) {
    for (const IndexWidth width : kWidths) {
      SCOPED_TRACE(name_of(ordering));
      for (const unsigned seed : {1U, 2U}) {
        const SparseMatrix A = GetParam().matrix(seed);
        const auto solver = factorized(GetParam().make, options_of(ordering, width), A);
        EXPECT_EQ(solver->name(), GetParam().name);
        expect_agrees_with_dense(*solver, A);
      }
    }
  }
}

TEST_P(EveryCholmod, GivesTheSameBitsWithBothWidths) {
  const SparseMatrix A = GetParam().matrix(4);
  const Eigen::VectorXd b = testing::random_dense(static_cast<int>(A.rows()), 1, 5);
  Eigen::VectorXd narrow(b.size());
  Eigen::VectorXd wide(b.size());
  factorized(GetParam().make, options_of(Ordering::kAmd), A)->solve(b, narrow);
  factorized(GetParam().make, options_of(Ordering::kAmd, IndexWidth::k64), A)->solve(b, wide);
  EXPECT_EQ(narrow, wide);
}

TEST_P(EveryCholmod, ServesNewValuesAndNewPatterns) {
  const SparseMatrix A = GetParam().matrix(1);
  SparseMatrix B = A;
  B.diagonal() *= 1.5;
  SparseMatrix zero = A;
  zero.coeffs().setZero();
  const SparseMatrix larger = GetParam().arrow(90);
  for (const Ordering ordering : {Ordering::kNatural, Ordering::kAmd}) {
    for (const IndexWidth width : kWidths) {
      const auto solver = GetParam().make(options_of(ordering, width));
      testing::expect_serves_again(*solver, A, B, zero, larger);
    }
  }
}

TEST_P(EveryCholmod, HeedsTheOrdering) {
  const auto& mine = GetParam().orderings;
  testing::expect_heeds_ordering(GetParam().make, random_definite(300, 2, 1),
                                 {mine.begin() + 1, mine.end()}, GetParam().usual);
}

TEST_P(EveryCholmod, FillsAnArrowLessByMinimumDegree) {
  const int n = 300;
  const SparseMatrix A = GetParam().arrow(n);
  for (const IndexWidth width : kWidths) {
    const FactorInfo natural =
        factorized(GetParam().make, options_of(Ordering::kNatural, width), A)->factor_info();
    const FactorInfo amd =
        factorized(GetParam().make, options_of(Ordering::kAmd, width), A)->factor_info();
    EXPECT_GE(natural.entries, 1.0 * n * n);
    EXPECT_GE(amd.entries, 3 * n - 2);  // as many as the matrix has
    EXPECT_LT(amd.entries, 0.1 * natural.entries);
    EXPECT_LT(amd.bytes, 0.5 * natural.bytes);
    EXPECT_GE(natural.bytes, 8.0 * n * (n + 1) / 2.0);  // a triangle
    ASSERT_TRUE(natural.flops && amd.flops);
    EXPECT_NEAR(*natural.flops, n * (n + 1.0) * (2.0 * n + 1.0) / 6.0, 0.02 * *natural.flops);
    EXPECT_LT(*amd.flops, 0.01 * *natural.flops);
  }
}

TEST_P(EveryCholmod, NamesTheOrderingsItOffers) {
  std::string offered;
  for (const Ordering ordering : kAll) {
    const auto& mine = GetParam().orderings;
    if (std::find(mine.begin(), mine.end(), ordering) != mine.end()) {
      offered += (offered.empty() ? "" : ", ") + std::string(name_of(ordering));
      EXPECT_NO_THROW((void)GetParam().make(options_of(ordering)));
      continue;
    }
    EXPECT_EQ(message_of<InvalidInput>([&] { (void)GetParam().make(options_of(ordering)); }),
              GetParam().name +
                  ": the ordering \"colamd\" is not offered; offered: default, natural, amd, "
                  "metis, nested");
  }
  EXPECT_FALSE(offered.empty());
}

TEST_P(EveryCholmod, GivesTheSameBitsInTwoThreads) {
  testing::expect_the_same_in_two_threads(GetParam().make, {}, GetParam().matrix(3));
}

TEST_P(EveryCholmod, DissectsAlikeInTwoThreads) {
  // METIS draws from one random generator for all threads; large enough that it has to.
  const SparseMatrix A = random_definite(400, 1, 3);
  for (const Ordering ordering : {Ordering::kMetis, Ordering::kNested}) {
    SCOPED_TRACE(name_of(ordering));
    testing::expect_the_same_in_two_threads(GetParam().make, options_of(ordering), A);
  }
}

/// Names an unknown, so that messages can be told from those of indices.
std::string name_of_unknown(int index) { return concat("joint ", index); }

TEST_P(EveryCholmod, NamesTheRowOfASingularMatrix) {
  // Rows 11 and 12 are alike: either is the one too many, after whichever comes first.
  const SparseMatrix A = nearly_identity(30, {{11, 12, 1.0}, {12, 11, 1.0}});
  for (const Ordering ordering : GetParam().orderings) {
    for (const IndexWidth width : kWidths) {
      const auto solver = GetParam().make(options_of(ordering, width));
      solver->name_unknowns(name_of_unknown);
      solver->analyze(A);
      const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
      EXPECT_NE(message.find("singular"), std::string::npos) << message;
      EXPECT_TRUE(message.find("row 11 (joint 11)") != std::string::npos ||
                  message.find("row 12 (joint 12)") != std::string::npos)
          << message;
    }
  }
}

TEST_P(EveryCholmod, RefusesAPivotThatRoundingKeptFromZero) {
  const double almost = 1.0 + 4e-16;
  const SparseMatrix A =
      nearly_identity(30, {{11, 12, 1.0}, {12, 11, 1.0}, {11, 11, almost}, {12, 12, almost}});
  const auto solver = GetParam().make(options_of(Ordering::kNatural));
  solver->analyze(A);
  const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
  EXPECT_NE(message.find("the pivot in row 12"), std::string::npos) << message;
}

class EveryDefiniteCholmod : public ::testing::TestWithParam<testing::Maker> {};

INSTANTIATE_TEST_SUITE_P(Factories, EveryDefiniteCholmod,
                         ::testing::Values(make_cholmod_llt, make_cholmod_supernodal));

TEST_P(EveryDefiniteCholmod, NamesTheRowWhereAMatrixStopsBeingDefinite) {
  const SparseMatrix good = arrow_matrix(30);
  SparseMatrix bad = good;
  bad.coeffRef(17, 17) = -2.0;
  for (const Ordering ordering : kSymmetric) {
    if (ordering == Ordering::kNatural) {
      continue;  // which eliminates row 0 before its neighbours
    }
    for (const IndexWidth width : kWidths) {
      const auto solver = GetParam()(options_of(ordering, width));
      solver->name_unknowns(name_of_unknown);
      solver->analyze(good);
      solver->factorize(good);
      EXPECT_EQ(
          message_of<NumericalFailure>([&] { solver->factorize(bad); }),
          solver->name() +
              ": factorize: the matrix (30 x 30) is singular to working precision or not positive "
              "definite: the pivot in row 17 (joint 17) is not positive; look for an unknown "
              "without stiffness or inertia, or take cholmod_ldlt or klu");
      solver->factorize(good);
      expect_agrees_with_dense(*solver, good);
    }
  }
}

TEST_P(EveryDefiniteCholmod, ShowsTheInertia) {
  const auto solver = factorized(GetParam(), {}, any_definite(1));
  EXPECT_EQ(solver->factor_info().inertia, (Inertia{60, 0, 0}));
}

TEST_P(EveryDefiniteCholmod, RefusesAPatternThatIsNotSymmetric) {
  const auto solver = GetParam()({});
  EXPECT_THROW(solver->analyze(any_general(1)), InvalidInput);
}

TEST_P(EveryDefiniteCholmod, TakesUnknownsOfVeryDifferentSizes) {
  SparseMatrix A = any_definite(2);
  Eigen::VectorXd scale(A.rows());
  for (int i = 0; i < scale.size(); ++i) {
    scale[i] = i % 3 == 0 ? 1e-7 : 1e7;
  }
  A = scale.asDiagonal() * A * scale.asDiagonal();
  EXPECT_NO_THROW((void)factorized(GetParam(), {}, A));
}

TEST(CholmodLdlt, ShowsTheInertiaThatTheEigenvaluesHave) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const Ordering ordering : kSymmetric) {
      const int dual = 5 * static_cast<int>(seed);
      const SparseMatrix A = random_quasi_definite(30, dual, seed);
      const auto eigenvalues =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(A)).eigenvalues().eval();
      const Inertia expected = {static_cast<int>((eigenvalues.array() > 0.0).count()),
                                static_cast<int>((eigenvalues.array() < 0.0).count()), 0};
      const auto solver = factorized(make_cholmod_ldlt, options_of(ordering), A);
      EXPECT_EQ(solver->factor_info().inertia, expected);
      EXPECT_EQ(expected.negative, dual);
    }
  }
}

TEST(CholmodLdlt, RefusesAMatrixThatIsNotQuasiDefiniteByTheNameOfItsRow) {
  // [[0, 1], [1, 0]] needs a pivot off the diagonal; a tiny entry there does not help.
  for (const double pivot : {0.0, 1e-20, -1e-20}) {
    for (const IndexWidth width : kWidths) {
      const SparseMatrix A =
          nearly_identity(9, {{4, 4, pivot}, {4, 5, 1.0}, {5, 4, 1.0}, {5, 5, 0.0}});
      const auto solver = make_cholmod_ldlt(options_of(Ordering::kDefault, width));
      solver->name_unknowns(name_of_unknown);
      solver->analyze(A);
      EXPECT_EQ(message_of<NumericalFailure>([&] { solver->factorize(A); }),
                concat("cholmod_ldlt: factorize: the matrix (9 x 9) is singular to working "
                       "precision: the pivot in row 4 (joint 4), column 4 (joint 4) is ",
                       pivot,
                       "; look for an unknown without stiffness or inertia, or for equations that "
                       "repeat each other"));
    }
  }
}

TEST(CholmodLdlt, EliminatesInTheGivenOrderUnlessTold) {
  const SparseMatrix A = arrow_matrix(100);
  EXPECT_EQ(factorized(make_cholmod_ldlt, {}, A)->factor_info().entries, 100 * 100);
  EXPECT_EQ(factorized(make_cholmod_llt, {}, A)->factor_info().entries, 298);
}

TEST(CholmodNormal, DoesNotShowTheInertiaOfAnotherMatrix) {
  EXPECT_FALSE(factorized(make_cholmod_normal, {}, any_general(1))->factor_info().inertia);
}

/// Scaled residual of a solution without refinement; nothing if the matrix or the solution is
/// refused.
std::optional<double> unrefined_residual(testing::Maker make, const SparseMatrix& A) {
  try {
    const auto solver = make({});
    solver->set_residual_bounds({.max_refinements = 0});
    solver->analyze(A);
    solver->factorize(A);
    Eigen::VectorXd x = Eigen::VectorXd::Ones(A.rows());
    solver->solve_transposed(x, x);
    return solver->statistics().worst_residual;
  } catch (const NumericalFailure&) {
    return {};
  }
}

TEST(CholmodNormal, LosesTheSquareOfTheConditionNumberAndRefusesWhatIsLeft) {
  const SparseMatrix fair = hilbert_matrix(4);  // condition 2e4
  ASSERT_TRUE(unrefined_residual(make_klu, fair) && unrefined_residual(make_cholmod_normal, fair));
  EXPECT_LT(*unrefined_residual(make_klu, fair), 1e-15);
  EXPECT_GT(*unrefined_residual(make_cholmod_normal, fair), 1e-14);
  const SparseMatrix ill = hilbert_matrix(8);  // condition 2e10
  EXPECT_LT(unrefined_residual(make_klu, ill).value_or(1.0), 1e-15);
  EXPECT_FALSE(unrefined_residual(make_cholmod_normal, ill));
}

TEST(CholmodNormal, IsRightOrRefusesWhateverTheConditionNumber) {
  int solved = 0;
  int refused = 0;
  for (int n = 2; n <= 12; ++n) {
    const SparseMatrix A = hilbert_matrix(n);
    const Eigen::VectorXd b = A * Eigen::VectorXd::Ones(n);
    try {
      const auto solver = factorized(make_cholmod_normal, {}, A);
      Eigen::VectorXd x(n);
      for (const System system : {System::kPlain, System::kTransposed}) {
        solver->solve(system, b, x);  // the matrix is its own transpose
        EXPECT_LT((A * x - b).lpNorm<Eigen::Infinity>(),
                  1e-10 * (x.lpNorm<Eigen::Infinity>() * n + b.lpNorm<Eigen::Infinity>()));
      }
      EXPECT_EQ(refused, 0) << "solved " << n << " after refusing less";
      ++solved;
    } catch (const NumericalFailure&) {
      ++refused;
    }
  }
  EXPECT_GE(solved, 3);
  EXPECT_GE(refused, 3);
}

}  // namespace
}  // namespace hbar::solvers
