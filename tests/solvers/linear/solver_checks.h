#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "hbar/solvers/linear/solver_options.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers::testing {

inline constexpr auto kWidths = {IndexWidth::k32, IndexWidth::k64};

using Maker = std::unique_ptr<LinearSolver> (*)(const SolverOptions&);

inline SolverOptions options_of(Ordering ordering, IndexWidth width = IndexWidth::k32) {
  SolverOptions options;
  options.ordering = ordering;
  options.index_width = width;
  return options;
}

/// Symmetric, positive definite, with a smallest eigenvalue of 1 or more.
inline SparseMatrix random_definite(int size, int per_column, unsigned seed) {
  const SparseMatrix R = random_sparse(size, per_column, seed);
  SparseMatrix identity(size, size);
  identity.setIdentity();
  SparseMatrix A = SparseMatrix(R * R.transpose()) + identity;
  A.makeCompressed();
  return A;
}

/// [[P, Bᵀ], [B, −Q]] with definite P and Q, its rows and columns in a random order.
inline SparseMatrix random_quasi_definite(int primal, int dual, unsigned seed) {
  const int size = primal + dual;
  std::vector<int> place(static_cast<std::size_t>(size));
  std::iota(place.begin(), place.end(), 0);
  std::mt19937_64 engine(seed);
  std::shuffle(place.begin(), place.end(), engine);
  const auto at = [&place](int i) { return place[static_cast<std::size_t>(i)]; };
  std::vector<Eigen::Triplet<double>> entries;
  const SparseMatrix P = random_definite(primal, 2, seed);
  const SparseMatrix Q = random_definite(dual, 2, seed + 1);
  for (int j = 0; j < primal; ++j) {
    for (SparseMatrix::InnerIterator entry(P, j); entry; ++entry) {
      entries.emplace_back(at(static_cast<int>(entry.row())), at(j), entry.value());
    }
  }
  for (int j = 0; j < dual; ++j) {
    for (SparseMatrix::InnerIterator entry(Q, j); entry; ++entry) {
      const int i = primal + static_cast<int>(entry.row());
      entries.emplace_back(at(i), at(primal + j), -entry.value());
    }
  }
  const Eigen::MatrixXd B = random_dense(dual, 3, seed + 2);
  for (int i = 0; i < dual; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int j = (5 * i + 7 * k) % primal;
      entries.emplace_back(at(primal + i), at(j), B(i, k));
      entries.emplace_back(at(j), at(primal + i), B(i, k));
    }
  }
  SparseMatrix A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// Definite: a diagonal, and the whole first row and column. Eliminated from the first on, all of
/// it fills; from the last on, nothing does.
inline SparseMatrix arrow_matrix(int size) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.emplace_back(0, 0, size);
  for (int i = 1; i < size; ++i) {
    entries.emplace_back(i, i, 2.0);
    entries.emplace_back(0, i, 1.0);
    entries.emplace_back(i, 0, 1.0);
  }
  SparseMatrix A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

/// Identity, but for a few entries.
inline SparseMatrix nearly_identity(int size, const std::vector<Eigen::Triplet<double>>& others) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 1.0);
  }
  entries.insert(entries.end(), others.begin(), others.end());
  SparseMatrix A(size, size);
  A.setFromTriplets(entries.begin(), entries.end(), [](double, double last) { return last; });
  return A;
}

/// Dense, with a condition number of about 30 to the power of its size.
inline SparseMatrix hilbert_matrix(int size) {
  Eigen::MatrixXd A(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      A(i, j) = 1.0 / (i + j + 1);
    }
  }
  return A.sparseView();
}

inline std::unique_ptr<LinearSolver> factorized(Maker make, const SolverOptions& options,
                                                const SparseMatrix& A) {
  auto solver = make(options);
  solver->analyze(A);
  solver->factorize(A);
  return solver;
}

/// Every ordering gives factors of a size of its own, and the default is one of them.
///
/// @param orderings  all that are offered but the default
/// @param usual      the one that is taken by default
inline void expect_heeds_ordering(Maker make, const SparseMatrix& A,
                                  const std::vector<Ordering>& orderings, Ordering usual) {
  const auto entries_of = [&](Ordering ordering, IndexWidth width) {
    return factorized(make, options_of(ordering, width), A)->factor_info().entries;
  };
  std::vector<double> entries;
  for (const Ordering ordering : orderings) {
    entries.push_back(entries_of(ordering, IndexWidth::k32));
    EXPECT_EQ(entries.back(), entries_of(ordering, IndexWidth::k64)) << name_of(ordering);
  }
  EXPECT_EQ(entries_of(Ordering::kDefault, IndexWidth::k32), entries_of(usual, IndexWidth::k32));
  std::sort(entries.begin(), entries.end());
  EXPECT_EQ(std::unique(entries.begin(), entries.end()) - entries.begin(),
            static_cast<std::ptrdiff_t>(orderings.size()));
}

/// One and many right-hand sides, plain and transposed, in place, and into part of a larger matrix.
inline void expect_agrees_with_dense(LinearSolver& solver, const SparseMatrix& A,
                                     double tolerance = 1e-12) {
  const auto n = static_cast<int>(A.rows());
  for (const System system : {System::kPlain, System::kTransposed}) {
    Eigen::MatrixXd dense(A);
    if (system == System::kTransposed) {
      dense.transposeInPlace();
    }
    for (const int count : {5, 1}) {
      const Eigen::MatrixXd B = random_dense(n, count, 11);
      const Eigen::MatrixXd expected = dense.partialPivLu().solve(B);
      Eigen::MatrixXd X(n, count);
      solver.solve(system, B, X);
      EXPECT_LE((X - expected).lpNorm<Eigen::Infinity>(),
                tolerance * expected.lpNorm<Eigen::Infinity>());
      Eigen::MatrixXd in_place = B;
      solver.solve(system, in_place, in_place);
      EXPECT_EQ(in_place, X);
      Eigen::MatrixXd larger = Eigen::MatrixXd::Constant(n + 3, count, 7.0);
      solver.solve(system, B, larger.topRows(n));
      EXPECT_EQ(larger.topRows(n), X);
      EXPECT_EQ(larger.bottomRows(3), Eigen::MatrixXd::Constant(3, count, 7.0));
    }
    Eigen::MatrixXd none(n, 0);
    solver.solve(system, none, none);
  }
}

/// One analysis serves new values, a new analysis another size, and both a solver that refused.
///
/// @param first, second   of one pattern
/// @param bad             of that pattern, to be refused
/// @param other           of another size
inline void expect_serves_again(LinearSolver& solver, const SparseMatrix& first,
                                const SparseMatrix& second, const SparseMatrix& bad,
                                const SparseMatrix& other) {
  solver.analyze(first);
  for (const SparseMatrix* A : {&first, &second, &first}) {
    solver.factorize(*A);
    expect_agrees_with_dense(solver, *A);
    EXPECT_THROW(solver.factorize(bad), NumericalFailure);
    Eigen::VectorXd x = Eigen::VectorXd::Ones(A->rows());
    EXPECT_THROW(solver.solve(x, x), InvalidInput);
  }
  EXPECT_EQ(solver.statistics().analyses, 1);
  EXPECT_EQ(solver.statistics().factorizations, 3);
  EXPECT_EQ(solver.statistics().solves, 3 * 2 * 3 * 6);
  for (const SparseMatrix* A : {&other, &first}) {
    solver.analyze(*A);
    solver.factorize(*A);
    expect_agrees_with_dense(solver, *A);
  }
}

/// Two threads, a solver each, get at the same time the bits that one gets alone.
inline void expect_the_same_in_two_threads(Maker make, const SolverOptions& options,
                                           const SparseMatrix& A, int repeats = 20) {
  const Eigen::VectorXd b = random_dense(static_cast<int>(A.rows()), 1, 3);
  const auto solution = [&] {
    Eigen::VectorXd x(b.size());
    factorized(make, options, A)->solve(b, x);
    return x;
  };
  const Eigen::VectorXd alone = solution();
  const auto count_others = [&](int& others) {
    for (int repeat = 0; repeat < repeats; ++repeat) {
      others += solution() == alone ? 0 : 1;
    }
  };
  int first = 0;
  int second = 0;
  std::thread other(count_others, std::ref(first));
  count_others(second);
  other.join();
  EXPECT_EQ(first + second, 0);
}

/// A solver of general matrices agrees with dense LU on matrices of several kinds.
inline void expect_agrees_in_every_ordering(Maker make, std::initializer_list<Ordering> orderings) {
  for (const Ordering ordering : orderings) {
    for (const IndexWidth width : kWidths) {
      SCOPED_TRACE(name_of(ordering));
      for (const SparseMatrix& A :
           {random_sparse(60, 3, 1), random_block_lower({4, 1, 7, 12, 3}, 2),
            random_definite(50, 2, 3)}) {
        expect_agrees_with_dense(*factorized(make, options_of(ordering, width), A), A);
      }
    }
  }
}

/// It serves other values of a pattern, and another pattern, after a refusal, too.
inline void expect_serves_again_in_every_ordering(Maker make,
                                                  std::initializer_list<Ordering> orderings) {
  const SparseMatrix A = random_sparse(60, 3, 1);
  SparseMatrix B = A;
  B.diagonal() *= -1.5;
  SparseMatrix zero = A;
  zero.coeffs().setZero();
  for (const Ordering ordering : orderings) {
    for (const IndexWidth width : kWidths) {
      const auto solver = make(options_of(ordering, width));
      expect_serves_again(*solver, A, B, zero, random_sparse(90, 2, 1));
    }
  }
}

/// Of a matrix whose rows 11 and 12 are equal it names one of the columns 11 and 12.
inline void expect_names_what_is_singular(Maker make, std::initializer_list<Ordering> orderings) {
  const SparseMatrix A = nearly_identity(20, {{11, 12, 1.0}, {12, 11, 1.0}});
  for (const Ordering ordering : orderings) {
    for (const IndexWidth width : kWidths) {
      const auto solver = make(options_of(ordering, width));
      solver->name_unknowns([](int index) { return concat("joint ", index); });
      solver->analyze(A);
      const std::string message = message_of<NumericalFailure>([&] { solver->factorize(A); });
      EXPECT_TRUE(message.find("column 11 (joint 11) is 0") != std::string::npos ||
                  message.find("column 12 (joint 12) is 0") != std::string::npos)
          << message;
    }
  }
}

}  // namespace hbar::solvers::testing
