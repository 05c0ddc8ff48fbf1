#pragma once

#include <filesystem>
#include <string>

#include "cases.h"

namespace hbar::solver_benchmark {

/// What a matrix file cannot express, as JSON: where the matrix comes from, its structure and
/// blocks.
///
/// @param backward_error  of the solution that is written beside the matrix
[[nodiscard]] std::string sidecar_json(const BenchmarkMatrix& matrix, double backward_error);

/// Sets label, structure, blocks and condition of a matrix that has its A.
///
/// @param file  as sidecar_json wrote it
/// @throws IoError; InvalidInput naming the file, what was found and what is allowed
void read_sidecar(const std::filesystem::path& file, BenchmarkMatrix& matrix);

}  // namespace hbar::solver_benchmark
