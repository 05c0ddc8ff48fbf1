#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <limits>
#include <thread>

#include "hbar/solvers/linear/accuracy.h"
#include "hbar/suite.h"
#include "tests/solvers/linear/structured_matrices.h"
#include "tests/support/message_of.h"

namespace hbar::solvers {
namespace {

using testing::message_of;
using testing::random_dense;
using testing::random_of;

const std::vector<std::vector<int>> kLayouts = {
    {1}, {3}, {1, 1, 1, 1, 1, 1, 1}, {4, 4, 4, 4, 4, 4}, {4, 1, 7, 4, 4, 12, 3, 4}, {30, 2, 24}};

/// A solver of the catalogue with a structure that it claims: what a test goes through.
struct Case {
  SolverEntry entry;
  Structure structure;
};

std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (const SolverEntry& entry : available_solvers()) {
    for (const Structure structure : entry.structures) {
      cases.push_back({entry, structure});
    }
  }
  return cases;
}

/// Those whose random matrices have dense blocks, so that two rows can be made equal.
std::vector<Case> every_case_of_blocks() {
  std::vector<Case> cases = every_case();
  std::erase_if(cases, [](const Case& one) { return one.structure == Structure::kGeneral; });
  return cases;
}

class Contract : public ::testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] static const SolverEntry& entry() { return GetParam().entry; }
  [[nodiscard]] static SparseMatrix matrix(const std::vector<int>& blocks, unsigned seed) {
    return random_of(GetParam().structure, blocks, seed);
  }
  [[nodiscard]] static std::unique_ptr<LinearSolver> make(const std::vector<int>& blocks,
                                                          Ordering ordering = Ordering::kDefault,
                                                          IndexWidth width = IndexWidth::k32) {
    return make_solver(entry().name,
                       {.ordering = ordering,
                        .index_width = width,
                        .structure = GetParam().structure,
                        .block_sizes = blocks},
                       {});
  }
  /// Half the digits are lost to the normal equations; refinement brings most of them back.
  [[nodiscard]] static double bound() { return entry().name == "cholmod_normal" ? 1e-12 : 1e-14; }

  /// Calls test(blocks, solver) for all blocks, orderings and widths of index.
  template <typename Test>
  static void for_each_solver(const Test& test) {
    for (const std::vector<int>& blocks : kLayouts) {
      for (const Ordering ordering : entry().orderings) {
        for (const IndexWidth width : {IndexWidth::k32, IndexWidth::k64}) {
          if (width == IndexWidth::k64 && !entry().has_64_bit_indices) {
            continue;
          }
          SCOPED_TRACE(concat(blocks.size(), " blocks, the first of ", blocks[0], ", ordering ",
                              name_of(ordering), width == IndexWidth::k64 ? ", 64 bits" : ""));
          const auto solver = make(blocks, ordering, width);
          test(blocks, *solver);
        }
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Suite, Contract, ::testing::ValuesIn(every_case()), [](const auto& one) {
  return concat(one.param.entry.name, '_', name_of(one.param.structure));
});

void expect_solves(LinearSolver& solver, const SparseMatrix& A, double bound) {
  const Eigen::MatrixXd dense(A);
  for (const System system : {System::kPlain, System::kTransposed}) {
    const Eigen::MatrixXd M = system == System::kPlain ? dense : dense.transpose();
    for (const int count : {1, 5, 0}) {
      const Eigen::MatrixXd B = random_dense(static_cast<int>(A.rows()), count, 11);
      Eigen::MatrixXd X = Eigen::MatrixXd::Constant(B.rows(), count, 1e9);
      solver.solve(system, B, X);
      const Eigen::MatrixXd expected = M.partialPivLu().solve(B);
      for (int j = 0; j < count; ++j) {
        EXPECT_LE((X.col(j) - expected.col(j)).norm(), 1e4 * bound * expected.col(j).norm());
        EXPECT_LE(normwise_backward_error(A, system, X.col(j), B.col(j)), bound);
      }
    }
  }
}

TEST_P(Contract, IsNamedAsInTheCatalogue) { EXPECT_EQ(make({2, 2})->name(), entry().name); }

TEST_P(Contract, AgreesWithDenseLu) {
  for_each_solver([](const std::vector<int>& blocks, LinearSolver& solver) {
    const SparseMatrix A = matrix(blocks, 3);
    solver.analyze(A);
    solver.factorize(A);
    expect_solves(solver, A, bound());
  });
}

TEST_P(Contract, AnalysesOnceForManyFactorisations) {
  for_each_solver([](const std::vector<int>& blocks, LinearSolver& solver) {
    SparseMatrix A = matrix(blocks, 1);
    solver.analyze(A);
    for (const double factor : {1.0, 3.0, 0.125}) {
      for (Eigen::Index k = 0; k < A.nonZeros(); ++k) {
        A.valuePtr()[k] *= factor;
      }
      solver.factorize(A);
      expect_solves(solver, A, bound());
    }
    EXPECT_EQ(solver.statistics().analyses, 1);
    EXPECT_EQ(solver.statistics().factorizations, 3);
    EXPECT_LE(solver.statistics().worst_residual, bound());
  });
}

TEST_P(Contract, AnalysesAnotherPatternAfterwards) {
  // Sizes that add up to the same number of rows.
  const auto solver = make({4, 8, 4, 8});
  for (const std::vector<int>& blocks : {std::vector<int>{4, 8, 4, 8}, {4, 2, 6, 4, 8}}) {
    const SparseMatrix A = matrix(blocks, 5);
    solver->analyze(A);
    solver->factorize(A);
    expect_solves(*solver, A, bound());
  }
  EXPECT_EQ(solver->statistics().analyses, 2);
}

TEST_P(Contract, SolvesInPlace) {
  for_each_solver([](const std::vector<int>& blocks, LinearSolver& solver) {
    const SparseMatrix A = matrix(blocks, 4);
    solver.analyze(A);
    solver.factorize(A);
    Eigen::MatrixXd B = random_dense(solver.size(), 3, 8);
    B.topRows(solver.size() / 2).setZero();
    B.col(1).setZero();
    for (const System system : {System::kPlain, System::kTransposed}) {
      Eigen::MatrixXd X(B.rows(), B.cols());
      solver.solve(system, B, X);
      EXPECT_EQ(X.col(1).norm(), 0.0);
      Eigen::MatrixXd in_place = B;
      solver.solve(system, in_place, in_place);
      EXPECT_EQ(in_place, X);
      // Columns of a taller matrix.
      Eigen::MatrixXd tall = Eigen::MatrixXd::Constant(solver.size() + 2, 3, 7.0);
      solver.solve(system, B, tall.middleRows(1, solver.size()));
      EXPECT_LE((tall.middleRows(1, solver.size()) - X).norm(), 1e-12 * X.norm());
      EXPECT_EQ(tall.row(0).sum() + tall.row(solver.size() + 1).sum(), 42.0);
    }
  });
}

TEST_P(Contract, SolvesAdjointSystems) {
  for_each_solver([](const std::vector<int>& blocks, LinearSolver& solver) {
    const SparseMatrix A = matrix(blocks, 4);
    solver.analyze(A);
    solver.factorize(A);
    const Eigen::VectorXd x = random_dense(solver.size(), 1, 1);
    const Eigen::VectorXd y = random_dense(solver.size(), 1, 2);
    Eigen::VectorXd u(x.size());
    Eigen::VectorXd w(x.size());
    solver.solve(x, u);
    solver.solve_transposed(y, w);
    EXPECT_NEAR(u.dot(y), x.dot(w), 1e-11 * (u.norm() * y.norm() + x.norm() * w.norm()));
  });
}

/// A row and the column of the same index become zero; the pattern stays.
void cut_out(SparseMatrix& A, int unknown) {
  for (Eigen::Index j = 0; j < A.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      if (entry.row() == unknown || j == unknown) {
        entry.valueRef() = 0.0;
      }
    }
  }
}

TEST_P(Contract, NamesTheUnknownOfASingularMatrixAndRecovers) {
  for_each_solver([](const std::vector<int>& blocks, LinearSolver& solver) {
    const SparseMatrix good = matrix(blocks, 6);
    SparseMatrix bad = good;
    const int unknown = static_cast<int>(good.rows()) / 3;
    cut_out(bad, unknown);
    solver.name_unknowns([](int index) { return concat("unknown of ", index); });
    solver.analyze(good);
    const std::string message = message_of<NumericalFailure>([&] { solver.factorize(bad); });
    EXPECT_NE(message.find(concat(entry().name, ": factorize: ")), std::string::npos) << message;
    EXPECT_NE(message.find(concat("(unknown of ", unknown, ")")), std::string::npos) << message;
    Eigen::VectorXd x = Eigen::VectorXd::Ones(good.rows());
    EXPECT_THROW(solver.solve(x, x), InvalidInput) << "a failed factorisation must not be usable";
    solver.factorize(good);
    expect_solves(solver, good, bound());
  });
}

class ContractOfBlocks : public Contract {};

INSTANTIATE_TEST_SUITE_P(Suite, ContractOfBlocks, ::testing::ValuesIn(every_case_of_blocks()),
                         [](const auto& one) {
                           return concat(one.param.entry.name, '_', name_of(one.param.structure));
                         });

TEST_P(ContractOfBlocks, RefusesEquationsThatRepeatEachOther) {
  const std::vector<int> blocks = {4, 4, 4, 4};
  for (const Ordering ordering : entry().orderings) {
    SCOPED_TRACE(name_of(ordering));
    SparseMatrix A = matrix(blocks, 6);
    // Unknown 5 becomes a copy of unknown 4, which is of the same block: columns, then rows.
    Eigen::MatrixXd dense(A);
    dense.col(5) = dense.col(4);
    dense.row(5) = dense.row(4);
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
        entry.valueRef() = dense(entry.row(), j);
      }
    }
    const auto solver = make(blocks, ordering);
    solver->analyze(A);
    EXPECT_NE(message_of<NumericalFailure>([&] { solver->factorize(A); }), "");
  }
}

TEST_P(Contract, RefusesValuesThatAreNotNumbersAndAnotherPattern) {
  const std::vector<int> blocks = {4, 4, 4};
  SparseMatrix A = matrix(blocks, 6);
  const auto solver = make(blocks);
  solver->analyze(A);
  EXPECT_THROW(solver->factorize(matrix({4, 4, 1}, 6)), InvalidInput);
  A.coeffRef(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of<NumericalFailure>([&] { solver->factorize(A); }),
            entry().name +
                ": factorize: the entry in row 2, column 2 is nan; check the state the matrix was "
                "computed at");
}

TEST_P(Contract, TellsWhatItsFactorsTake) {
  for_each_solver([](const std::vector<int>& blocks, LinearSolver& solver) {
    const SparseMatrix A = matrix(blocks, 2);
    solver.analyze(A);
    solver.factorize(A);
    const FactorInfo info = solver.factor_info();
    // A symmetric solver keeps one triangle.
    EXPECT_GE(info.entries, 0.5 * static_cast<double>(A.nonZeros() + A.rows()));
    EXPECT_LT(info.entries, 1e6);
    EXPECT_GT(info.bytes, 0.0);
    EXPECT_LT(info.bytes, 1e8);
    EXPECT_GE(info.flops.value_or(0.0), 0.0);
    if (info.inertia) {
      const Eigen::VectorXd eigenvalues =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(A)).eigenvalues();
      const int positive = static_cast<int>((eigenvalues.array() > 0.0).count());
      EXPECT_EQ(info.inertia->positive, positive);
      EXPECT_EQ(info.inertia->negative, static_cast<int>(A.rows()) - positive);
      EXPECT_EQ(info.inertia->zero, 0);
    }
  });
}

TEST_P(Contract, WorksInThreadsWithASolverEach) {
  // Blocks wide enough for the blocked code of BLAS and LAPACK.
  const std::vector<int> blocks = {40, 40, 40, 40};
  std::array<double, 4> worst = {};
  const auto work = [&](unsigned seed) {
    const SparseMatrix A = matrix(blocks, seed);
    const Eigen::VectorXd b = random_dense(static_cast<int>(A.rows()), 1, seed);
    Eigen::VectorXd x(b.size());
    for (int repeat = 0; repeat < 5; ++repeat) {
      const auto solver = make(blocks);
      solver->analyze(A);
      solver->factorize(A);
      solver->solve(b, x);
      worst[seed] = std::max(worst[seed], normwise_backward_error(A, System::kPlain, x, b));
      EXPECT_GT(x.norm(), 0.0);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < worst.size(); ++seed) {
    threads.emplace_back(work, seed);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const double error : worst) {
    EXPECT_LE(error, bound());
  }
}

}  // namespace
}  // namespace hbar::solvers
