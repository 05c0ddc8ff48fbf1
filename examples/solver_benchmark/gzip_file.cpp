#include "gzip_file.h"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>

#include "hbar/core/base/error.h"

namespace hbar::solver_benchmark {
namespace {

// What a few kilobytes may claim to hold; matrices whose entries an int can count are smaller.
constexpr std::size_t kMostBytes = std::size_t{1} << 32;

struct Close {
  void operator()(gzFile file) const { ::gzclose(file); }
};

}  // namespace

std::string read_gzip_file(const std::filesystem::path& path) {
  errno = 0;
  const std::unique_ptr<gzFile_s, Close> file(::gzopen(path.c_str(), "rb"));
  if (file == nullptr) {
    if (errno == 0 || errno == ENOMEM) {  // zlib tells its own want of memory by no code
      throw std::bad_alloc();
    }
    throw IoError(concat(path.string(), ": cannot be opened: ", std::strerror(errno)));
  }
  std::string text;
  std::array<char, 1 << 16> buffer;
  int count = 0;
  while ((count = ::gzread(file.get(), buffer.data(), buffer.size())) > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(count));
    if (text.size() > kMostBytes) {
      throw IoError(concat(path.string(), ": holds more than ", kMostBytes, " bytes"));
    }
  }
  int code = Z_OK;
  const char* reason = ::gzerror(file.get(), &code);
  if (code == Z_MEM_ERROR) {
    throw std::bad_alloc();
  }
  if (code == Z_ERRNO) {
    throw IoError(concat(path.string(), ": cannot be read: ", std::strerror(errno)));
  }
  if (code != Z_OK && code != Z_STREAM_END) {
    throw IoError(concat(
        path.string(), ": is damaged: ", code == Z_BUF_ERROR ? "it ends before its time" : reason));
  }
  return text;
}

}  // namespace hbar::solver_benchmark
