#include "hbar/core/scene/read_obj.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "hbar/core/scene/text_lines.h"

namespace hbar::scene {
namespace {

class ObjReader {
 public:
  explicit ObjReader(const std::string& name) : name_(name) {}

  void read_line(int line, const std::vector<std::string_view>& words) {
    constexpr std::array<std::string_view, 10> kSkipped = {"vt", "vn",     "vp",     "g", "o",
                                                           "s",  "usemtl", "mtllib", "l", "p"};
    const std::string_view keyword = words[0];
    if (keyword == "v") {
      read_vertex(line, words);
    } else if (keyword == "f") {
      read_face(line, words);
    } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
      fail_in_line(
          name_, line,
          concat("unknown keyword \"", quotable(keyword),
                 "\"; known: v, f, and skipped: vt, vn, vp, g, o, s, usemtl, mtllib, l, p"));
    }
  }

  [[nodiscard]] PolygonMesh take(int last_line) {
    if (mesh_.polygons.empty()) {
      fail_in_line(name_, std::max(1, last_line),
                   "the file has no face; a solid is bounded by faces");
    }
    const int count = vertex_count();
    for (const Polygon& polygon : mesh_.polygons) {
      for (const int corner : polygon.corners) {
        if (corner >= count) {
          fail_in_line(name_, polygon.line,
                       concat("vertex ", corner + 1, " does not exist; the file has ", count));
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] int vertex_count() const { return static_cast<int>(mesh_.vertices.size()); }

  void read_vertex(int line, const std::vector<std::string_view>& words) {
    // After the point, some programs write a weight or a colour.
    const std::size_t count = words.size() - 1;
    if (count != 3 && count != 4 && count != 6 && count != 7) {
      fail_in_line(
          name_, line,
          concat("v has ", count, " numbers; a vertex is v x y z, with a weight or a colour"));
    }
    mesh_.vertices.push_back(point_in_words(words, 1, name_, line));
  }

  void read_face(int line, const std::vector<std::string_view>& words) {
    Polygon polygon{{}, line};
    for (std::size_t i = 1; i < words.size(); ++i) {
      polygon.corners.push_back(read_corner(line, words[i]));
    }
    if (polygon.corners.size() < 3) {
      fail_in_line(name_, line,
                   concat("f has ", polygon.corners.size(), " corners; a face has at least 3"));
    }
    mesh_.polygons.push_back(std::move(polygon));
  }

  /// The vertex of a corner, from 0; the rest must be whole numbers or nothing, and is dropped.
  int read_corner(int line, std::string_view corner) {
    const std::string form = "; a corner is v, v/vt, v//vn or v/vt/vn";
    std::optional<int> given;
    std::string_view rest = corner;
    int part = 0;
    for (bool more = true; more; ++part) {
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      const std::string_view word = rest.substr(0, slash);
      more = slash < rest.size();
      rest.remove_prefix(std::min(slash + 1, rest.size()));
      if (part > 2) {
        fail_in_line(name_, line, concat("\"", quotable(corner), "\" has too many /", form));
      }
      if (word.empty() && part > 0) {
        continue;
      }
      std::string reason;
      const std::optional<int> number = parse_integer(word, reason);
      if (!number) {
        fail_in_line(name_, line, concat("\"", quotable(corner), "\": ", reason, form));
      }
      given = part == 0 ? number : given;
    }
    const int index = *given < 0 ? vertex_count() + *given : *given - 1;
    if (index < 0) {
      fail_in_line(name_, line,
                   *given == 0 ? std::string("vertex 0 does not exist; they are counted from 1")
                               : concat("vertex ", *given, " does not exist; ", vertex_count(),
                                        " are defined before this line"));
    }
    return index;
  }

  const std::string& name_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_obj_text(std::string_view text, const std::string& name) {
  ObjReader reader(name);
  const int last = for_each_line(text, [&](int line, const std::vector<std::string_view>& words) {
    reader.read_line(line, words);
  });
  return reader.take(last);
}

}  // namespace hbar::scene
