#pragma once

#include <filesystem>
#include <optional>

#include "cases.h"

namespace hbar::solver_benchmark {

/// Whether this build has CHOLMOD, which reads and writes Matrix Market files. Without it the
/// functions below throw InvalidInput that says so.
[[nodiscard]] bool has_matrix_market();

/// Reads a square matrix from a Matrix Market file (coordinate; real, integer or pattern; general,
/// symmetric or skew-symmetric). Both triangles of a symmetric one are filled in; the entries of a
/// pattern are those that CHOLMOD gives it: 1, or if it is symmetric −1 and a diagonal that
/// dominates.
///
/// @returns  with rows ascending in every column
/// @throws IoError       if the file cannot be read
/// @throws InvalidInput  naming the file, what was found and what is allowed
[[nodiscard]] solvers::SparseMatrix read_matrix(const std::filesystem::path& file);

/// Reads a column of numbers from a Matrix Market file (array, real or integer, general).
///
/// @param rows  that it must have
/// @throws as read_matrix
[[nodiscard]] Eigen::VectorXd read_vector(const std::filesystem::path& file, Eigen::Index rows);

/// Writes a matrix with as many digits as it takes to read the same bits; a symmetric one by its
/// lower triangle. The file appears whole or not at all.
///
/// @param comment  lines for its head, without the leading %
/// @throws IoError
void write_matrix(const std::filesystem::path& file, const solvers::SparseMatrix& A,
                  const std::string& comment);

/// Writes a column of numbers; otherwise like write_matrix.
void write_vector(const std::filesystem::path& file, const Eigen::VectorXd& x,
                  const std::string& comment);

}  // namespace hbar::solver_benchmark
