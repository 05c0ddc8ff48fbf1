#include "hbar/core/scene/distance_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "hbar/core/files/text_file.h"
#include "hbar/core/geometry/distance_grid.h"
#include "tests/support/solid_meshes.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

namespace fs = std::filesystem;

constexpr int kCells = 8;

std::string bytes_of(const std::shared_ptr<const DistanceField>& field) {
  return dynamic_cast<const DistanceGrid&>(*field).bytes();
}

TEST(DistanceCache, IsWrittenOnceAndReadAgain) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = star_mesh(1, 1);
  const fs::path path = distance_cache_path(mesh, kCells, folder / "a.obj");
  const std::string expected = DistanceGrid(mesh, kCells).bytes();
  EXPECT_EQ(bytes_of(cached_mesh_distance(mesh, kCells, folder / "a.obj")), expected);
  EXPECT_EQ(read_text_file(path), expected);
  EXPECT_EQ(folder.count(), 1);

  // A grid of another solid in its place shows that it is read.
  const std::string other = DistanceGrid(star_mesh(1, 2), kCells).bytes();
  write_file_atomically(path, other);
  EXPECT_EQ(bytes_of(cached_mesh_distance(mesh, kCells, folder / "a.obj")), other);
  EXPECT_EQ(folder.count(), 1);
}

TEST(DistanceCache, IsNamedAfterAllThatTheGridDependsOn) {
  const TriangleMesh mesh = star_mesh(1, 1);
  const fs::path path = distance_cache_path(mesh, kCells, "meshes/a.obj");
  const std::string name = path.filename().string();
  EXPECT_EQ(path.parent_path(), "meshes");
  EXPECT_EQ(name.substr(0, 6), "a.obj.");
  EXPECT_EQ(name.find_first_not_of("0123456789abcdef", 6), 22U);
  EXPECT_EQ(name.substr(22), ".hbar-distance");

  EXPECT_EQ(distance_cache_path(mesh, kCells, "meshes/a.obj"), path);
  EXPECT_NE(distance_cache_path(mesh, kCells + 1, "meshes/a.obj"), path);
  TriangleMesh altered = mesh;
  altered.vertices[3].z() = std::nextafter(altered.vertices[3].z(), 2.0);
  EXPECT_NE(distance_cache_path(altered, kCells, "meshes/a.obj"), path);
  altered = mesh;
  std::swap(altered.triangles[0], altered.triangles[1]);
  EXPECT_NE(distance_cache_path(altered, kCells, "meshes/a.obj"), path);
  altered = mesh;
  altered.vertices.emplace_back(0.0, 0.0, 0.0);
  EXPECT_NE(distance_cache_path(altered, kCells, "meshes/a.obj"), path);
}

TEST(DistanceCache, KeepsAlteredMeshesApart) {
  const TemporaryFolder folder;
  for (const unsigned seed : {1U, 2U}) {
    const TriangleMesh mesh = star_mesh(1, seed);
    const auto field = cached_mesh_distance(mesh, kCells, folder / "a.obj");
    EXPECT_EQ(bytes_of(field), DistanceGrid(mesh, kCells).bytes());
  }
  EXPECT_EQ(folder.count(), 2);
}

TEST(DistanceCache, IsMadeAnewWhereDamaged) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = star_mesh(1, 1);
  const fs::path path = distance_cache_path(mesh, kCells, folder / "a.obj");
  const std::string good = DistanceGrid(mesh, kCells).bytes();
  std::string flipped = good;
  flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 4);
  for (const std::string& damaged :
       {std::string(), std::string("text"), good.substr(0, good.size() / 2), flipped}) {
    write_file_atomically(path, damaged);
    EXPECT_EQ(bytes_of(cached_mesh_distance(mesh, kCells, folder / "a.obj")), good);
    EXPECT_EQ(read_text_file(path), good);
  }
  EXPECT_EQ(folder.count(), 1);
}

TEST(DistanceCache, GoesWithoutAFileWhereNoneCanBe) {
  const TriangleMesh mesh = star_mesh(1, 1);
  const std::string expected = DistanceGrid(mesh, kCells).bytes();
  EXPECT_EQ(bytes_of(cached_mesh_distance(mesh, kCells, "/no/such/folder/a.obj")), expected);

  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(bytes_of(cached_mesh_distance(mesh, kCells, folder / "a.obj")), expected);
  EXPECT_EQ(folder.count(), ::geteuid() == 0 ? 1 : 0);  // root may write anywhere

  const TemporaryFolder taken;  // by a folder of the file's name
  fs::create_directory(distance_cache_path(mesh, kCells, taken / "a.obj"));
  EXPECT_EQ(bytes_of(cached_mesh_distance(mesh, kCells, taken / "a.obj")), expected);
}

TEST(DistanceCache, RefusesWhatBoundsNoSolidAndSaysWhere) {
  const TemporaryFolder folder;
  TriangleMesh mesh = box_mesh({1.0, 1.0, 1.0});
  mesh.triangles.pop_back();
  try {
    const auto field = cached_mesh_distance(mesh, kCells, folder / "a.obj");
    FAIL() << "an open surface was accepted";
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(),
                 "mesh: the edge from (0.5, -0.5, 0.5) to (0.5, 0.5, 0.5) has one triangle; a "
                 "closed surface has two at each edge");
  }
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace hbar::scene
