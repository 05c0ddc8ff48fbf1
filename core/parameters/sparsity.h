#pragma once

#include <vector>

#include "hbar/core/model/model.h"

namespace hbar {

/// Rows of a dof x dof block that can be non-zero, per column: the coordinates on the same path
/// (branch-induced sparsity), ascending.
[[nodiscard]] std::vector<std::vector<int>> tree_pattern(const Tree& tree);

/// The same for a model's residual: in addition, the coordinates coupled by declared contacts.
[[nodiscard]] std::vector<std::vector<int>> residual_pattern(const Model& model);

/// Coordinates that a contact couples: those that move either of its bodies, ascending.
[[nodiscard]] std::vector<int> coupled_coordinates(const Model& model, const Contact& contact);

}  // namespace hbar
