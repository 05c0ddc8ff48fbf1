// Compressed Matrix Market files of the benchmark of solvers.

#include "examples/solver_benchmark/gzip_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>

#include "examples/solver_benchmark/corpus.h"
#include "examples/solver_benchmark/matrix_market.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/text_file.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace hbar::solver_benchmark {
namespace {

namespace fs = std::filesystem;

const std::string kText = "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 3\n2 2 -5\n";

class GzipFile : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path compress(const std::string& text, const char* name = "m.mtx.gz") const {
    const fs::path file = folder_ / name;
    const gzFile out = ::gzopen(file.c_str(), "wb");
    EXPECT_EQ(::gzwrite(out, text.data(), static_cast<unsigned>(text.size())),
              static_cast<int>(text.size()));
    EXPECT_EQ(::gzclose(out), Z_OK);
    return file;
  }

  scene::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(GzipFile, IsReadAsWhatItHolds) {
  const fs::path file = compress(kText);
  EXPECT_NE(scene::read_text_file(file), kText);
  EXPECT_EQ(read_gzip_file(file), kText);
  EXPECT_EQ(read_matrix(file).coeff(1, 1), -5.0);
  const std::string large(3'000'000, 'x');
  EXPECT_EQ(read_gzip_file(compress(large)), large);
}

TEST_F(GzipFile, IsOneOfAFoldersMatrices) {
  static_cast<void>(compress(kText));
  static_cast<void>(
      compress("%%MatrixMarket matrix array real general\n2 1\n6\n5\n", "m_b.mtx.gz"));
  ASSERT_EQ(find_matrix_files(folder_), std::vector<fs::path>{folder_ / "m.mtx.gz"});
  EXPECT_EQ(read_benchmark_matrix(folder_ / "m.mtx.gz").b, Eigen::Vector2d(6.0, 5.0));
  std::ofstream(folder_ / "m.mtx") << kText;
  EXPECT_EQ(find_matrix_files(folder_), std::vector<fs::path>{folder_ / "m.mtx"});
}

TEST_F(GzipFile, ThatIsDamagedIsRefused) {
  const fs::path file = compress(kText);
  const std::string bytes = scene::read_text_file(file);
  const auto refusal = [&](const std::string& spoiled) {
    std::ofstream(file, std::ios::binary) << spoiled;
    return hbar::testing::message_of<IoError>([&] { static_cast<void>(read_gzip_file(file)); });
  };
  for (std::size_t length = 10; length < bytes.size(); ++length) {
    EXPECT_EQ(refusal(bytes.substr(0, length)),
              file.string() + ": is damaged: it ends before its time");
  }
  for (std::size_t at = 10; at < bytes.size(); ++at) {
    std::string spoiled = bytes;
    spoiled[at] = static_cast<char>(spoiled[at] ^ 0x10);
    const std::string message = refusal(spoiled);
    if (message.empty()) {  // a bit that is not used
      EXPECT_EQ(read_gzip_file(file), kText) << at;
    } else {
      EXPECT_EQ(message.find(file.string() + ": is damaged: "), 0U) << message;
    }
  }
  fs::remove(file);
  EXPECT_EQ(hbar::testing::message_of<IoError>([&] { static_cast<void>(read_gzip_file(file)); }),
            file.string() + ": cannot be opened: No such file or directory");
}

}  // namespace
}  // namespace hbar::solver_benchmark
