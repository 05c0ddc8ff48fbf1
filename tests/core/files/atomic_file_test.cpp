#include "hbar/core/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "hbar/core/base/error.h"
#include "hbar/core/files/text_file.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

namespace fs = std::filesystem;

std::string write_refusal(const fs::path& path, const std::string& text = "text") {
  try {
    write_file_atomically(path, text);
  } catch (const IoError& error) {
    return error.what();
  }
  return "was written";
}

TEST(AtomicFile, IsWrittenAndReplaced) {
  const TemporaryFolder folder;
  write_file_atomically(folder / "a", "one");
  EXPECT_EQ(read_text_file(folder / "a"), "one");
  write_file_atomically(folder / "a", std::string(300000, 'y'));
  EXPECT_EQ(read_text_file(folder / "a"), std::string(300000, 'y'));
  write_file_atomically(folder / "a", "");
  EXPECT_EQ(read_text_file(folder / "a"), "");
  EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, KeepsPermissionsAndLinks) {
  const TemporaryFolder folder;
  write_file_atomically(folder / "a", "one");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a", folder / "link");
  write_file_atomically(folder / "link", "two");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text_file(folder / "a"), "two");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(folder.count(), 2);
}

TEST(AtomicFile, GetsThePermissionsOfANewFile) {
  const TemporaryFolder folder;
  const mode_t old = ::umask(0027);
  write_file_atomically(folder / "a", "one");
  ::umask(old);
  EXPECT_EQ(static_cast<unsigned>(fs::status(folder / "a").permissions()), 0640U);
}

TEST(AtomicFile, SaysWhyItCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_EQ(write_refusal("/no/such/folder/a"),
            "/no/such/folder/a: cannot be written: No such file or directory");
  EXPECT_EQ(write_refusal("/"), "/: cannot be written: Is a directory");
  EXPECT_EQ(write_refusal(""), "(no name): cannot be written: No such file or directory");
  EXPECT_EQ(write_refusal("/dev/full"), "/dev/full: cannot be written: No space left on device");
  EXPECT_EQ(write_refusal("/dev/null"), "was written");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, AFailedWriteLeavesTheOldFileAlone) {
  const TemporaryFolder folder;
  write_file_atomically(folder / "a", "old");
  rlimit old_limit = {};
  ::getrlimit(RLIMIT_FSIZE, &old_limit);
  const rlimit small = {1000, old_limit.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = write_refusal(folder / "a", std::string(5000, 'z'));
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(message, (folder / "a").string() + ": cannot be written: File too large");
  EXPECT_EQ(read_text_file(folder / "a"), "old");
  EXPECT_EQ(folder.count(), 1);
}

}  // namespace
}  // namespace hbar::scene
