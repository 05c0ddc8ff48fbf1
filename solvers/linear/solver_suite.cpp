#include "hbar/solvers/linear/solver_suite.h"

#include "hbar/solvers/linear/block_banded.h"
#include "hbar/solvers/linear/cholmod.h"
#include "hbar/solvers/linear/eigen_sparse_lu.h"
#include "hbar/solvers/linear/lapack_band.h"
#include "hbar/solvers/linear/mumps.h"
#include "hbar/solvers/linear/solver_catalogue.h"
#include "hbar/solvers/linear/spqr.h"
#include "hbar/solvers/linear/umfpack.h"

namespace hbar::solvers {

bool register_suite() {
  register_solver("block_banded", make_block_banded);
  register_solver("eigen_sparse_lu", make_eigen_sparse_lu);
#ifdef HBAR_HAVE_UMFPACK
  register_umfpack();
#endif
#ifdef HBAR_HAVE_CHOLMOD
  register_solver("cholmod_llt", make_cholmod_llt);
  register_solver("cholmod_supernodal", make_cholmod_supernodal);
  register_solver("cholmod_ldlt", make_cholmod_ldlt);
  register_solver("cholmod_normal", make_cholmod_normal);
#endif
#ifdef HBAR_HAVE_SPQR
  register_solver("spqr", make_spqr);
#endif
#ifdef HBAR_HAVE_LAPACK
  register_solver("lapack_band", make_lapack_band);
#endif
#ifdef HBAR_HAVE_MUMPS
  register_solver("mumps", make_mumps);
#endif
  return true;
}

}  // namespace hbar::solvers
