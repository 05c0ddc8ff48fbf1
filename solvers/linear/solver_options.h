#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string_view>
#include <vector>

#include "hbar/solvers/linear/linear_solver.h"

namespace hbar::solvers {

/// What is known about a matrix in advance. It decides which solvers suit it.
enum class Structure {
  kGeneral,          ///< square, nothing more is known
  kBlockTriangular,  ///< block lower triangular: H̄ of a trajectory
  kPeriodic,         ///< that, and blocks above the diagonal in the last block columns
  kDefinite,         ///< symmetric, positive definite
  kQuasiDefinite,    ///< symmetric, [[P, Bᵀ], [B, −Q]] with definite P and Q, rows in any order
};

/// The order in which unknowns are eliminated.
enum class Ordering {
  kDefault,  ///< the solver's own default
  kNatural,  ///< as given; the matrices of trajectories come in time order
  kAmd,      ///< approximate minimum degree of A or A + Aᵀ
  kColamd,   ///< approximate minimum degree of AᵀA
  kMetis,    ///< METIS's nested dissection
  kNested,   ///< CHOLMOD's nested dissection, with constrained minimum degree at its leaves
};

/// Width of the integers that count the entries of factors.
enum class IndexWidth {
  k32,  ///< up to 2³¹ − 1 entries
  k64   ///< more memory per entry, any size
};

/// How to make a solver.
struct SolverOptions {
  Ordering ordering = Ordering::kDefault;
  IndexWidth index_width = IndexWidth::k32;
  Structure structure = Structure::kGeneral;
  /// Rows of each diagonal block in time order; empty where the matrix has no blocks  [blocks]
  std::vector<int> block_sizes = {};
};

/// Makes a solver for matrices with the pattern of A, which an automatic choice examines.
using SolverFactory =
    std::function<std::unique_ptr<LinearSolver>(const SolverOptions&, const SparseMatrix& A)>;

/// Name of a structure: "general", "block_triangular", "periodic", "definite", "quasi_definite".
[[nodiscard]] std::string_view name_of(Structure structure);
/// Name of an ordering: "default", "natural", "amd", "colamd", "metis", "nested".
[[nodiscard]] std::string_view name_of(Ordering ordering);
/// @throws InvalidInput listing the known orderings
[[nodiscard]] Ordering find_ordering(std::string_view name);

/// @param solver   its name
/// @param offered  the orderings that it offers, including kDefault
/// @throws InvalidInput listing the offered orderings if `ordering` is not among them
void refuse_other_orderings(std::string_view solver, Ordering ordering,
                            std::initializer_list<Ordering> offered);

}  // namespace hbar::solvers
