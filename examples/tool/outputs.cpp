#include "outputs.h"

#include <fmt/format.h>

#include <system_error>

#include "hbar/core/files/atomic_file.h"
#include "process.h"

namespace hbar::tool {

namespace fs = std::filesystem;

void check_output(const std::optional<std::string>& output, const std::vector<fs::path>& inputs) {
  if (!output || *output == "-") {
    return;
  }
  const fs::path path(*output);
  std::error_code code;
  for (const fs::path& input : inputs) {
    if (fs::equivalent(path, input, code)) {
      throw ToolError(ExitCode::kInputOutput,
                      fmt::format("{}: is an input of this run and stays as it is; name another "
                                  "file for the results",
                                  *output));
    }
  }
  if (fs::is_directory(path, code)) {
    throw ToolError(ExitCode::kInputOutput, *output + ": cannot be written: Is a directory");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!fs::is_directory(folder, code)) {
    throw ToolError(
        ExitCode::kInputOutput,
        fmt::format("{}: cannot be written: there is no folder {}", *output, folder.string()));
  }
}

void check_distinct(const std::string& option_a, const std::optional<std::string>& a,
                    const std::string& option_b, const std::optional<std::string>& b) {
  std::error_code code;
  if (a && b && fs::weakly_canonical(*a, code) == fs::weakly_canonical(*b, code)) {
    throw ToolError(ExitCode::kUsage,
                    fmt::format("{} and {} name the same file", option_a, option_b));
  }
}

void write_output(const std::string& output, const std::string& text) {
  if (output == "-") {
    write_stdout(text);
  } else {
    scene::write_file_atomically(output, text);
  }
}

void make_output_folder(const std::string& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) {
    throw ToolError(ExitCode::kInputOutput,
                    fmt::format("{}: the folder cannot be made: {}", folder, code.message()));
  }
}

}  // namespace hbar::tool
