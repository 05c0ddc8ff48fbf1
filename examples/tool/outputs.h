#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hbar::tool {

/// Refuses, before anything is computed, a result file that could not be written or that is one of
/// the files read.
///
/// @param output  a file; "-" is standard output
/// @param inputs  files that the run reads
/// @throws IoError
void check_output(const std::optional<std::string>& output,
                  const std::vector<std::filesystem::path>& inputs);

/// Refuses two results that would go to one file.
///
/// @throws ProgramError (kUsage) naming the two options
void check_distinct(const std::string& option_a, const std::optional<std::string>& a,
                    const std::string& option_b, const std::optional<std::string>& b);

/// Writes a text to standard output ("-") or as a result file (example::write_result).
void write_output(const std::string& output, const std::string& text);

}  // namespace hbar::tool
