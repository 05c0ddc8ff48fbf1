#include "hbar/solvers/linear/mutual_exclusion.h"

namespace hbar::solvers {

std::mutex& mumps_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace hbar::solvers
