#include "hbar/core/scene/load_model.h"

#include <gtest/gtest.h>

#include <fstream>

#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"
#include "tests/core/scene/scene_testing.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

TEST(LoadModel, IsReadingAndBuildingInOne) {
  const std::string path = std::string(kScenes) + "/b_mesh_obj_to_joint.xml";
  EXPECT_EQ(load_model(path).model, build_model(read_scene(path)));
}

TEST(LoadModel, KeepsTheNoticesAndThrowsAsReadingDoes) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.xml";
  std::ofstream(file) << scene_with_joint(
      "<joint type=\"revolute\" axis=\"0 0 1\" lim=\"1 2\" lim_stiffness=\"3\"/>");
  EXPECT_EQ(load_model(file).notices, read_scene(file).notices);
  EXPECT_EQ(load_model(file).notices.size(), 1U);
  EXPECT_THROW(static_cast<void>(load_model(folder / "b.xml")), IoError);
}

}  // namespace
}  // namespace hbar::scene
