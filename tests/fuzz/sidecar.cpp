// The JSON file beside a Matrix Market file.

#include "examples/solver_benchmark/sidecar.h"

#include "hbar/core/base/error.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {

void try_input(std::string_view input) {
  static const ScratchFolder kFolder;
  solver_benchmark::BenchmarkMatrix matrix;
  matrix.A.resize(6, 6);
  matrix.A.setIdentity();
  solver_benchmark::BenchmarkMatrix again = matrix;
  solver_benchmark::read_sidecar(kFolder.put("matrix.json", input), matrix);
  const std::string text = solver_benchmark::sidecar_json(matrix, 0.0);
  try {
    solver_benchmark::read_sidecar(kFolder.put("written.json", text), again);
  } catch (const InvalidInput& error) {
    fail(concat("what was read and written is refused: ", error.what()));
  }
  require(again.options.block_sizes == matrix.options.block_sizes &&
              again.options.structure == matrix.options.structure,
          "blocks or structure are read differently");
  require(solver_benchmark::sidecar_json(again, 0.0) == text, "it is written differently");
}

}  // namespace hbar::fuzz
