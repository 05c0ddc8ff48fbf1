#include "hbar/core/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

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

TEST(AtomicFile, AFileThatIsBeingWrittenIsNotAbandoned) {
  const TemporaryFolder folder;
  std::string name = (folder / ".hbar-tmp-XXXXXX").string();
  const int written = ::mkstemp(name.data());
  ASSERT_GE(written, 0);
  ASSERT_EQ(::flock(written, LOCK_EX), 0);
  remove_abandoned_files(folder.path());
  EXPECT_TRUE(fs::exists(name));
  ::close(written);  // as when its process was killed
  remove_abandoned_files(folder.path());
  EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, WritersAndCleanersDoNotDisturbEachOther) {
  const TemporaryFolder folder;
  std::atomic<bool> done = false;
  std::thread cleaner([&] {
    while (!done) {
      remove_abandoned_files(folder.path());
    }
  });
  int right = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string text = std::to_string(i);
    right += write_refusal(folder / "a", text) == "was written" ? 1 : 0;
    right += read_text_file(folder / "a") == text ? 1 : 0;
  }
  done = true;
  cleaner.join();
  EXPECT_EQ(right, 600);
  EXPECT_EQ(folder.count(), 1);
}

}  // namespace
}  // namespace hbar::scene
