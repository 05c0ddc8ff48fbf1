#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>
#include <random>

// planted: using-namespace
using namespace std;

namespace hbar {

void prints() {
  // planted: print
  std::cout << "a library does not speak";
  // planted: print
  std::cerr << "std::cout in a string is only a string";
  // planted: print
  printf("%d", 1);
  // planted: print
  std::puts("x");
  char text[8];
  std::snprintf(text, sizeof text, "%d", 1);  // writes into text, prints nothing
}

void leaves(bool gently) {
  // planted: exit
  if (gently) std::exit(1);
  // planted: exit
  abort();
}

void allocates() {
  // planted: naked-new
  int* a = new int(1);
  // planted: naked-new
  delete a;
  // planted: naked-new
  void* b = malloc(4);
  int* c = new int(1);  // NOLINT(hbar-naked-new): owned by a foreign smart pointer
  // NOLINTNEXTLINE(hbar-naked-new): so is this
  int* d = new int(1);
  // planted: naked-new
  int* e = new int(1);  // NOLINT(hbar-naked-new)
}

struct Pinned {
  Pinned(const Pinned&) = delete;
  void* operator new(std::size_t) = delete;
};

double draws() {
  // planted: random
  std::random_device device;
  // planted: random
  return rand();
}

// planted: todo
// TODO make this better
// TODO(#12): this one has an issue
// planted: commented-out
// double x = f(3);
// planted: commented-out
// if (x > 3) {
// A sentence may go on over a line; this one does;
// planted: commented-out
// return a;

}  // namespace hbar
