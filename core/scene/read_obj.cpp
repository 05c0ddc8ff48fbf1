#include "hbar/core/scene/read_obj.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "hbar/core/base/error.h"
#include "hbar/core/base/unit_vector.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/text_file.h"

namespace hbar::scene {
namespace {

/// Sine of the angle below which two axes count as parallel.
constexpr double kSmallestSine = 1e-9;

/// Calls `line(number, words)` for each line that has words before its comment.
template <typename Line>
void for_each_line(std::string_view text, Line&& line) {
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view whole = text.substr(0, end);
    const std::vector<std::string_view> words =
        split_words(whole.substr(0, std::min(whole.find('#'), whole.size())));
    if (!words.empty()) {
      line(number, words);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

[[noreturn]] void fail(const std::string& name, int line, const std::string& what) {
  throw InvalidInput(concat(name, ":", line, ": ", what));
}

/// Three numbers among words, from word `first` on.
Eigen::Vector3d read_point(const std::vector<std::string_view>& words, std::size_t first,
                           const std::string& name, int line) {
  Eigen::Vector3d point;
  for (std::size_t i = 0; i < 3; ++i) {
    std::string reason;
    const std::optional<double> value = parse_number(words[first + i], reason);
    if (!value) {
      fail(name, line, reason + "; a point is 3 numbers");
    }
    point[static_cast<Eigen::Index>(i)] = *value;
  }
  return point;
}

/// Reads a count, then that many lines of `word_count` words each, by `row(line, words)`.
template <typename Row>
void read_rows(std::string_view text, const std::string& name, std::size_t word_count,
               const char* form, Row&& row) {
  std::optional<int> count;
  int found = 0;
  int last = 1;
  for_each_line(text, [&](int line, const std::vector<std::string_view>& words) {
    last = line;
    if (!count) {
      std::string reason;
      count = parse_integer(words[0], reason);
      if (!count) {
        fail(name, line, reason + "; the file begins with the number of points");
      }
      if (words.size() != 1 || *count < 0) {
        fail(name, line, "the file begins with the number of points, alone in its line");
      }
      return;
    }
    if (words.size() != word_count) {
      fail(name, line, concat("found ", words.size(), " words; a point is ", form));
    }
    row(line, words);
    ++found;
  });
  if (!count) {
    fail(name, last, "the file is empty; it begins with the number of points");
  }
  if (found != *count) {
    fail(name, last, concat("found ", found, " points; the first line says ", *count));
  }
}

class ObjReader {
 public:
  explicit ObjReader(const std::string& name) : name_(name) {}

  void read_line(int line, const std::vector<std::string_view>& words) {
    constexpr std::array<std::string_view, 8> kSkipped = {"vt", "vn", "vp",     "g",
                                                          "o",  "s",  "usemtl", "mtllib"};
    const std::string_view keyword = words[0];
    if (keyword == "v") {
      read_vertex(line, words);
    } else if (keyword == "f") {
      read_face(line, words);
    } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
      fail(name_, line,
           concat("unknown keyword \"", quotable(keyword),
                  "\"; known: v, f, and skipped: vt, vn, vp, g, o, s, usemtl, mtllib"));
    }
  }

  [[nodiscard]] TriangleMesh take(int last_line) {
    if (mesh_.triangles.empty()) {
      fail(name_, std::max(1, last_line), "the file has no face; a solid is bounded by faces");
    }
    return std::move(mesh_);
  }

 private:
  void read_vertex(int line, const std::vector<std::string_view>& words) {
    // After the point, some programs write a weight or a colour.
    const std::size_t count = words.size() - 1;
    if (count != 3 && count != 4 && count != 6 && count != 7) {
      fail(name_, line,
           concat("v has ", count, " numbers; a vertex is v x y z, with a weight or a colour"));
    }
    mesh_.vertices.push_back(read_point(words, 1, name_, line));
  }

  void read_face(int line, const std::vector<std::string_view>& words) {
    std::vector<int> corners;
    for (std::size_t i = 1; i < words.size(); ++i) {
      corners.push_back(read_corner(line, words[i]));
    }
    if (corners.size() < 3) {
      fail(name_, line, concat("f has ", corners.size(), " corners; a face has at least 3"));
    }
    std::vector<int> sorted = corners;
    std::sort(sorted.begin(), sorted.end());
    const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
    if (repeated != sorted.end()) {
      fail(name_, line, concat("f has vertex ", *repeated + 1, " twice; its corners must differ"));
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      mesh_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }

  /// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 0; the rest must be whole
  /// numbers and is dropped.
  int read_corner(int line, std::string_view corner) {
    const std::string form = "; a corner is v, v/vt, v//vn or v/vt/vn";
    std::array<std::optional<int>, 3> parts;
    std::size_t part = 0;
    std::string_view rest = corner;
    for (bool more = true; more; ++part) {
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      const std::string_view word = rest.substr(0, slash);
      more = slash < rest.size();
      rest.remove_prefix(std::min(slash + 1, rest.size()));
      if (part > 2) {
        fail(name_, line, concat("\"", quotable(corner), "\" has too many /", form));
      }
      const bool may_be_empty = part == 1 && more;
      if (word.empty() && may_be_empty) {
        continue;
      }
      std::string reason;
      parts[part] = parse_integer(word, reason);
      if (!parts[part]) {
        fail(name_, line, concat("\"", quotable(corner), "\": ", reason, form));
      }
    }
    const int count = static_cast<int>(mesh_.vertices.size());
    const int given = *parts[0];
    const int index = given < 0 ? count + given : given - 1;
    if (given == 0 || index < 0 || index >= count) {
      fail(name_, line,
           concat("vertex ", given, " does not exist; ", count, " are defined before this line"));
    }
    return index;
  }

  const std::string& name_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_obj_text(std::string_view text, const std::string& name) {
  ObjReader reader(name);
  int last = 0;
  for_each_line(text, [&](int line, const std::vector<std::string_view>& words) {
    reader.read_line(line, words);
    last = line;
  });
  return reader.take(last);
}

TriangleMesh read_obj(const std::filesystem::path& path) {
  return read_obj_text(read_text_file(path), path.filename().string());
}

std::vector<Eigen::Vector3d> read_contacts_text(std::string_view text, const std::string& name) {
  std::vector<Eigen::Vector3d> points;
  read_rows(text, name, 3, "x y z", [&](int line, const std::vector<std::string_view>& words) {
    points.push_back(read_point(words, 0, name, line));
  });
  return points;
}

std::vector<Eigen::Vector3d> read_contacts(const std::filesystem::path& path) {
  return read_contacts_text(read_text_file(path), path.filename().string());
}

std::vector<SensorPoint> read_sensor_points_text(std::string_view text, const std::string& name) {
  std::vector<SensorPoint> points;
  const auto read = [&](int line, const std::vector<std::string_view>& words) {
    const SensorPoint point = {read_point(words, 0, name, line),
                               unit_vector(read_point(words, 3, name, line)),
                               unit_vector(read_point(words, 6, name, line))};
    if (point.axis0.cross(point.axis1).norm() < kSmallestSine) {
      fail(name, line, "the axes a0 and a1 are zero or parallel; they span a plane");
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
