#include "hbar/core/error.h"
#include "hbar/core/scalar.h"

// What a stranger would do first. Exits with 0 if hbar answers rightly.
int main() {
  const hbar::Dual x(4.0, 1.0);
  return sqrt(x).slope == 0.25 ? 0 : 1;
}
