#include "hbar/core/scene/read_stl.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "hbar/core/scene/text_lines.h"

namespace hbar::scene {
namespace {

constexpr std::size_t kHeader = 80;
constexpr std::size_t kFacet = 50;  // a normal, three corners, two bytes

/// Four bytes, the least significant first.
std::uint32_t word_at(std::string_view bytes, std::size_t place) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) {
    word = word << 8U | static_cast<unsigned char>(bytes[place + i]);
  }
  return word;
}

void add_facet(PolygonMesh& mesh, const std::array<Eigen::Vector3d, 3>& corners, int line) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.polygons.push_back({{first, first + 1, first + 2}, line});
}

PolygonMesh read_binary(std::string_view bytes, const std::string& name) {
  PolygonMesh mesh;
  const std::size_t count = word_at(bytes, kHeader);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 9; ++k) {
      const std::size_t place = kHeader + 4 + kFacet * i + 12 + 4 * k;
      const auto number = static_cast<double>(std::bit_cast<float>(word_at(bytes, place)));
      if (!std::isfinite(number)) {
        throw InvalidInput(concat(name, ": facet ", i + 1, ": a coordinate is not finite"));
      }
      corners[k / 3][static_cast<Eigen::Index>(k % 3)] = number;
    }
    add_facet(mesh, corners, 0);
  }
  return mesh;
}

/// The words of an ASCII file, in their order: solid (facet normal ... outer loop vertex ...
/// endloop endfacet)* endsolid, once or more often.
class AsciiReader {
 public:
  explicit AsciiReader(const std::string& name) : name_(name) {}

  void read_line(int line, const std::vector<std::string_view>& words) {
    const std::string_view keyword = words[0];
    if (keyword == "vertex") {
      if (words.size() != 4 || corner_ > 2 || !in_facet_) {
        fail_in_line(name_, line, "a facet has three lines \"vertex x y z\"");
      }
      corners_[corner_++] = point_in_words(words, 1, name_, line);
    } else if (keyword == "facet") {
      in_facet_ = true;
      corner_ = 0;
    } else if (keyword == "endfacet") {
      if (corner_ != 3) {
        fail_in_line(name_, line, concat("the facet has ", corner_, " vertices; it has three"));
      }
      add_facet(mesh_, corners_, line);
      in_facet_ = false;
      corner_ = 0;
    } else if (keyword != "solid" && keyword != "endsolid" && keyword != "outer" &&
               keyword != "endloop") {
      fail_in_line(name_, line,
                   concat("unknown word \"", quotable(keyword),
                          "\"; known: solid, facet, outer loop, vertex, endloop, endfacet, "
                          "endsolid"));
    }
    ended_ = keyword == "endsolid";
  }

  PolygonMesh take(int last) {
    if (!ended_) {
      fail_in_line(name_, std::max(1, last), "the file does not end with \"endsolid\": it was cut");
    }
    return std::move(mesh_);
  }

 private:
  const std::string& name_;
  PolygonMesh mesh_;
  std::array<Eigen::Vector3d, 3> corners_;
  std::size_t corner_ = 0;
  bool in_facet_ = false;
  bool ended_ = false;
};

}  // namespace

PolygonMesh read_stl_bytes(std::string_view bytes, const std::string& name) {
  const bool has_count = bytes.size() >= kHeader + 4;
  const std::size_t expected =
      has_count ? kHeader + 4 + kFacet * std::size_t{word_at(bytes, kHeader)} : 0;
  PolygonMesh mesh;
  if (has_count && bytes.size() == expected) {
    mesh = read_binary(bytes, name);
  } else if (bytes.starts_with("solid") || bytes.starts_with("\xef\xbb\xbfsolid")) {
    AsciiReader reader(name);
    mesh =
        reader.take(for_each_line(bytes, [&](int line, const std::vector<std::string_view>& words) {
          reader.read_line(line, words);
        }));
  } else {
    throw InvalidInput(
        has_count ? concat(name, ": the file has ", bytes.size(), " bytes; its ",
                           word_at(bytes, kHeader), " facets would take ", expected)
                  : concat(name, ": this is no STL file: neither \"solid\" nor a header of ",
                           kHeader + 4, " bytes"));
  }
  if (mesh.polygons.empty()) {
    throw InvalidInput(concat(name, ": the file has no facet; a solid is bounded by facets"));
  }
  return mesh;
}

}  // namespace hbar::scene
