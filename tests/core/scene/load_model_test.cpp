#include "hbar/core/scene/load_model.h"

#include <gtest/gtest.h>

#include <fstream>

#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"
#include "tests/core/scene/scene_testing.h"
#include "tests/support/message_of.h"
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

TEST(LoadModel, ReadsALongChainThatIsWrittenFlat) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "long.xml";
  constexpr int kLinks = 20'000;
  {
    std::ofstream out(file);
    out << "<redmax>\n<robot>\n";
    for (int i = 0; i < kLinks; ++i) {
      out << "<link name=\"l" << i << '"';
      if (i > 0) {
        out << " parent=\"l" << i - 1 << '"';
      }
      out << "><joint type=\"revolute\" axis=\"0 1 0\"/><body type=\"sphere\" radius=\"1\"/>"
             "</link>\n";
    }
    out << "</robot>\n</redmax>\n";
  }
  const Model model = load_model(file).model;
  EXPECT_EQ(model.dof(), kLinks);
  EXPECT_EQ(model.link(kLinks - 1).parent, kLinks - 2);
}

TEST(LoadModel, StopsWhenAsked) {
  const std::atomic<bool> stop = true;
  EXPECT_EQ(
      testing::message_of<Interrupted>([&] {
        static_cast<void>(load_model(std::string(kScenes) + "/b_mesh_obj_to_joint.xml", &stop));
      }),
      "b_mesh_obj_to_joint.xml: loading interrupted at link 'a'");
}

}  // namespace
}  // namespace hbar::scene
