#pragma once

#include <filesystem>
#include <string>

namespace hbar::solver_benchmark {

/// The bytes of a file that gzip compressed (RFC 1952), as zlib reads it; of another file, its own
/// bytes.
///
/// @throws IoError with the path and the reason: missing, cut off, damaged (the checksum that gzip
///         keeps), or more than 4 GiB
/// @throws InvalidInput in a build without zlib
[[nodiscard]] std::string read_gzip_file(const std::filesystem::path& path);

}  // namespace hbar::solver_benchmark
