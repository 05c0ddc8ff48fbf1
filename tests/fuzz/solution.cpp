// A solution of a nonlinear program in a file.

#include "hbar/adjoint/study/solution_file.h"
#include "hbar/core/files/text_file.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {

void try_input(std::string_view input) {
  static const ScratchFolder kFolder;
  const auto file = kFolder.put("solution", input);
  const study::Solution solution = study::read_solution(file);
  const auto written = kFolder.path() / "written";
  study::save_solution(written, solution);
  const std::string text = scene::read_text_file(written);
  const study::Solution again = study::read_solution(written);
  require(again.point.x == solution.point.x &&
              again.point.constraint_multipliers == solution.point.constraint_multipliers &&
              again.point.lower_multipliers == solution.point.lower_multipliers &&
              again.point.upper_multipliers == solution.point.upper_multipliers &&
              again.point.mu == solution.point.mu && again.objective == solution.objective,
          "numbers are read differently");
  require(again.variable_names == solution.variable_names &&
              again.constraint_names == solution.constraint_names &&
              again.status == solution.status && again.about == solution.about,
          "texts are read differently");
  study::save_solution(written, again);
  require(scene::read_text_file(written) == text, "a solution is written differently");
}

}  // namespace hbar::fuzz
