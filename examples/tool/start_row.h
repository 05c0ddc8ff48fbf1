#pragma once

#include <filesystem>
#include <string>

#include "hbar/adjoint/trajectory/inputs.h"
#include "hbar/core/model/model.h"

namespace hbar::tool {

/// Sets the initial state to a row of a table with columns q.NAME and qdot.NAME of every
/// coordinate, which --csv writes, or NAME and rate.NAME, which study::trajectory_csv writes.
///
/// @param where  FILE or FILE:ROW. Rows below the heading count from 0, from the last with -1; the
///               last is taken if no row is named
/// @returns      the file
/// @throws IoError; InvalidInput naming the file, what was found and what is needed
std::filesystem::path read_start_row(const std::string& where, const Model& model, Inputs& inputs);

}  // namespace hbar::tool
