#pragma once

#include <vector>

#include "hbar/core/model/model.h"

namespace hbar::detail {

// Which rows of g a parameter can touch, ascending: what the table of kinds (parameter_kinds.h)
// names. Contacts couple the coordinates that move either of their bodies.

/// Displacing everything from a joint's rest frame on: its path, what is below it, and contacts of
/// what moves.
[[nodiscard]] std::vector<int> rows_of_joint_frame(const Model& model, int link);
/// Displacing or resizing a body: its path, and its contacts.
[[nodiscard]] std::vector<int> rows_of_body(const Model& model, int link);
/// Mass and moments of a body: its path.
[[nodiscard]] std::vector<int> rows_of_inertia(const Model& model, int link);
/// What a body's points feel: contacts that test them.
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
