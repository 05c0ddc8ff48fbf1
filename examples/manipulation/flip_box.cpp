// Flips a free box over its edge with the finger of rotate_box: positions of the motors and lengths
// of the phalanges are optimised together; from the first guess the box falls back.
//
//   cmake --build build/release --target flip_box
//   build/release/examples/manipulation/flip_box
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, trajectory.csv and
// iterations.csv into results/flip_box. doc/manipulation.md tells what is solved and found.
#include "run_task.h"
#include "tasks.h"

int main(int argc, char** argv) {
  hbar::example::prepare_process("flip_box");
  return hbar::example::guarded(
      [&] { return hbar::manipulation::run_task(hbar::manipulation::flip_box(), argc, argv); });
}
