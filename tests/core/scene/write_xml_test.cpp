#include "hbar/core/scene/write_xml.h"

#include <filesystem>
#include <limits>

#include "hbar/core/files/text_file.h"
#include "tests/core/scene/scene_testing.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

Link make_link(const std::string& name, int parent, const BodyShape& shape) {
  Link link;
  link.name = name;
  link.parent = parent;
  link.joint.name = name + "_joint";
  link.body.name = name + "_body";
  link.body.shape = shape;
  return link;
}

Description back(const Description& description) {
  return read_scene_text(write_scene_text(description), "written.xml").description;
}

/// A description with every value different from its default, where it has one.
Description everything() {
  Description d;
  d.model = "all <of> \"it\" & more";
  d.options = {Integrator::kSdirk2, 1.0 / 3.0, {0.1, -0.2, 1e-300}, UnitSystem::kMKg};
  d.solver_options = {1e-7, 1e-5, 17, 9, "klu"};
  d.ground = Ground{{1.0, 2.0, 3.0}, {0.0, 0.1, 0.9}, {}};
  Robot robot;
  robot.links.push_back(make_link("box", -1, CuboidBody{{1.1, 2.2, 3.3}, {3, 4, 5}}));
  robot.links.push_back(make_link("ball", 0, SphereBody{0.7, std::array<int, 2>{4, 5}}));
  robot.links.push_back(make_link("can", 0, CylinderBody{0.3, 0.9, 5, 6}));
  robot.links.push_back(make_link("pill", 2, CapsuleBody{0.3, 0.9, {6, 7}}));
  robot.links.push_back(
      make_link("part", 3,
                MeshBody{"a b.obj", {1.5, 2.5, 3.5}, MeshTransform::kObjToWorld, "c.txt", 11, 96}));
  AbstractBody abstract{2.5, {2.0, 0.1, 0.2, 3.0, 0.3, 4.0}, "m.obj", "c.txt", {2.0, 3.0, 4.0}, {},
                        {}};
  abstract.visual = Visual{"v.obj", {0.1, 0.2, 0.3}, {0.0, 0.6, 0.8, 0.0}};
  abstract.collision = Collision{"k.txt", {0.4, 0.5, 0.6}, {0.8, 0.0, 0.0, 0.6}};
  robot.links.push_back(make_link("tip", 0, abstract));
  Link& box = robot.links[0];
  box.design_params = 63;
  box.body = {"box_body", box.body.shape,           {0.1, 0.2, 0.3}, {0.6, 0.0, 0.8, 0.0},
              7.5,        Vec4{0.1, 0.2, 0.3, 0.4}, "wood.png",      {}};
  box.joint = {"box_joint",
               JointType::kPlanar,
               Frame::kWorld,
               {1.0, 2.0, 3.0},
               {0.8, 0.6, 0.0, 0.0},
               {},
               Vec3{1.0, 0.0, 0.1},
               Vec3{0.0, 2.0, 0.0},
               0.1,
               0.2,
               {0.3, 0.4},
               Vec2{-0.5, 0.6},
               0.7,
               {}};
  robot.links[1].joint.type = JointType::kRevolute;
  robot.links[1].joint.axis = Vec3{0.3, 0.4, 0.5};
  robot.links[1].joint.rest = {0.25};
  d.robots = {robot, Robot{{make_link("other", -1, CuboidBody{})}}};
  d.motors = {{"box_joint", Control::kForce, Vec2{-1.5, 2.5}, {}, 0.0, false, {}},
              {"ball_joint", Control::kPosition, {}, 3.5, 4.5, true, {}}};
  Contact general{
      ContactKind::kGeneralPrimitive, "touch", "tip_body", "box_body", 1.5, 2.5, 3.5, 4.5};
  general.render = true;
  general.law = ContactLaw::kLinear;
  general.friction = Friction::kSmooth;
  general.friction_width = 0.125;
  general.adhesion = false;
  general.reaction = Reaction::kSurface;
  general.caps = false;
  d.contacts = {general,
                {ContactKind::kGround, {}, "box_body", ""},
                {ContactKind::kCuboidCuboid, {}, "box_body", "other_body"}};
  d.end_effectors = {{"tip_joint", {0.1, 0.2, 0.3}, 0.4, "tip", Vec4{1.0, 0.0, 0.0, 1.0}, {}},
                     {"box_joint", {}, {}, {}, {}, {}}};
  d.tactile_sensors = {
      {"tip_body",
       "pad",
       RectArray{{0.0, 0.0, 1.0}, {1.0, 2.0, 1.0}, {2.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, {4, 5}},
       1.5,
       2.5,
       3.5,
       4.5,
       false,
       {}},
      {"box_body",
       "skin",
       PointList{"s.txt", {1.0, 2.0, 3.0}, {0.0, 0.0, 0.6, 0.8}},
       0.0,
       0.0,
       0.0,
       0.0,
       {},
       {}}};
  d.virtual_shapes = {{"goal", VirtualSphere{0.5}, {1.0, 2.0, 3.0}, Vec4{0.0, 1.0, 0.0, 1.0}},
                      {{}, VirtualCuboid{{1.0, 2.0, 3.0}, {0.6, 0.8, 0.0, 0.0}}, {}, {}}};
  return d;
}

TEST(WriteScene, EveryRecordedSceneReadsBackEqual) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".xml") {
      continue;
    }
    SCOPED_TRACE(entry.path().string());
    const Description description = read_scene(entry.path()).description;
    EXPECT_EQ(back(description), description);
  }
}

TEST(WriteScene, EveryAttributeReadsBackEqual) {
  const Description description = everything();
  EXPECT_EQ(back(description), description);
  EXPECT_NE(back(description), Description());
}

TEST(WriteScene, LinksOfAnyOrderAndDepthReadBackEqual) {
  Description chain;
  chain.robots.resize(1);
  for (int i = 0; i < 500; ++i) {
    chain.robots[0].links.push_back(make_link("l" + std::to_string(i), i - 1, CuboidBody{}));
  }
  EXPECT_EQ(back(chain), chain);
  Description breadth_first;
  breadth_first.robots.resize(1);
  for (int i = 0; i < 20; ++i) {
    breadth_first.robots[0].links.push_back(
        make_link("l" + std::to_string(i), (i + 1) / 2 - 1, CuboidBody{}));
  }
  EXPECT_EQ(back(breadth_first), breadth_first);
}

TEST(WriteScene, RefusesWhatAFileCannotSay) {
  Description d;
  EXPECT_THROW(static_cast<void>(write_scene_text(d)), InvalidInput);  // no link
  d.robots.push_back(Robot{{make_link("a", -1, CuboidBody{})}});
  EXPECT_NO_THROW(static_cast<void>(write_scene_text(d)));
  Description other = d;
  other.options.timestep = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(write_scene_text(other)), InvalidInput);
  other = d;
  other.robots[0].links[0].parent = 0;
  EXPECT_THROW(static_cast<void>(write_scene_text(other)), InvalidInput);
  other = d;
  other.robots[0].links[0].joint.quat = {0.5, 0.0, 0.0, 0.0};
  EXPECT_THROW(static_cast<void>(write_scene_text(other)), InvalidInput);
  other = d;
  other.robots[0].links[0].joint.axis = Vec3{1.0, 0.0, 0.0};
  EXPECT_THROW(static_cast<void>(write_scene_text(other)), InvalidInput);
  other = d;
  other.contacts.push_back({ContactKind::kGround, {}, "a_body", ""});
  EXPECT_NO_THROW(static_cast<void>(write_scene_text(other)));
  other.contacts[0].friction_width = 1.0;  // of another friction
  EXPECT_THROW(static_cast<void>(write_scene_text(other)), InvalidInput);
}

TEST(WriteScene, WritesAFileThatReadsBackEqual) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "scene.xml";
  const Description description = everything();
  write_scene(path, description);
  EXPECT_EQ(read_scene(path).description, description);
  const std::string text = read_text_file(path);
  EXPECT_THROW(write_scene(path, Description()), InvalidInput);
  EXPECT_EQ(read_text_file(path), text);
}

}  // namespace
}  // namespace hbar::scene
