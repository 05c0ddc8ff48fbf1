// Turns a free box on the ground by 90 degrees about the vertical with a finger of three phalanges
// on a planar base: the positions its motors go to and the lengths of the phalanges are optimised
// together, through making, keeping and breaking contact.
//
//   cmake --build build/release --target rotate_box
//   build/release/examples/manipulation/rotate_box
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, trajectory.csv and
// iterations.csv into results/rotate_box. doc/manipulation.md tells what is solved and found.
#include "run_task.h"
#include "tasks.h"

int main(int argc, char** argv) {
  hbar::example::prepare_process("rotate_box");
  return hbar::example::guarded(
      [&] { return hbar::manipulation::run_task(hbar::manipulation::rotate_box(), argc, argv); });
}
