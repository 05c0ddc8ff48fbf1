#include <cstdio>
#include <string>

#include "hbar/hbar.h"

// With hbar::hbar alone, what belongs to a component is refused with the component's name and
// package.
int main() {
  try {
    static_cast<void>(hbar::solver_factory("umfpack"));
  } catch (const hbar::InvalidInput& refusal) {
    const std::string message = refusal.what();
    std::printf("alone: %s\n", message.c_str());
    return message.find("hbar/umfpack.h") != std::string::npos &&
                   message.find("hbar::umfpack") != std::string::npos &&
                   message.find("libsuitesparse-dev") != std::string::npos
               ? 0
               : 1;
  }
  return 1;
}
