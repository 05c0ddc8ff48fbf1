#include "hbar/core/files/text_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

TEST(TextFile, IsReadToTheLastByte) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "text";
  std::string text(200000, 'x');
  text += '\0';
  text += "end";
  write_file_atomically(path, text);
  EXPECT_EQ(read_text_file(path), text);
}

TEST(TextFile, SaysWhyItCannotBeRead) {
  try {
    static_cast<void>(read_text_file("/no/such/file"));
    ADD_FAILURE();
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(), "/no/such/file: cannot be opened: No such file or directory");
  }
  try {
    static_cast<void>(read_text_file("/"));
    ADD_FAILURE();
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(), "/: cannot be read: Is a directory");
  }
}

}  // namespace
}  // namespace hbar::scene
