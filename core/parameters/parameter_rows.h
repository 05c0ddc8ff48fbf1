#pragma once

#include <vector>

#include "hbar/core/model/model.h"

namespace hbar::detail {

// Which rows of g a parameter can affect, ascending: the `rows` entries of the table of kinds
// (parameter_kinds.h). Contacts couple the coordinates that move either of their bodies.

/// Displacing everything below a joint's rest frame: its path, what is below it, and contacts of
/// what moves.
[[nodiscard]] std::vector<int> rows_of_joint_frame(const Model& model, int link);
/// Displacing or resizing a body: its path, and its contacts.
[[nodiscard]] std::vector<int> rows_of_body(const Model& model, int link);
/// Mass and moments of a body: its path.
[[nodiscard]] std::vector<int> rows_of_inertia(const Model& model, int link);
/// Forces on a body's points: the contacts that test them.
[[nodiscard]] std::vector<int> rows_of_points(const Model& model, int link);
/// One contact.
[[nodiscard]] std::vector<int> rows_of_contact(const Model& model, int contact);
/// A link's joint.
[[nodiscard]] std::vector<int> rows_of_joint(const Model& model, int link);
/// The joint that a motor drives.
[[nodiscard]] std::vector<int> rows_of_motor(const Model& model, int motor);
/// All.
[[nodiscard]] std::vector<int> every_row(const Model& model, int);

}  // namespace hbar::detail
