#include "hbar/core/base/scalar.h"

namespace hbar::detail {

extern const char kAlignedTo64And16 = 1;

}  // namespace hbar::detail
