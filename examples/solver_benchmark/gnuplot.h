#pragma once

#include <filesystem>
#include <string>

namespace hbar::solver_benchmark {

/// Whether gnuplot is on the PATH.
[[nodiscard]] bool has_gnuplot();

/// Runs `gnuplot SCRIPT` in a folder and waits for its end.
///
/// @param folder  where the script is, and what it names files from
/// @param script  name of the script in the folder
/// @throws IoError if gnuplot is not installed, or says that something is wrong
void run_gnuplot(const std::filesystem::path& folder, const std::string& script);

/// A text as gnuplot reads it: 'in quotes'.
[[nodiscard]] std::string quoted(const std::string& text);

/// A text as the name of a file, whatever the text: letters, digits, _ and - stay.
[[nodiscard]] std::string file_name(std::string text);

}  // namespace hbar::solver_benchmark
