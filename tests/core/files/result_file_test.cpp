#include "hbar/core/files/result_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/text_file.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

namespace fs = std::filesystem;

/// A test in a current folder of its own, with $TMPDIR inside it.
class ResultFile : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = fs::current_path();
    fs::create_directory(folder_ / "here");
    fs::create_directory(folder_ / "tmp");
    fs::current_path(folder_ / "here");
    const char* tmp = std::getenv("TMPDIR");
    had_tmp_ = tmp != nullptr;
    old_tmp_ = had_tmp_ ? tmp : "";
    ::setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
  }
  void TearDown() override {
    fs::current_path(before_);
    had_tmp_ ? ::setenv("TMPDIR", old_tmp_.c_str(), 1) : ::unsetenv("TMPDIR");
  }
  static std::string refusal(const fs::path& path, const std::vector<fs::path>& inputs = {}) {
    return testing::message_of<IoError>([&] { expect_result_file(path, inputs); });
  }

  const TemporaryFolder folder_;
  fs::path before_;
  bool had_tmp_ = false;
  std::string old_tmp_;
};

TEST_F(ResultFile, KnowsOneFileByAllItsNames) {
  write_file_atomically("a", "text");
  fs::create_symlink("a", "link");
  fs::create_hard_link("a", "twin");
  EXPECT_TRUE(is_same_file("a", "./a"));
  EXPECT_TRUE(is_same_file("a", "link"));
  EXPECT_TRUE(is_same_file("a", "twin"));
  EXPECT_TRUE(is_same_file("new", "./new"));  // neither is there
  EXPECT_TRUE(is_same_file("new", fs::current_path() / "new"));
  EXPECT_TRUE(is_same_file("../here/new", "new"));
  EXPECT_FALSE(is_same_file("a", "new"));
  EXPECT_FALSE(is_same_file("new", "newer"));
}

TEST_F(ResultFile, IsRefusedBeforeTheWork) {
  write_file_atomically("scene.xml", "text");
  EXPECT_EQ(refusal("./scene.xml", {"scene.xml"}),
            "./scene.xml: is an input of this run and stays as it is; name another file for the "
            "results");
  EXPECT_EQ(refusal("no/such/file"), "no/such/file: cannot be written: there is no folder no/such");
  EXPECT_EQ(refusal("."), ".: cannot be written: Is a directory");
  EXPECT_EQ(refusal("/proc/result"), "/proc/result: cannot be written: No such file or directory");
  EXPECT_NO_THROW(expect_result_file("/dev/null"));
  EXPECT_NO_THROW(expect_result_file("scene.xml"));
  EXPECT_NO_THROW(expect_result_file("new"));
  EXPECT_FALSE(fs::exists("new"));
  EXPECT_EQ(read_text_file("scene.xml"), "text");
}

TEST_F(ResultFile, WhatKilledWritersLeftIsRemoved) {
  std::FILE* left = std::fopen(".hbar-tmp-AbCdEf", "w");
  ASSERT_NE(left, nullptr);
  std::fclose(left);
  write_file_atomically("kept.txt", "text");
  expect_result_file("result");
  EXPECT_FALSE(fs::exists(".hbar-tmp-AbCdEf"));
  EXPECT_TRUE(fs::exists("kept.txt"));
}

TEST_F(ResultFile, IsSavedElsewhereWhereItCannotBeWritten) {
  EXPECT_EQ(testing::message_of<IoError>([] { write_result_file("/dev/full", "text"); }),
            "/dev/full: cannot be written: No space left on device; saved as ./full.rescued "
            "instead");
  EXPECT_EQ(read_text_file("full.rescued"), "text");
  EXPECT_EQ(testing::message_of<IoError>([] { write_result_file("gone/full", "second"); }),
            "gone/full: cannot be written: No such file or directory; saved as ./full.rescued.2 "
            "instead");
  EXPECT_EQ(read_text_file("full.rescued"), "text");
}

TEST_F(ResultFile, IsSavedInTheTemporaryFolderAtLast) {
  fs::create_directory(folder_ / "going");
  fs::current_path(folder_ / "going");
  fs::remove(folder_ / "going");  // nothing can be made in the current folder any more
  const std::string saved = (folder_ / "tmp/x.rescued").string();
  EXPECT_EQ(testing::message_of<IoError>([] { write_result_file("/no/x", "text"); }),
            "/no/x: cannot be written: No such file or directory; saved as " + saved + " instead");
  EXPECT_EQ(read_text_file(saved), "text");
}

}  // namespace
}  // namespace hbar::scene
