#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hbar::scene {

/// The points of a contacts file: a count, then that many lines x y z, in the scene's length unit.
///
/// @throws IoError       if the file cannot be read
/// @throws InvalidInput  that begins `file:line:` if a line is anything else
[[nodiscard]] std::vector<Eigen::Vector3d> read_contacts(const std::filesystem::path& path);

/// The same from the text of a file that messages call `name`.
[[nodiscard]] std::vector<Eigen::Vector3d> read_contacts_text(std::string_view text,
                                                              const std::string& name);

/// A point of a tactile sensor.
struct SensorPoint {
  Eigen::Vector3d position;  ///< length                             [3]
  Eigen::Vector3d axis0;     ///< first shear direction, unit        [3]
  Eigen::Vector3d axis1;     ///< second shear direction, unit       [3]
};

/// The points of a tactile sensor's file: a count, then that many lines of nine numbers: the
/// position x y z in the scene's length unit, and the two axes, which may have any length but 0 and
/// are not parallel.
///
/// @throws IoError       if the file cannot be read
/// @throws InvalidInput  that begins `file:line:` if a line is anything else
[[nodiscard]] std::vector<SensorPoint> read_sensor_points(const std::filesystem::path& path);

/// The same from the text of a file that messages call `name`.
[[nodiscard]] std::vector<SensorPoint> read_sensor_points_text(std::string_view text,
                                                               const std::string& name);

}  // namespace hbar::scene
