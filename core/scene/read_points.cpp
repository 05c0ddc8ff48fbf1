#include "hbar/core/scene/read_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "hbar/core/base/error.h"
#include "hbar/core/base/unit_vector.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/text_file.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/scene/text_lines.h"

namespace hbar::scene {
namespace {

/// Sine of the angle below which two axes count as parallel.
constexpr double kSmallestSine = 1e-9;

/// Reads a count, then that many lines of `word_count` words each, by `row(line, words)`.
template <typename Row>
void read_rows(std::string_view text, const std::string& name, std::size_t word_count,
               const char* form, Row&& row) {
  std::optional<int> count;
  int found = 0;
  const int last_line = for_each_line(text, [&](int line,
                                                const std::vector<std::string_view>& words) {
    if (!count) {
      std::string reason;
      count = parse_integer(words[0], reason);
      if (!count) {
        fail_in_line(name, line, reason + "; the file begins with the number of points");
      }
      if (words.size() != 1 || *count < 0) {
        fail_in_line(name, line, "the file begins with the number of points, alone in its line");
      }
      if (*count > kMaxContactPoints) {
        fail_in_line(name, line,
                     concat("the file has ", *count, " points; at most ", kMaxContactPoints,
                            " are allowed"));
      }
      return;
    }
    if (words.size() != word_count) {
      fail_in_line(name, line, concat("found ", words.size(), " words; a point is ", form));
    }
    row(line, words);
    ++found;
  });
  const int last = std::max(1, last_line);
  if (!count) {
    fail_in_line(name, last, "the file is empty; it begins with the number of points");
  }
  if (found != *count) {
    fail_in_line(name, last, concat("found ", found, " points; the first line says ", *count));
  }
}

}  // namespace

std::vector<Eigen::Vector3d> read_contacts_text(std::string_view text, const std::string& name) {
  std::vector<Eigen::Vector3d> points;
  read_rows(text, name, 3, "x y z", [&](int line, const std::vector<std::string_view>& words) {
    points.push_back(point_in_words(words, 0, name, line));
  });
  return points;
}

std::vector<Eigen::Vector3d> read_contacts(const std::filesystem::path& path) {
  return read_contacts_text(read_text_file(path), path.filename().string());
}

std::vector<SensorPoint> read_sensor_points_text(std::string_view text, const std::string& name) {
  std::vector<SensorPoint> points;
  const auto read = [&](int line, const std::vector<std::string_view>& words) {
    const SensorPoint point = {point_in_words(words, 0, name, line),
                               unit_vector(point_in_words(words, 3, name, line)),
                               unit_vector(point_in_words(words, 6, name, line))};
    if (point.axis0.cross(point.axis1).norm() < kSmallestSine) {
      fail_in_line(name, line, "the axes a0 and a1 are zero or parallel; they span a plane");
    }
    points.push_back(point);
  };
  read_rows(text, name, 9, "x y z, then its axes a0x a0y a0z and a1x a1y a1z", read);
  return points;
}

std::vector<SensorPoint> read_sensor_points(const std::filesystem::path& path) {
  return read_sensor_points_text(read_text_file(path), path.filename().string());
}

}  // namespace hbar::scene
