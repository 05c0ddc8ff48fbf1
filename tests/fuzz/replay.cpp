// Runs a target on files, and on all files of folders, without a fuzzer: FILE_OR_FOLDER...
//
// Builds without libFuzzer link it in libFuzzer's place, so that what was found once is tested
// everywhere.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/files/text_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

/// An input that takes longer is a finding; those of a corpus take a few milliseconds.
constexpr std::chrono::seconds kLongest(10);

std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::is_directory(path)) {
    return {path};
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool replay(const fs::path& file) {
  std::cout << file.filename().string() << std::endl;  // the last one printed is to blame
  const std::string input = hbar::scene::read_text_file(file);
  // A copy without a byte to spare, so that sanitizers see a reader that reads on.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  const auto begin = std::chrono::steady_clock::now();
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  const bool quick = std::chrono::steady_clock::now() - begin < kLongest;
  if (!quick) {
    std::cout << "finding: takes more than " << kLongest.count() << " s" << std::endl;
  }
  return quick;
}

}  // namespace

int main(int argc, char** argv) {
  int inputs = 0;
  int slow = 0;
  try {
    for (int i = 1; i < argc; ++i) {
      for (const fs::path& file : files_of(argv[i])) {
        slow += replay(file) ? 0 : 1;
        ++inputs;
      }
    }
  } catch (const hbar::IoError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  std::cout << inputs << " inputs\n";
  return inputs > 0 && slow == 0 ? 0 : 1;
}
