#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases.h"

namespace hbar::solver_benchmark {

/// What a matrix file cannot express, as JSON: where the matrix comes from, its structure and
/// blocks.
///
/// @param backward_error  of the solution that is written beside the matrix
[[nodiscard]] std::string sidecar_json(const BenchmarkMatrix& matrix, double backward_error);

/// "general", "block_triangular", …
[[nodiscard]] std::vector<std::string> structure_names();

/// @throws InvalidInput listing the known names
[[nodiscard]] solvers::Structure find_structure(const std::string& name);

/// Sets of label, structure, blocks and condition of a matrix that has its A what the file has.
///
/// @param file  as sidecar_json wrote it, or with some of its keys: {"structure": "definite"}
/// @returns     whether it has the structure
/// @throws IoError; InvalidInput naming the file, what was found and what is allowed
bool read_sidecar(const std::filesystem::path& file, BenchmarkMatrix& matrix);

}  // namespace hbar::solver_benchmark
