#include "outputs.h"

#include <fmt/format.h>

#include "examples/common/process.h"
#include "hbar/core/files/result_file.h"

namespace hbar::tool {

void check_output(const std::optional<std::string>& output,
                  const std::vector<std::filesystem::path>& inputs) {
  if (output && *output != "-") {
    scene::expect_result_file(*output, inputs);
  }
}

void check_distinct(const std::string& option_a, const std::optional<std::string>& a,
                    const std::string& option_b, const std::optional<std::string>& b) {
  if (a && b && scene::is_same_file(*a, *b)) {
    throw example::ProgramError(example::ExitCode::kUsage,
                                fmt::format("{} and {} name the same file", option_a, option_b));
  }
}

void write_output(const std::string& output, const std::string& text) {
  if (output == "-") {
    example::print(text);
  } else {
    example::write_result(output, text);
  }
}

}  // namespace hbar::tool
