#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace hbar::scene {

/// Whether two names lead to one file, whether or not it is there yet.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Refuses, before work begins, a file that write_result_file could not write when it is done, and
/// one that the work reads. Removes what earlier runs left behind when they were killed.
///
/// @param path    the result; its folder must exist
/// @param inputs  files that the work reads
/// @throws IoError with the path and the reason
void expect_result_file(const std::filesystem::path& path,
                        const std::vector<std::filesystem::path>& inputs = {});

/// Writes a result as write_file_atomically does. If that fails, the text goes to NAME.rescued in
/// the current folder or else in $TMPDIR (/tmp), to NAME.rescued.2 and so on where earlier ones
/// are.
///
/// @param path  the result
/// @param text  its contents
/// @throws IoError with the path, the reason, and where the text was saved instead
void write_result_file(const std::filesystem::path& path, std::string_view text);

}  // namespace hbar::scene
