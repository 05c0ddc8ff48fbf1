#include "hbar/core/scene/distance_cache.h"

#include <array>
#include <cstdint>
#include <string>

#include "hbar/core/base/checksum.h"
#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/text_file.h"
#include "hbar/core/geometry/distance_grid.h"

namespace hbar::scene {
namespace {

/// Version of the way grids are made from meshes: a new version gets a new file.
constexpr std::uint64_t kRecipe = 1;

std::string hexadecimal(std::uint64_t number) {
  std::string digits(16, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, number /= 16) {
    *digit = "0123456789abcdef"[number % 16];
  }
  return digits;
}

/// The grid cached in a file, or nothing.
std::shared_ptr<const DistanceField> read_grid(const std::filesystem::path& path) {
  try {
    return std::make_shared<DistanceGrid>(read_text_file(path));
  } catch (const IoError&) {  // the first time, there is none
    return nullptr;
  } catch (const InvalidInput&) {  // damaged
    return nullptr;
  }
}

}  // namespace

std::filesystem::path distance_cache_path(const TriangleMesh& mesh_in_body_frame, int cells,
                                          const std::filesystem::path& mesh_file) {
  Checksum sum;
  sum.add(kRecipe);
  sum.add(cells);
  sum.add(mesh_in_body_frame.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh_in_body_frame.vertices) {
    for (const double coordinate : vertex) {
      sum.add(coordinate);
    }
  }
  for (const std::array<int, 3>& triangle : mesh_in_body_frame.triangles) {
    for (const int index : triangle) {
      sum.add(index);
    }
  }
  std::filesystem::path path = mesh_file;
  path += "." + hexadecimal(sum.value()) + ".hbar-distance";
  return path;
}

std::shared_ptr<const DistanceField> cached_mesh_distance(const TriangleMesh& mesh_in_body_frame,
                                                          int cells,
                                                          const std::filesystem::path& mesh_file,
                                                          const std::atomic<bool>* stop) {
  const std::filesystem::path path = distance_cache_path(mesh_in_body_frame, cells, mesh_file);
  if (auto kept = read_grid(path)) {
    return kept;
  }
  auto grid = std::make_shared<DistanceGrid>(mesh_in_body_frame, cells, stop);
  try {
    write_file_atomically(path, grid->bytes());
  } catch (const IoError&) {  // only the next run's time is lost
  }
  return grid;
}

}  // namespace hbar::scene
