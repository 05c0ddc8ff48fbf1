#pragma once

#include <filesystem>
#include <string>

namespace hbar::scene {

/// The bytes of a file.
///
/// @throws IoError with the path and the system's reason: missing, a directory, not readable
/// @throws std::bad_alloc
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path);

}  // namespace hbar::scene
