#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/adjoint/terms/objective.h"
#include "hbar/adjoint/trajectory/value_place.h"

namespace hbar {

/// How TrajectoryValues change along one direction; same shape. `h` is 0.
using ValueTangent = TrajectoryValues;

/// The member's name: "q", "qdot", "measured", "u", "p".
[[nodiscard]] std::string_view field_name(ValueField field);

/// The place in words: "qdot 3 at step 7", "p 2".
[[nodiscard]] std::string place_name(const ValuePlace& place);

/// Rows of a member.
[[nodiscard]] Eigen::Index field_rows(const TrajectoryValues& values, ValueField field);
/// Columns of a member: N + 1; N for kU; 1 for kP.
[[nodiscard]] Eigen::Index field_columns(const TrajectoryValues& values, ValueField field);

/// The number at a place.
/// @throws InvalidInput naming the place if the values have none there
[[nodiscard]] double value_at(const TrajectoryValues& values, const ValuePlace& place);
/// The same, writable.
[[nodiscard]] double& value_at(TrajectoryValues& values, const ValuePlace& place);
/// The partial derivative with respect to the number at a place, writable.
/// @throws InvalidInput naming the place if the partials have none there
[[nodiscard]] double& partial_at(TrajectoryPartials& partials, const ValuePlace& place);

/// How partials change along a tangent of the values: adds second_i · (δb at a, δa at b) for each
/// place.
///
/// @param places   as second_places() lists them; rows are not read
/// @param second   second partials                                          [places]
/// @param out      added to
void add_second_order(const std::vector<SecondPlace>& places,
                      const Eigen::Ref<const Eigen::VectorXd>& second, const ValueTangent& tangent,
                      TrajectoryPartials& out);

/// Every place, member by member in the order of ValueField, column by column.
[[nodiscard]] std::vector<ValuePlace> all_places(const TrajectoryValues& shape);

}  // namespace hbar
