#pragma once

#include <filesystem>
#include <functional>
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

/// The matrices of a folder: its files NAME.mtx, by name, but for the NAME_b.mtx and NAME_x.mtx
/// that belong to another.
///
/// @throws IoError if the folder cannot be read; InvalidInput if there is no such file
[[nodiscard]] std::vector<std::filesystem::path> find_matrix_files(
    const std::filesystem::path& folder);

/// Reads a matrix and what belongs to it, as far as it is there. Without NAME.json a symmetric
/// matrix that has Cholesky factors is taken as definite, and any other as general; without
/// NAME_b.mtx b is A·1.
///
/// @throws IoError, InvalidInput naming the file, what was found and what is allowed
[[nodiscard]] BenchmarkMatrix read_benchmark_matrix(const std::filesystem::path& file);

}  // namespace hbar::solver_benchmark
