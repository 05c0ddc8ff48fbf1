#include "hbar/core/files/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

constexpr std::string_view kTemporary = ".hbar-tmp-";

/// An open file that is closed, and a temporary one removed, when this goes out of scope.
class OpenFile {
 public:
  OpenFile(int descriptor, std::string temporary)
      : descriptor_(descriptor), temporary_(std::move(temporary)) {}
  OpenFile(OpenFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)),
        temporary_(std::exchange(other.temporary_, "")) {}
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    if (!temporary_.empty()) {
      ::unlink(temporary_.c_str());
    }
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  /// 0, or the system's error code.
  int close() {
    const int failed = ::close(descriptor_);
    descriptor_ = -1;
    return failed == 0 ? 0 : errno;
  }
  /// The temporary file has become the real one.
  void keep() { temporary_.clear(); }

 private:
  int descriptor_;
  std::string temporary_;
};

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int code) {
  throw IoError(
      concat(path.string(), ": cannot be ", what, ": ", std::generic_category().message(code)));
}

void write_all(int descriptor, std::string_view text, const std::filesystem::path& path) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      fail(path, "written", errno);
    }
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

void write_directly(const std::filesystem::path& path, std::string_view text) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) {
    fail(path, "opened", errno);
  }
  OpenFile file(descriptor, "");
  write_all(descriptor, text, path);
  if (const int code = file.close()) {
    fail(path, "written", code);
  }
}

/// The permissions a new file would get.
mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

/// A new temporary file: its descriptor and its name; −1 and errno if there is none.
std::pair<int, std::string> make_temporary(const std::filesystem::path& folder) {
  std::string name = (folder / kTemporary).string() + "XXXXXX";
  const int descriptor = ::mkstemp(name.data());
  return {descriptor, std::move(name)};
}

/// A new file beside `real`, locked while it is open: what nobody locks was left by a process that
/// was killed. Between being made and locked it may have been removed as such; then it has no name.
OpenFile open_temporary(const std::filesystem::path& real, const std::filesystem::path& path) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const auto [descriptor, name] = make_temporary(real.parent_path());
    if (descriptor < 0) {
      fail(path, "written", errno);
    }
    OpenFile file(descriptor, name);
    struct stat status = {};
    ::flock(descriptor, LOCK_EX);  // some file systems have no locks; nor do they tell apart then
    if (::fstat(descriptor, &status) != 0 || status.st_nlink > 0) {
      return file;
    }
    file.keep();
  }
  fail(path, "written", EBUSY);
}

}  // namespace

int try_folder(const std::filesystem::path& folder) {
  const auto [descriptor, name] = make_temporary(folder);
  if (descriptor < 0) {
    return errno;
  }
  const OpenFile removed(descriptor, name);
  return 0;
}

void remove_abandoned_files(const std::filesystem::path& folder) {
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(
      ::opendir(folder.empty() ? "." : folder.c_str()), ::closedir);
  if (entries == nullptr) {
    return;
  }
  const int place = ::dirfd(entries.get());
  while (const dirent* entry = ::readdir(entries.get())) {
    if (!std::string_view(entry->d_name).starts_with(kTemporary)) {
      continue;
    }
    const int descriptor = ::openat(place, entry->d_name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (descriptor < 0) {
      continue;
    }
    const OpenFile file(descriptor, "");
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
      ::unlinkat(place, entry->d_name, 0);
    }
  }
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  if (path.empty()) {
    fail("(no name)", "written", ENOENT);
  }
  struct stat status = {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    fail(path, "written", EISDIR);
  }
  if (exists && !S_ISREG(status.st_mode)) {
    return write_directly(path, text);
  }

  std::error_code ignored;
  const std::filesystem::path target = exists ? std::filesystem::canonical(path, ignored) : path;
  const std::filesystem::path& real = target.empty() ? path : target;
  OpenFile file = open_temporary(real, path);
  const int descriptor = file.descriptor();

  write_all(descriptor, text, path);
  const mode_t mode = exists ? (status.st_mode & 07777) : new_file_mode();
  if (::fchmod(descriptor, mode) != 0) {
    fail(path, "written", errno);
  }
  if (::fsync(descriptor) != 0) {
    fail(path, "written", errno);
  }
  // Closing may tell of a lost write. The lock belongs to the duplicate, too, and stays until the
  // file has its name.
  const OpenFile lock(::dup(descriptor), "");
  if (const int code = file.close()) {
    fail(path, "written", code);
  }
  if (::rename(file.temporary().c_str(), real.c_str()) != 0) {
    fail(path, "written", errno);
  }
  file.keep();

  const std::filesystem::path folder = real.has_parent_path() ? real.parent_path() : ".";
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle >= 0) {  // the rename itself reaches the disk; not every file system can promise it
    ::fsync(handle);
    ::close(handle);
  }
}

}  // namespace hbar::scene
