#include "hbar/solvers/solver_suite.h"

#include <algorithm>

#include "hbar/solvers/block_substitution.h"
#include "hbar/solvers/cholmod.h"
#include "hbar/solvers/klu.h"
#include "hbar/solvers/spqr.h"
#ifdef HBAR_HAVE_UMFPACK
#include "hbar/solvers/umfpack.h"
#endif

namespace hbar::solvers {
namespace {

using Make = std::unique_ptr<LinearSolver> (*)(const SolverOptions&);

const std::vector<Structure> kEvery = {Structure::kGeneral, Structure::kBlockTriangular,
                                       Structure::kPeriodic, Structure::kDefinite,
                                       Structure::kQuasiDefinite};

std::unique_ptr<LinearSolver> make_substitution(const SolverOptions& options) {
  return make_block_substitution(options.block_sizes);
}

// What this build can make; nullptr where the library behind a solver was not there.
#ifdef HBAR_HAVE_UMFPACK
constexpr Make kUmfpack = make_umfpack;
#else
constexpr Make kUmfpack = nullptr;
#endif
#ifdef HBAR_HAVE_CHOLMOD
constexpr Make kCholmodLlt = make_cholmod_llt;
constexpr Make kCholmodSupernodal = make_cholmod_supernodal;
constexpr Make kCholmodLdlt = make_cholmod_ldlt;
constexpr Make kCholmodNormal = make_cholmod_normal;
#else
constexpr Make kCholmodLlt = nullptr;
constexpr Make kCholmodSupernodal = nullptr;
constexpr Make kCholmodLdlt = nullptr;
constexpr Make kCholmodNormal = nullptr;
#endif
#ifdef HBAR_HAVE_SPQR
constexpr Make kSpqr = make_spqr;
#else
constexpr Make kSpqr = nullptr;
#endif

/// Every solver that a build can have; `make` is nullptr where this one does not.
std::vector<SolverEntry> every_solver() {
  using enum Structure;
  using enum Ordering;
  return {
      {"block_substitution",
       "dense LU of the diagonal blocks, then substitution",
       "MIT",
       {kBlockTriangular},
       {kDefault, kNatural},
       false,
       make_substitution},
      {"klu",
       "sparse LU by block triangular form, without BLAS",
       "LGPL-2.1-or-later",
       kEvery,
       {kDefault},
       false,
       [](const SolverOptions& options) { return make_klu(options); }},
      {"umfpack",
       "multifrontal sparse LU",
       "GPL-2.0-or-later",
       kEvery,
       {kDefault},
       false,
       kUmfpack},
      {"cholmod_llt",
       "simplicial Cholesky factors, without BLAS",
       "LGPL-2.1-or-later",
       {kDefinite},
       {kDefault, kNatural, kAmd, kMetis, kNested},
       true,
       kCholmodLlt},
      {"cholmod_supernodal",
       "Cholesky factors of dense blocks",
       "GPL-2.0-or-later",
       {kDefinite},
       {kDefault, kNatural, kAmd, kMetis, kNested},
       true,
       kCholmodSupernodal},
      {"cholmod_ldlt",
       "simplicial LDL' without pivoting, and the inertia",
       "LGPL-2.1-or-later",
       {kDefinite, kQuasiDefinite},
       {kDefault, kNatural, kAmd, kMetis, kNested},
       true,
       kCholmodLdlt},
      {"cholmod_normal",
       "Cholesky factors of A A': squares the condition number",
       "LGPL-2.1-or-later",
       kEvery,
       {kDefault, kNatural, kAmd, kColamd, kMetis, kNested},
       true,
       kCholmodNormal},
      {"spqr",
       "multifrontal sparse QR",
       "GPL-2.0-or-later",
       kEvery,
       {kDefault, kNatural, kAmd, kColamd, kMetis},
       true,
       kSpqr},
  };
}

}  // namespace

bool SolverEntry::claims(Structure structure) const {
  return std::find(structures.begin(), structures.end(), structure) != structures.end();
}

bool SolverEntry::offers(Ordering ordering) const {
  return std::find(orderings.begin(), orderings.end(), ordering) != orderings.end();
}

const std::vector<SolverEntry>& solver_suite() {
  static const std::vector<SolverEntry> suite = [] {
    std::vector<SolverEntry> entries = every_solver();
    std::erase_if(entries, [](const SolverEntry& entry) { return entry.make == nullptr; });
    return entries;
  }();
  return suite;
}

const SolverEntry& find_solver(std::string_view name) {
  const auto named = [name](const SolverEntry& entry) { return entry.name == name; };
  const std::vector<SolverEntry>& suite = solver_suite();
  const auto found = std::find_if(suite.begin(), suite.end(), named);
  if (found != suite.end()) return *found;

  std::string known;
  for (const SolverEntry& entry : suite) known += concat(' ', entry.name);
  std::string left_out;
  for (const SolverEntry& entry : every_solver()) {
    if (entry.make != nullptr) continue;
    if (entry.name == name) {
      throw InvalidInput(concat("this build was made without the solver \"", name,
                                "\": its library was not found; it has:", known));
    }
    left_out += concat(' ', entry.name);
  }
  throw InvalidInput(concat("there is no solver \"", name, "\"; known: auto", known,
                            left_out.empty() ? "" : "; left out of this build:", left_out));
}

SolverChoice choose_solver(const SolverOptions& options, const SparseMatrix& /*A*/) {
  if (options.structure == Structure::kBlockTriangular && !options.block_sizes.empty()) {
    return {"block_substitution", Ordering::kDefault, "block triangular: there is no fill"};
  }
  return {"klu", Ordering::kDefault, "nothing is known that a more special solver could use"};
}

std::unique_ptr<LinearSolver> make_solver(std::string_view name, const SolverOptions& options,
                                          const SparseMatrix& A) {
  if (name == "auto") {
    const SolverChoice choice = choose_solver(options, A);
    SolverOptions chosen = options;
    if (chosen.ordering == Ordering::kDefault) chosen.ordering = choice.ordering;
    return find_solver(choice.name).make(chosen);
  }
  const SolverEntry& entry = find_solver(name);
  if (!entry.claims(options.structure)) {
    throw InvalidInput(concat(name, " is not for ", name_of(options.structure), " matrices"));
  }
  return entry.make(options);
}

SolverFactory solver_factory(std::string_view name, Ordering ordering) {
  if (name != "auto") static_cast<void>(find_solver(name));
  return [name = std::string(name), ordering](SolverOptions options, const SparseMatrix& A) {
    options.ordering = ordering;
    return make_solver(name, options, A);
  };
}

}  // namespace hbar::solvers
