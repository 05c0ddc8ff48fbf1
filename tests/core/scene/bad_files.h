#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hbar/core/base/error.h"

namespace hbar::scene {

/// A text that a reader must refuse, and the whole message.
struct BadFile {
  const char* name;
  std::string text;
  std::string message;
};

/// Reads each as a file called "bad" and compares what is thrown.
template <typename Read>
void expect_refused(const std::vector<BadFile>& files, Read&& read) {
  for (const BadFile& file : files) {
    SCOPED_TRACE(file.name);
    try {
      static_cast<void>(read(file.text, "bad"));
      ADD_FAILURE() << "was read";
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.what(), file.message);
    }
  }
}

}  // namespace hbar::scene
