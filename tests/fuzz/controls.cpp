// The file of controls that the hbar command reads.

#include "examples/common/process.h"
#include "examples/tool/inputs.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {

void try_input(std::string_view input) {
  static const ScratchFolder kFolder;
  tool::Arguments arguments;
  arguments.command = tool::Command::kSimulate;
  arguments.scene = HBAR_SOURCE_DIR "/examples/scenes/finger.xml";
  arguments.load.steps = 3;
  arguments.controls = kFolder.put("controls.csv", input).string();
  try {
    const Inputs inputs = tool::load(arguments).problem.inputs;
    require(inputs.u.cols() == 3 && inputs.u.allFinite(), "controls that are not finite");
  } catch (const example::ProgramError& error) {
    require(error.code() == example::ExitCode::kBadScene, "the file is not to blame");
    require(*error.what() != '\0', "a refusal without a message");
  }
}

}  // namespace hbar::fuzz
