#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cases.h"

namespace hbar::solver_benchmark {

/// How large the matrices of a corpus are: about 10 to 50, 50 to 600 and 200 to 2300 kB each.
enum class CorpusSize { kSmall, kMedium, kLarge };

/// "small", "medium", "large".
[[nodiscard]] std::string_view name_of(CorpusSize size);

/// The cases of a corpus, in a fixed order: every family and every scene × BDF1, BDF2 × the four
/// systems, with as many steps as suit the size and the model. Models whose periodic system is
/// singular are left without it.
///
/// @param scenes  the folder of the examples' scenes
[[nodiscard]] std::vector<Case> corpus_cases(CorpusSize size, const std::filesystem::path& scenes);

/// Writes a matrix with what belongs to it: NAME.mtx, NAME_b.mtx, NAME_x.mtx and NAME.json. The
/// same case gives the same bytes. x is KLU's solution, refined.
///
/// @param folder  exists
/// @throws IoError; NumericalFailure if the matrix is singular
void write_corpus_matrix(const BenchmarkMatrix& matrix, const std::filesystem::path& folder);

/// The matrices of a folder: its files NAME.mtx or NAME.mtx.gz, by name, but for the NAME_b and
/// NAME_x that belong to another.
///
/// @throws IoError if the folder cannot be read; InvalidInput if there is no such file
[[nodiscard]] std::vector<std::filesystem::path> find_matrix_files(
    const std::filesystem::path& folder);

/// NAME of NAME.mtx or NAME.mtx.gz; empty for another file.
[[nodiscard]] std::string matrix_name(const std::filesystem::path& file);

/// Reads a matrix and what belongs to it, as far as it is there. Messages of its solvers count its
/// rows from 1, as its file does. Without NAME_b.mtx b is A·1.
///
/// @param structure  a name of structure_names(); empty: that of NAME.json or, if there is none,
///                   definite for a symmetric matrix with Cholesky factors and else general
/// @throws IoError, InvalidInput naming the file, what was found and what is allowed
[[nodiscard]] BenchmarkMatrix read_benchmark_matrix(const std::filesystem::path& file,
                                                    const std::string& structure = "");

}  // namespace hbar::solver_benchmark
