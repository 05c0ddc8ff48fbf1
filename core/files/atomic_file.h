#pragma once

#include <filesystem>
#include <string_view>

namespace hbar::scene {

/// Writes a whole file or nothing: into a temporary file beside it, flushed to disk, then renamed
/// into place. A failure leaves an old file intact and no temporary one. Links are followed; an
/// existing file keeps its permissions. An existing target that is not a plain file (a pipe, a
/// terminal) is written to directly.
///
/// @param path  the file; its folder must exist
/// @param text  its new contents
/// @throws IoError with the path and the system's reason
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// Whether a temporary file can be made in a folder, and so a file be written into it.
///
/// @returns 0, or the system's error code
[[nodiscard]] int try_folder(const std::filesystem::path& folder);

/// Removes the temporary files (.hbar-tmp-*) of processes that were killed while they wrote into a
/// folder; those that are being written stay. What cannot be removed stays, too.
void remove_abandoned_files(const std::filesystem::path& folder);

}  // namespace hbar::scene
