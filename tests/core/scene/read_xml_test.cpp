#include <cstdint>
#include <filesystem>
#include <random>

#include "hbar/core/files/text_file.h"
#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

TEST(ReadScene, ReadsEveryRecordedScene) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".xml") {
      continue;
    }
    SCOPED_TRACE(entry.path().string());
    const Scene scene = read_scene(entry.path());
    EXPECT_EQ(scene.file, entry.path().filename());
    EXPECT_EQ(scene.folder, kScenes);
    EXPECT_EQ(scene.description.model, entry.path().stem());
    EXPECT_EQ(scene.description.options.timestep, 0.0078125);
    EXPECT_FALSE(scene.description.robots.empty());
    ++count;
  }
  EXPECT_GE(count, 46);
}

TEST(ReadScene, SaysWhyAFileCannotBeRead) {
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      static_cast<void>(read_scene(path));
    } catch (const IoError& error) {
      return error.what();
    }
    return "was read";
  };
  EXPECT_EQ(refusal("/no/such/scene.xml"),
            "/no/such/scene.xml: cannot be opened: No such file or directory");
  EXPECT_EQ(refusal(kScenes), std::string(kScenes) + ": cannot be read: Is a directory");
}

TEST(ReadScene, NestedAndFlatLinksAreEqual) {
  const auto link = [](const std::string& name, const std::string& parent,
                       const std::string& inside) {
    const std::string attribute = parent.empty() ? "" : " parent=\"" + parent + "\"";
    return "<link name=\"" + name + "\"" + attribute +
           "><joint type=\"free2d\"/><body type=\"sphere\" radius=\"1\"/>" + inside + "</link>";
  };
  const auto read = [](const std::string& links) {
    return read_scene_text("<redmax><robot>" + links + "</robot></redmax>", "a.xml").description;
  };
  const Description nested =
      read(link("a", "", link("b", "", link("c", "", "")) + link("d", "", "")) + link("e", "", ""));
  const Description flat = read(link("a", "", "") + link("b", "a", "") + link("c", "b", "") +
                                link("d", "a", "") + link("e", "", ""));
  const Description mixed = read(link("a", "", link("b", "", "")) + link("c", "b", "") +
                                 link("d", "a", "") + link("e", "", ""));
  EXPECT_EQ(nested, flat);
  EXPECT_EQ(nested, mixed);
  EXPECT_EQ(nested.robots.at(0).links.at(3).parent, 0);
  EXPECT_EQ(nested.robots.at(0).links.at(4).parent, -1);
}

TEST(ReadScene, DefaultsFillWhatIsNotSaid) {
  const Description d =
      read_scene_text(scene_with_section("<default><joint damping=\"3\" lim_stiffness=\"5\"/>"
                                         "<body density=\"7\" rgba=\"1 1 1 1\"/>"
                                         "<motor P=\"10\" D=\"0.5\" ctrl_range=\"-2 2\"/></default>"
                                         "<default><joint damping=\"4\"/></default>"
                                         "<robot><link name=\"e\"><joint type=\"fixed\" "
                                         "damping=\"1\"/><body type=\"sphere\" radius=\"1\" "
                                         "density=\"2\"/></link></robot>"
                                         "<actuator><motor joint=\"j\" ctrl=\"position\" "
                                         "P=\"20\"/></actuator>"),
                      "a.xml")
          .description;
  const Link& said = d.robots.at(0).links.at(0);
  const Link& filled = d.robots.at(1).links.at(0);
  EXPECT_EQ(said.joint.damping, 1.0);
  EXPECT_EQ(said.body.density, 2.0);
  EXPECT_EQ(filled.joint.damping, 4.0);
  EXPECT_EQ(filled.joint.lim_stiffness, 5.0);
  EXPECT_EQ(filled.body.density, 7.0);
  EXPECT_EQ(filled.body.rgba, (Vec4{1.0, 1.0, 1.0, 1.0}));
  EXPECT_EQ(d.motors.at(0),
            (Motor{"j", Control::kPosition, Vec2{-2.0, 2.0}, 20.0, 0.5, false, {}}));
}

TEST(ReadScene, NoticesAMissingGroundAndDampingWithoutLawOnce) {
  const Scene scene = read_scene_text(
      scene_with_section("\n<contact><ground_contact body=\"b\" kn=\"1\" damping=\"1\"/>\n"
                         "<ground_contact body=\"d\" kn=\"1\" damping=\"1\"/></contact> f"),
      "a.xml");
  EXPECT_EQ(scene.notices,
            (std::vector<std::string>{
                "a.xml:4: <redmax>: the text \"f\" has no effect",
                "a.xml:3: <ground_contact>: damping without law is multiplied by the depth; "
                "law=\"linear\" is what earlier readers of this format do",
                "a.xml:3: <ground_contact>: the scene has no <ground>, so it is the plane z = 0"}));
}

TEST(ReadScene, HasNoNoticeOfASceneThatSaysItAll) {
  const Scene scene = read_scene_text(
      scene_with_section("<ground/><contact><ground_contact body=\"b\" kn=\"1\" damping=\"1\" "
                         "law=\"document\"/><general_primitive_contact general_body=\"d\" "
                         "primitive_body=\"b\" kn=\"1\" damping=\"1\"/></contact><sensor><tactile "
                         "body=\"b\" type=\"abstract\" kn=\"1\" spec=\"s.txt\"/></sensor>"),
      "a.xml");
  EXPECT_TRUE(scene.notices.empty()) << scene.notices.front();
}

TEST(ReadScene, ReadsAChainOfFiveThousandFlatLinks) {
  std::string text = "<redmax><robot>";
  for (int i = 0; i < 5000; ++i) {
    text += "<link name=\"l" + std::to_string(i) + "\"";
    if (i > 0) {
      text += " parent=\"l" + std::to_string(i - 1) + "\"";
    }
    text += "><joint type=\"revolute\" axis=\"0 0 1\"/><body type=\"sphere\" radius=\"1\"/></link>";
  }
  const Scene scene = read_scene_text(text + "</robot></redmax>", "a.xml");
  EXPECT_EQ(scene.description.robots.at(0).links.at(4999).parent, 4998);
}

TEST(ReadScene, EveryMutationIsReadOrRefused) {
  const std::string original = read_text_file(std::string(kScenes) + "/tactile_small.xml");
  std::mt19937 random(20240229);
  const std::string bytes = "<>/=\"'&! \n01-.eexyz\0\xff#;";
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = original;
    for (std::uint_fast32_t edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      const char byte = bytes[random() % bytes.size()];
      switch (random() % 4) {
        case 0:
          text[at] = byte;
          break;
        case 1:
          text.insert(at, 1, byte);
          break;
        case 2:
          text.erase(at, 1 + random() % 20);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 200));
          break;
      }
    }
    try {
      static_cast<void>(read_scene_text(text, "a.xml"));
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("a.xml:", 0), 0U) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

const std::vector<BadScene> kRefusedFiles = {
    {"no link", "<redmax model=\"x\"/>",
     "bad.xml:1: <redmax>: the scene has no link; <robot> holds at least one <link>"},
    {"near element", scene_with_section("<robt/>"),
     "bad.xml:2: <robt>: unknown element in <redmax>; did you mean 'robot'?"},
    {"far element", scene_with_section("<light_source/>"),
     "bad.xml:2: <light_source>: unknown element in <redmax>; known: option, solver_option, "
     "ground, default, robot, actuator, contact, variable, sensor, virtual"},
    {"element out of place", scene_with_section("<link/>"),
     "bad.xml:2: <link>: cannot stand in <redmax>; it belongs in <robot> or <link>"},
    {"root inside", scene_with_section("<redmax/>"),
     "bad.xml:2: <redmax>: cannot stand in <redmax>; it belongs in no other element"},
    {"element in one that holds none", scene_with_section("<option><robot/></option>"),
     "bad.xml:2: <robot>: cannot stand in <option>; it belongs in <redmax>"},
    {"two options", scene_with_section("<option/><option/>"),
     "bad.xml:2: <option>: a second one in this <redmax>, the first is in line 2; at most one is "
     "allowed"},
    {"nested element in a default",
     scene_with_section(
         "<default><body type=\"abstract\"><visual mesh=\"a.obj\"/></body></default>"),
     "bad.xml:2: <visual>: cannot be a default; only attributes can"},
};

TEST(ReadScene, RefusesWithTheWholeMessage) { expect_refused(kRefusedFiles); }

}  // namespace
}  // namespace hbar::scene
