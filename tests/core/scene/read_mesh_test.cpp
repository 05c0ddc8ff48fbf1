#include "hbar/core/scene/read_mesh.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

TEST(ReadMesh, TakesTheKindByTheExtension) {
  const MendedMesh wedge = read_mesh(HBAR_SOURCE_DIR "/tests/golden/scenes/wedge.obj");
  EXPECT_EQ(wedge.mesh.vertices.size(), 4U);
  EXPECT_EQ(wedge.mesh.triangles.size(), 4U);
  EXPECT_THROW(static_cast<void>(read_mesh("/no/such.obj")), IoError);
  EXPECT_THROW(static_cast<void>(read_mesh("/no/such.STL")), IoError);
}

TEST(ReadMesh, RefusesOtherKinds) {
  const std::string message = hbar::testing::message_of<InvalidInput>(
      [] { static_cast<void>(read_mesh("/no/such.step")); });
  EXPECT_EQ(message.substr(0, 78),
            "such.step: a mesh of the kind \".step\" is not read; this build reads .obj, .stl");
}

}  // namespace
}  // namespace hbar::scene
