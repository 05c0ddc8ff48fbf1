// The hbar command's line, a word in each line of the input.

#include "examples/tool/arguments.h"

#include "examples/common/process.h"
#include "examples/tool/inputs.h"
#include "tests/fuzz/target.h"

namespace hbar::fuzz {
namespace {

constexpr int kMostSteps = 1000;

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    // A word ends with its zero, as the system hands it over.
    lines.emplace_back(line.substr(0, line.find('\0')));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return lines;
}

}  // namespace

void try_input(std::string_view input) {
  const std::vector<std::string> words = lines_of(input);
  std::vector<const char*> argv = {"hbar"};
  for (const std::string& word : words) {
    argv.push_back(word.c_str());
  }
  try {
    tool::CommandLine line = tool::parse_arguments(static_cast<int>(argv.size()), argv.data());
    auto* const arguments = std::get_if<tool::Arguments>(&line);
    if (arguments == nullptr || arguments->load.steps > kMostSteps) {
      return;
    }
    // Options that must suit the scene; files are another target's.
    arguments->scene = HBAR_SOURCE_DIR "/examples/scenes/finger.xml";
    arguments->controls.reset();
    const LoadedProblem loaded = tool::load(*arguments);
    require(loaded.problem.inputs.q0.allFinite(), "a state that is not finite");
  } catch (const example::ProgramError& error) {
    require(error.code() == example::ExitCode::kUsage, "the command line is not to blame");
    require(*error.what() != '\0', "a refusal without a message");
  }
}

}  // namespace hbar::fuzz
