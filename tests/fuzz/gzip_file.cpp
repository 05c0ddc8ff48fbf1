// A file that gzip compressed, or any other.

#include "examples/solver_benchmark/gzip_file.h"

#include "hbar/core/base/error.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

void hbar::fuzz::try_input(std::string_view input) {
  static const ScratchFolder kFolder;
  std::string text;
  try {
    text = solver_benchmark::read_gzip_file(kFolder.put("matrix.mtx.gz", input));
  } catch (const IoError&) {
    return;  // a damaged one
  }
  require(input.starts_with("\x1f\x8b") || text == input,
          "what is not compressed is read as it is");
}
