// Stands in for matrix_market.cpp where CHOLMOD was not found.

#include "hbar/core/base/error.h"
#include "matrix_market.h"

namespace hbar::solver_benchmark {
namespace {

[[noreturn]] void refuse() {
  throw InvalidInput(
      "this build has no CHOLMOD, which reads and writes Matrix Market files (Debian: apt-get "
      "install libsuitesparse-dev, and configure again)");
}

}  // namespace

bool has_matrix_market() { return false; }
solvers::SparseMatrix read_matrix(const std::filesystem::path& /*file*/) { refuse(); }
Eigen::VectorXd read_vector(const std::filesystem::path& /*file*/, Eigen::Index /*rows*/) {
  refuse();
}
void write_matrix(const std::filesystem::path& /*file*/, const solvers::SparseMatrix& /*A*/,
                  const std::string& /*comment*/) {
  refuse();
}
void write_vector(const std::filesystem::path& /*file*/, const Eigen::VectorXd& /*x*/,
                  const std::string& /*comment*/) {
  refuse();
}

}  // namespace hbar::solver_benchmark
