#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory_values.h"
#include "hbar/adjoint/trajectory/value_place.h"

namespace hbar::study {

/// Names of a trajectory's numbers, used as the columns of a table.
struct TrajectoryNames {
  std::vector<std::string> q;         ///< "NAME" of each coordinate                 [dof]
  std::vector<std::string> qdot;      ///< "rate.NAME"                               [dof]
  std::vector<std::string> measured;  ///< Horizon::measured_names                  [measured]
  std::vector<std::string> u;         ///< "control.NAME"                            [controls]
};

/// The names of all numbers of a simulation.
[[nodiscard]] TrajectoryNames trajectory_names(const Horizon& horizon);

/// A table with a row per step k = 0 … N: time, coordinates, rates, measured rows (end effectors
/// and sensor readings first), and the controls of the step that ends there (none at k = 0).
///
/// @throws InvalidInput if a member's number of rows differs from that of its names
[[nodiscard]] std::string trajectory_csv(const TrajectoryNames& names,
                                         const TrajectoryValues& values);

/// Measured data of a trajectory: some numbers at some steps. The controls of a table are no data:
/// they are what the motors were told, without an error to estimate from.
struct TrajectoryData {
  std::vector<std::string> names;   ///< of the columns, without time                 [columns]
  std::vector<ValuePlace> places;   ///< what each datum is a measurement of             [data]
  std::vector<std::size_t> column;  ///< the column each belongs to                      [data]
  Eigen::VectorXd data;             ///< in the model's units                            [data]
  /// Controls of every step; empty if the table has none.                      [controls x N]
  Eigen::MatrixXd u = {};

  /// A number for each datum from one for each column, such as standard deviations; those of
  /// controls are not used.                                                               [data]
  ///
  /// @throws InvalidInput if there is not one for each column
  [[nodiscard]] Eigen::VectorXd by_column(const Eigen::VectorXd& numbers) const;
};

/// How a table's times correspond to steps.
struct TimeGrid {
  double h = 0.0;           ///< time step, time
  int steps = 0;            ///< N
  double tolerance = 1e-6;  ///< largest distance of a time from k h, in units of h
};

/// Reads a table of measured numbers: a heading, whose first column is "time" and whose others are
/// names of TrajectoryNames in any order ("q.NAME" and "qdot.NAME", as the hbar command writes
/// them, are understood too), and a row for each step that was measured, in the order of time. An
/// empty cell is a missing datum. A control acted since the row before that has one: in the step
/// that ends at the row's time, and in those before it that have no row.
///
/// @param text  the file's bytes
/// @param file  its name for messages
/// @throws InvalidInput that begins `file:line:column:` for an unknown or repeated column, a row of
///   another length, a cell that is not a finite number, or a time that is not that of a step; or
///   naming a control that the table gives for some motors or for some steps only
[[nodiscard]] TrajectoryData read_trajectory_csv(std::string_view text, const std::string& file,
                                                 const TrajectoryNames& names,
                                                 const TimeGrid& grid);

}  // namespace hbar::study
