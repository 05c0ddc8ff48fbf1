#pragma once

#include "hbar/adjoint/objective.h"

namespace hbar {

/// How TrajectoryValues move along one direction; shaped like them. `h` is 0.
using ValueTangent = TrajectoryValues;

/// Values of a simulator's trajectories, sized but zero: what terms ask for before there are any.
[[nodiscard]] TrajectoryValues value_shape(const Simulator& simulator);

/// The number at a place, and its partial.
[[nodiscard]] double number_at(const TrajectoryValues& values, const ValuePlace& place);
[[nodiscard]] double number_at(const TrajectoryPartials& partials, const ValuePlace& place);
[[nodiscard]] double& number_at(TrajectoryPartials& partials, const ValuePlace& place);

/// How partials move along a tangent of the values: adds second_i · (δb at a, δa at b) for each
/// place.
///
/// @param places   as second_places() lists them; rows are not read
/// @param second   second partials                                          [places]
/// @param out      added to
void add_second_order(const std::vector<SecondPlace>& places,
                      const Eigen::Ref<const Eigen::VectorXd>& second, const ValueTangent& tangent,
                      TrajectoryPartials& out);

}  // namespace hbar
