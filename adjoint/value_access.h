#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/adjoint/objective.h"
#include "hbar/adjoint/value_place.h"

namespace hbar {

/// The member's name: "q", "qdot", "v", "tactile", "measured", "u", "p".
[[nodiscard]] std::string_view field_name(ValueField field);

/// The place in words: "qdot 3 at step 7", "p 2".
[[nodiscard]] std::string place_name(const ValuePlace& place);

/// Rows of a member.
[[nodiscard]] Eigen::Index field_rows(const TrajectoryValues& values, ValueField field);
/// Columns of a member: N + 1; N of kU; 1 of kP.
[[nodiscard]] Eigen::Index field_columns(const TrajectoryValues& values, ValueField field);

/// The number at a place.
/// @throws InvalidInput naming the place if the values have none there
[[nodiscard]] double value_at(const TrajectoryValues& values, const ValuePlace& place);
/// The same, to be written.
[[nodiscard]] double& value_at(TrajectoryValues& values, const ValuePlace& place);
/// The partial by the number at a place, to be written.
/// @throws InvalidInput naming the place if the partials have none there
[[nodiscard]] double& partial_at(TrajectoryPartials& partials, const ValuePlace& place);

/// Every place, member by member in the order of ValueField, column by column.
[[nodiscard]] std::vector<ValuePlace> all_places(const TrajectoryValues& shape);

}  // namespace hbar
