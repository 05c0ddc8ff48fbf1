// Stands in for gzip_file.cpp where zlib was not found.

#include "gzip_file.h"
#include "hbar/core/base/error.h"

namespace hbar::solver_benchmark {

std::string read_gzip_file(const std::filesystem::path& path) {
  throw InvalidInput(concat(path.string(),
                            ": this build has no zlib, which reads compressed files (Debian: "
                            "apt-get install zlib1g-dev, and configure again)"));
}

}  // namespace hbar::solver_benchmark
