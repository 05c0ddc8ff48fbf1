#pragma once

#include <filesystem>

#include "cases.h"

namespace hbar::solver_benchmark {

/// Reads a square matrix from a Matrix Market file (coordinate; real, integer or pattern; general,
/// symmetric or skew-symmetric), compressed by gzip if its name ends with .gz. Both triangles of a
/// symmetric one are filled in, whichever the file has; entries of a pattern are 1, and entries of
/// one place are added up, as other readers do
/// (https://math.nist.gov/MatrixMarket/formats.html).
///
/// @returns  with rows ascending in every column
/// @throws IoError       if the file cannot be read
/// @throws InvalidInput  naming file and line, what was found and what is allowed
[[nodiscard]] solvers::SparseMatrix read_matrix(const std::filesystem::path& file);

/// Reads a column of numbers from a Matrix Market file (array, real or integer, general); otherwise
/// like read_matrix.
///
/// @param rows  that it must have
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
