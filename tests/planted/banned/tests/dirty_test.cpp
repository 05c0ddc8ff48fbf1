#include <iostream>

// planted: using-namespace
using namespace hbar;

void in_a_function() {
  using namespace hbar;
  std::cout << "a test may";
  // planted: random
  srand(3);
}
