// Two fingers bring two free boxes together, faces aligned: positions of the motors and lengths of
// the phalanges are optimised, first with soft contacts, then with stiffer ones (s of (13), (14)).
//
//   cmake --build build/release --target assemble
//   build/release/examples/manipulation/assemble
//
// prints a line per iteration of Ipopt and a summary, and writes result.json, trajectory.csv and
// iterations.csv into results/assemble. doc/manipulation.md tells what is solved and found.
#include "run_task.h"
#include "tasks.h"

int main(int argc, char** argv) {
  hbar::example::prepare_process("assemble");
  return hbar::example::guarded(
      [&] { return hbar::manipulation::run_task(hbar::manipulation::assemble(), argc, argv); });
}
