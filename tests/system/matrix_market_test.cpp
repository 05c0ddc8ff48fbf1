// Matrix Market files of the benchmark of solvers.

#include "examples/solver_benchmark/matrix_market.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "examples/solver_benchmark/cases.h"
#include "examples/solver_benchmark/corpus.h"
#include "examples/solver_benchmark/measure.h"
#include "hbar/core/base/error.h"

namespace hbar::solver_benchmark {
namespace {

namespace fs = std::filesystem;
using solvers::SparseMatrix;

class MatrixMarket : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "hbar_market.XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path write(const std::string& text) const {
    std::ofstream(folder_ / "m.mtx") << text;
    return folder_ / "m.mtx";
  }

  /// The message that reading a text as a matrix is refused with, without the file's name.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    const fs::path file = write(text);
    try {
      static_cast<void>(read_matrix(file));
    } catch (const InvalidInput& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(file.string() + ":")) << message;
      EXPECT_NE(message.find("; allowed: a square matrix"), std::string::npos) << message;
      return message.substr(file.string().size() + 1,
                            message.find("; allowed") - file.string().size() - 1);
    }
    return "read";
  }

  fs::path folder_;
};

bool same_bits(const SparseMatrix& A, const SparseMatrix& B) {
  return A.rows() == B.rows() && A.nonZeros() == B.nonZeros() &&
         std::equal(A.outerIndexPtr(), A.outerIndexPtr() + A.cols() + 1, B.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros(), B.innerIndexPtr()) &&
         std::memcmp(A.valuePtr(), B.valuePtr(),
                     sizeof(double) * static_cast<std::size_t>(A.nonZeros())) == 0;
}

TEST_F(MatrixMarket, AMatrixOfEverySystemComesBackToTheBit) {
  CaseAssembler assembler;
  for (const SystemKind kind :
       {SystemKind::kAdjoint, SystemKind::kPeriodic, SystemKind::kGaussNewton, SystemKind::kKkt}) {
    SCOPED_TRACE(name_of(kind));
    const BenchmarkMatrix matrix =
        assembler.assemble({.family = "hand", .joints = 4, .steps = 5, .system = kind});
    write_corpus_matrix(matrix, folder_);
    const BenchmarkMatrix back = read_benchmark_matrix(folder_ / (matrix.label.name + ".mtx"));
    EXPECT_TRUE(same_bits(back.A, matrix.A));
    EXPECT_EQ(back.b, matrix.b);
    EXPECT_EQ(back.options.structure, matrix.options.structure);
    EXPECT_EQ(back.options.block_sizes, matrix.options.block_sizes);
    EXPECT_EQ(back.label.system, matrix.label.system);
    EXPECT_EQ(back.label.dof, 10);
    const Reference reference = find_reference(matrix);
    ASSERT_TRUE(back.x.has_value());
    EXPECT_EQ(*back.x, reference.x);
    EXPECT_EQ(back.condition, reference.condition);
  }
  EXPECT_EQ(find_matrix_files(folder_).size(), 4U);
}

TEST_F(MatrixMarket, SymmetricPatternAndIntegerFilesAreFilledIn) {
  Eigen::Matrix3d expected;
  expected << 2, -1, 0, -1, 2, 5, 0, 5, 0;
  EXPECT_EQ(Eigen::MatrixXd(read_matrix(write("%%MatrixMarket matrix coordinate real symmetric\n"
                                              "% a comment\n"
                                              "3 3 4\n1 1 2\n2 1 -1\n2 2 2e0\n3 2 5\n"))),
            expected);
  expected << 0, -7, 0, 7, 0, 0, 0, 0, 0;
  EXPECT_EQ(Eigen::MatrixXd(read_matrix(
                write("%%MatrixMarket matrix coordinate integer skew-symmetric\n3 3 1\n2 1 7\n"))),
            expected);
  expected << 1, 1, 0, 0, 1, 0, 0, 0, 1;
  EXPECT_EQ(Eigen::MatrixXd(read_matrix(write("%%MatrixMarket matrix coordinate pattern general\n"
                                              "3 3 4\n1 1\n2 2\n3 3\n1 2\n"))),
            expected);
  expected << 1, 1, 1, 1, 1, 0, 1, 0, 1;
  for (const char* entries : {"2 1\n3 1\n", "1 2\n1 3\n"}) {
    EXPECT_EQ(Eigen::MatrixXd(read_matrix(
                  write(std::string("%%MatrixMarket matrix coordinate pattern symmetric\r\n"
                                    "3 3 5\r\n1 1\r\n2 2\n3 3\n") +
                        entries))),
              expected);
  }
  // Entries of one place are added up, as other readers do.
  EXPECT_EQ(read_matrix(write("\xef\xbb\xbf%%MatrixMarket matrix coordinate real general\n"
                              "2 2 3\n1 1 1\n1 1 2\n2 2 4\n"))
                .coeff(0, 0),
            3.0);
  // A triangular matrix is no symmetric one.
  EXPECT_EQ(read_matrix(write("%%MatrixMarket matrix coordinate real general\n"
                              "2 2 3\n1 1 1\n2 1 3\n2 2 1\n"))
                .coeff(0, 1),
            0.0);
}

TEST_F(MatrixMarket, OnesAreWrittenAsEntries) {
  for (const std::string entries : {"1 1\n2 1\n1 2\n", "1 1\n2 1\n2 2\n"}) {
    const SparseMatrix A =
        read_matrix(write("%%MatrixMarket matrix coordinate pattern general\n2 2 3\n" + entries));
    write_matrix(folder_ / "ones.mtx", A, "two lines\nof comment");
    EXPECT_TRUE(same_bits(read_matrix(folder_ / "ones.mtx"), A)) << entries;
  }
}

TEST_F(MatrixMarket, WhatIsNoSuchMatrixIsRefusedWithTheFilesName) {
  const std::string real = "%%MatrixMarket matrix coordinate real general\n";
  EXPECT_EQ(refusal(""), "1: the first line is \"\"");
  EXPECT_EQ(refusal("2 2 1\n1 1 1\n"), "1: the first line is \"2 2 1\"");
  EXPECT_EQ(refusal("%%MatrixMarket matrix coordinate complex general\n1 1 1\n1 1 1 0\n"),
            " the matrix is complex");
  EXPECT_EQ(refusal("%%MatrixMarket matrix array real general\n1 1\n1\n"), " the matrix is array");
  EXPECT_EQ(refusal("%%MatrixMarket matrix coordinate real hermitian\n1 1 1\n1 1 1\n"),
            " the matrix is hermitian");
  EXPECT_EQ(refusal(real + "2 3 1\n1 1 1\n"), "2: the matrix has 2 rows and 3 columns");
  EXPECT_EQ(refusal(real + "0 0 0\n"), "2: the matrix has 0 rows and 0 columns");
  EXPECT_EQ(refusal(real + "2 2 0\n"), "2: the matrix has no entry");
  EXPECT_EQ(refusal(real + "2 2 1\n1 1 nan\n"), "3: \"nan\" is not a finite number");
  EXPECT_EQ(refusal(real + "2 2 1\n1 1 inf\n"), "3: \"inf\" is not a finite number");
  EXPECT_EQ(refusal(real + "2 2 2\n1 1 1e308\n1 1 1e308\n"),
            "4: the entries of one place add up to more than a double holds");
  EXPECT_EQ(refusal(real), "1: there is no line of sizes");
  EXPECT_EQ(refusal(real + "2 2 2\n1 1 1\n"),
            "3: the file ends after 1 entries; its sizes promise 2");
  EXPECT_EQ(refusal(real + "2 2 2\n1 1 1\n2 2 2\n\n1 2 7\n"),
            "6: the sizes promise 2 entries; this is one more");
  EXPECT_EQ(refusal(real + "% by hand\n2 2\n1 1 1\n"), "3: \"2 2\" stands where 3 sizes belong");
  EXPECT_EQ(refusal(real + "2 -2 1\n1 1 1\n"), "2: a size is -2; it must be from 0 to 2147483647");
  EXPECT_EQ(refusal(real + "2 2 1e0\n1 1 1\n"),
            "2: a size is 1e0; it must be from 0 to 2147483647");
  EXPECT_EQ(refusal(real + "1 1 1\n" + '\0' + "1 1 1\n"),
            "3: a row is \\x001; it must be from 1 to 1");
  EXPECT_EQ(refusal(real + "2 2 1\n0 0 1\n"), "3: a row is 0; it must be from 1 to 2");
  EXPECT_EQ(refusal(real + "2 2 1\n3 1 1\n"), "3: a row is 3; it must be from 1 to 2");
  EXPECT_EQ(refusal(real + "2 2 1\n1 one 1\n"), "3: a column is one; it must be from 1 to 2");
  EXPECT_EQ(refusal(real + "2 2 1\n1 1\n"), "3: \"1 1\" has 2 words; an entry has 3");
  EXPECT_EQ(refusal("%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n2 1 1\n1 2 1\n"),
            "4: entry (1, 2) is above the diagonal, earlier ones are on its other side; of such a "
            "matrix a file has one triangle");
  EXPECT_EQ(refusal("%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n2 2 3\n"),
            "3: entry (2, 2) of a skew-symmetric matrix is 3");
  EXPECT_THROW(static_cast<void>(read_matrix(folder_ / "none.mtx")), IoError);
  const fs::path vector = write("%%MatrixMarket matrix array real general\n2 1\n1\n2\n");
  EXPECT_EQ(read_vector(vector, 2), Eigen::Vector2d(1.0, 2.0));
  EXPECT_THROW(static_cast<void>(read_vector(vector, 3)), InvalidInput);
  const fs::path negative = write("%%MatrixMarket matrix array real general\n3 -1\n1\n2\n3\n");
  EXPECT_THROW(static_cast<void>(read_vector(negative, 3)), InvalidInput);
}

TEST_F(MatrixMarket, ASidecarNeedsTheStructureAlone) {
  const fs::path file =
      write("%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 3\n2 2 -5\n");
  EXPECT_EQ(read_benchmark_matrix(file).options.structure, solvers::Structure::kGeneral);
  std::ofstream(folder_ / "m.json") << R"({"structure": "quasi_definite"})";
  EXPECT_EQ(read_benchmark_matrix(file).options.structure, solvers::Structure::kQuasiDefinite);
  EXPECT_EQ(read_benchmark_matrix(file, "definite").options.structure,
            solvers::Structure::kDefinite);
  std::ofstream(folder_ / "m.json") << R"({"source": "elsewhere"})";
  const BenchmarkMatrix matrix = read_benchmark_matrix(file);
  EXPECT_EQ(matrix.options.structure, solvers::Structure::kGeneral);
  EXPECT_EQ(matrix.label.source, "elsewhere");
  EXPECT_EQ(matrix.name_of_unknown(1), "2 in the file");
}

TEST_F(MatrixMarket, ASidecarThatDoesNotFitIsRefused) {
  const fs::path file =
      write("%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 1\n2 2 1\n");
  const std::string good =
      R"({"source": "s", "family": "", "n": 1, "T": 2, "h": 0.1, "integrator": "bdf1",
          "system": "adjoint", "structure": "block_triangular", "blocks": [[2, 1]], "rows": 2,
          "condition": null})";
  // What is said of the text with a part replaced; empty if it is read.
  const auto refusal_of = [&](const std::string& from, const std::string& to) -> std::string {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    const fs::path sidecar = folder_ / "m.json";
    std::ofstream(sidecar) << text;
    try {
      static_cast<void>(read_benchmark_matrix(file));
    } catch (const InvalidInput& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(sidecar.string() + ": ")) << message;
      return message.substr(sidecar.string().size() + 2);
    }
    return "";
  };
  const std::string blocks = "blocks are not those of a matrix of 2 rows";
  const std::string whole = "; it is a whole number from 0 to 2147483647";
  EXPECT_EQ(refusal_of("\"s\"", "\"s\""), "");
  EXPECT_EQ(refusal_of("[[2, 1]]", "[[3, 1]]"), blocks);
  EXPECT_EQ(refusal_of("[[2, 1]]", "[[1, 1]]"), blocks);
  EXPECT_EQ(refusal_of("[[2, 1]]", "[[2000000000, 1], [1, 1]]"), blocks);
  EXPECT_EQ(refusal_of("[[2, 1]]", "[[0, 1]]"), "blocks: counts and sizes are at least 1");
  EXPECT_EQ(refusal_of("[[2, 1]]", "[[-2, 1]]"), "blocks: a count is -2" + whole);
  EXPECT_EQ(refusal_of("[[2, 1]]", "[[2, 4294967297]]"), "blocks: a size is 4294967297" + whole);
  EXPECT_EQ(refusal_of("\"T\": 2", "\"T\": 1e300"), "T is 1e+300" + whole);
  EXPECT_EQ(refusal_of("\"n\": 1", "\"n\": \"one\""), "n is \"one\"" + whole);
  EXPECT_EQ(refusal_of("\"rows\": 2", "\"rows\": 3"), "rows is 3; the matrix has 2 rows");
  EXPECT_EQ(refusal_of("block_triangular", "blocky").substr(0, 31),
            "there is no structure \"blocky\";");
  EXPECT_EQ(refusal_of("\"blocks\"", "\"block\""),
            "there is no key \"block\"; did you mean 'blocks'?");
  EXPECT_EQ(refusal_of("{", "[").substr(0, 31), "not what `hbar corpus` writes: ") << "broken JSON";
}

}  // namespace
}  // namespace hbar::solver_benchmark
