#include "hbar/core/files/text_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include "hbar/core/base/error.h"

namespace hbar::scene {

std::string read_text_file(const std::filesystem::path& path) {
  const auto reason = [](int code) { return std::generic_category().message(code); };
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "rb"));
  if (!file && errno == ENOMEM) {
    throw std::bad_alloc();
  }
  if (!file) {
    throw IoError(concat(path.string(), ": cannot be opened: ", reason(errno)));
  }
  std::string text;
  std::array<char, 1 << 16> buffer;
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), file.get())) > 0) {
    text.append(buffer.data(), count);
  }
  if (std::ferror(file.get()) != 0) {
    throw IoError(concat(path.string(), ": cannot be read: ", reason(errno)));
  }
  return text;
}

}  // namespace hbar::scene
