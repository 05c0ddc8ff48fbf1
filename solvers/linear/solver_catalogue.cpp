#include "hbar/solvers/linear/solver_catalogue.h"

#include <algorithm>
#include <utility>

#include "hbar/solvers/linear/block_substitution.h"
#include "hbar/solvers/linear/klu.h"

namespace hbar::solvers {
namespace {

std::unique_ptr<LinearSolver> make_substitution(const SolverOptions& options) {
  return make_block_substitution(options.block_sizes);
}

std::vector<SolverEntry> every_solver() {
  using enum Structure;
  using enum Ordering;
  using Structures = std::vector<Structure>;
  using Orderings = std::vector<Ordering>;
  const Structures any = {kGeneral, kBlockTriangular, kPeriodic, kDefinite, kQuasiDefinite};
  const Structures band = {kGeneral, kBlockTriangular, kDefinite, kQuasiDefinite};
  const Structures triangle = {kBlockTriangular};
  const Structures definite = {kDefinite};
  const Structures symmetric = {kDefinite, kQuasiDefinite};
  const Orderings as_given = {kDefault, kNatural};
  const Orderings minimum = {kDefault, kNatural, kAmd, kColamd};
  const Orderings of_mumps = {kDefault, kNatural, kAmd, kMetis};
  const Orderings unnested = {kDefault, kNatural, kAmd, kColamd, kMetis};
  const Orderings nested = {kDefault, kNatural, kAmd, kMetis, kNested};
  const Orderings every = {kDefault, kNatural, kAmd, kColamd, kMetis, kNested};
  const char* own = "BSD-2-Clause";
  const char* lgpl = "LGPL-2.1-or-later";
  const char* gpl = "GPL-2.0-or-later";
  const char* suitesparse = "libsuitesparse-dev";
  return {
      {"block_substitution", "dense LU of the diagonal blocks, then substitution", own, "solvers",
       "", triangle, as_given, true, make_substitution},
      {"block_banded", "dense LU of block columns, for bands", own, "suite", "", band, as_given,
       true},
      {"lapack_band", "LAPACK's LU of a band", "BSD-3-Clause", "suite", "liblapack-dev", band,
       as_given, false},
      {"klu", "SuiteSparse's LU by block triangular form, without BLAS", lgpl, "solvers",
       suitesparse, any, minimum, true, make_klu},
      {"umfpack", "SuiteSparse's multifrontal LU", gpl, "umfpack", suitesparse, any, unnested,
       true},
      {"eigen_sparse_lu", "Eigen's supernodal LU", "MPL-2.0", "suite", "", any, minimum, true},
      {"mumps", "MUMPS' multifrontal LU, or LDL' of a symmetric matrix", "CECILL-C", "suite",
       "libmumps-seq-dev", any, of_mumps, true},
      {"cholmod_llt", "SuiteSparse's Cholesky factors, a column at a time", lgpl, "suite",
       suitesparse, definite, nested, true},
      {"cholmod_supernodal", "SuiteSparse's Cholesky factors, by dense blocks", gpl, "suite",
       suitesparse, definite, nested, true},
      {"cholmod_ldlt", "SuiteSparse's LDL' without pivoting, which tells the inertia", lgpl,
       "suite", suitesparse, symmetric, nested, true},
      {"cholmod_normal", "SuiteSparse's Cholesky factors of A A': half the digits are lost", lgpl,
       "suite", suitesparse, any, every, true},
      {"spqr", "SuiteSparse's multifrontal QR", gpl, "suite", suitesparse, any, unnested, true},
  };
}

std::vector<SolverEntry>& catalogue() {
  static std::vector<SolverEntry> entries = every_solver();
  return entries;
}

/// The entry of that name; the end if there is none.
auto entry_named(std::string_view name) {
  std::vector<SolverEntry>& entries = catalogue();
  return std::find_if(entries.begin(), entries.end(),
                      [name](const SolverEntry& entry) { return entry.name == name; });
}

std::string names_of_available() {
  std::string names;
  for (const SolverEntry& entry : available_solvers()) {
    names += concat(' ', entry.name);
  }
  return names;
}

}  // namespace

bool SolverEntry::claims(Structure structure) const {
  return std::find(structures.begin(), structures.end(), structure) != structures.end();
}

bool SolverEntry::offers(Ordering ordering) const {
  return std::find(orderings.begin(), orderings.end(), ordering) != orderings.end();
}

std::vector<SolverEntry> available_solvers() {
  std::vector<SolverEntry> entries = catalogue();
  std::erase_if(entries, [](const SolverEntry& entry) { return entry.make == nullptr; });
  return entries;
}

const SolverEntry& find_solver(std::string_view name) {
  const auto found = entry_named(name);
  if (found == catalogue().end()) {
    throw InvalidInput(
        concat("there is no solver \"", name, "\"; known: auto", names_of_available()));
  }
  if (found->make == nullptr) {
    const std::string& component = found->component;
    throw InvalidInput(concat("the solver \"", name, "\" is not in this program: include \"hbar/",
                              component, ".h\" and link hbar::", component,
                              found->package.empty()
                                  ? std::string()
                                  : concat(", built where ", found->package, " is installed"),
                              "; there are: auto", names_of_available()));
  }
  return *found;
}

bool register_solver(std::string_view name, MakeSolver make) {
  const auto found = entry_named(name);
  if (found == catalogue().end()) {
    throw InvalidInput(concat("register_solver: the catalogue has no solver \"", name, '"'));
  }
  found->make = make;
  return true;
}

}  // namespace hbar::solvers
