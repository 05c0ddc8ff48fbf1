#include <tuple>

#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

Link only_link(const std::string& text) {
  return read_scene_text(text, "a.xml").description.robots.at(0).links.at(0);
}

TEST(EveryJointType, IsRead) {
  const std::vector<std::tuple<std::string, JointType, std::string>> types = {
      {"fixed", JointType::kFixed, ""},
      {"revolute", JointType::kRevolute, "axis=\"0 0 2\""},
      {"prismatic", JointType::kPrismatic, "axis=\"0 0 2\""},
      {"planar", JointType::kPlanar, "axis0=\"1 0 0\" axis1=\"0 1 1\""},
      {"translational", JointType::kTranslational, ""},
      {"free2d", JointType::kFree2d, ""},
      {"spherical", JointType::kSphericalEuler, ""},
      {"spherical-euler", JointType::kSphericalEuler, ""},
      {"spherical-exp", JointType::kSphericalExp, ""},
      {"free3d", JointType::kFree3dEuler, ""},
      {"free3d-euler", JointType::kFree3dEuler, ""},
      {"free3d-exp", JointType::kFree3dExp, ""},
      {"universal", JointType::kUniversal, ""}};
  for (const auto& [name, type, more] : types) {
    SCOPED_TRACE(name);
    const Joint joint =
        only_link(scene_with_joint("<joint type=\"" + name + "\" " + more + "/>")).joint;
    EXPECT_EQ(joint.type, type);
    EXPECT_EQ(joint.rest.size(), static_cast<std::size_t>(coordinate_count(type)));
    EXPECT_EQ(joint.axis.has_value(),
              type == JointType::kRevolute || type == JointType::kPrismatic);
    EXPECT_EQ(joint.axis0.has_value(), type == JointType::kPlanar || type == JointType::kUniversal);
  }
}

TEST(Joints, AreReadWithAllTheyHave) {
  const Joint joint =
      only_link(scene_with_joint("<joint name=\"hinge\" type=\"revolute\" frame=\"WORLD\" "
                                 "pos=\"1 2 3\" quat=\"0 0 0 2\" axis=\"0 0 5\" damping=\"0.5\" "
                                 "stiffness=\"2\" rest=\"0.25\" lim=\"-1 1.5\" "
                                 "lim_stiffness=\"7\"/>"))
          .joint;
  const Joint expected{"hinge",
                       JointType::kRevolute,
                       Frame::kWorld,
                       {1.0, 2.0, 3.0},
                       {0.0, 0.0, 0.0, 1.0},
                       Vec3{0.0, 0.0, 5.0},
                       {},
                       {},
                       0.5,
                       2.0,
                       {0.25},
                       Vec2{-1.0, 1.5},
                       7.0,
                       {}};
  EXPECT_EQ(joint, expected);
  EXPECT_EQ(joint.line.number, 4);
}

TEST(EveryBodyType, IsReadWithAllItHas) {
  const auto shape = [](const std::string& attributes) {
    return only_link(scene_with_body("<body " + attributes + "/>")).body.shape;
  };
  EXPECT_EQ(shape("type=\"cuboid\" size=\"1 2 3\" general_contact_resolution=\"2 3 4\""),
            BodyShape(CuboidBody{{1.0, 2.0, 3.0}, {2, 3, 4}}));
  EXPECT_EQ(shape("type=\"sphere\" radius=\"2\" general_contact_resolution=\"3 4\""),
            BodyShape(SphereBody{2.0, std::array<int, 2>{3, 4}}));
  EXPECT_EQ(shape("type=\"cylinder\" radius=\"2\" length=\"3\" general_contact_angle_resolution="
                  "\"4\" general_contact_radius_resolution=\"5\""),
            BodyShape(CylinderBody{2.0, 3.0, 4, 5}));
  EXPECT_EQ(shape("type=\"capsule\" radius=\"2\" length=\"3\" general_contact_resolution=\"4 5\""),
            BodyShape(CapsuleBody{2.0, 3.0, {4, 5}}));
  EXPECT_EQ(
      shape("type=\"mesh\" filename=\"a.obj\" scale=\"1 2 3\" transform_type="
            "\"OBJ_TO_WORLD\" contacts=\"c.txt\" contact_count=\"9\" distance_cells=\"32\""),
      BodyShape(MeshBody{"a.obj", {1.0, 2.0, 3.0}, MeshTransform::kObjToWorld, "c.txt", 9, 32}));
  EXPECT_EQ(shape("type=\"abstract\" mass=\"2\" inertia=\"1 0 0 1 0 1\" mesh=\"a.obj\" "
                  "contacts=\"c.txt\" scale=\"1 2 3\""),
            BodyShape(AbstractBody{
                2.0, {1.0, 0.0, 0.0, 1.0, 0.0, 1.0}, "a.obj", "c.txt", {1.0, 2.0, 3.0}, {}, {}}));
}

TEST(Bodies, AreReadWithTheirChildren) {
  const Body body =
      only_link(
          scene_with_body("<body name=\"tip\" type=\"abstract\" mass=\"2\" inertia=\"1 2 3\" "
                          "pos=\"1 2 3\" quat=\"2 0 0 0\" rgba=\"0 1 0 1\" texture=\"t.png\">"
                          "<visual mesh=\"v.obj\" pos=\"1 0 0\" quat=\"0 1 0 0\"/>"
                          "<collision contacts=\"c.txt\" pos=\"2 0 0\" quat=\"0 0 1 0\"/></body>"))
          .body;
  AbstractBody shape;
  shape.mass = 2.0;
  shape.inertia = {1.0, 2.0, 3.0};
  shape.visual = Visual{"v.obj", {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}};
  shape.collision = Collision{"c.txt", {2.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}};
  EXPECT_EQ(body, (Body{"tip",
                        shape,
                        {1.0, 2.0, 3.0},
                        {1.0, 0.0, 0.0, 0.0},
                        1.0,
                        Vec4{0.0, 1.0, 0.0, 1.0},
                        "t.png",
                        {}}));
}

TEST(Links, TakeNamesFromEachOther) {
  const auto names = [](const std::string& link, const std::string& joint,
                        const std::string& body) {
    const auto attribute = [](const std::string& name) {
      return name.empty() ? "" : " name=\"" + name + "\"";
    };
    const Link read = only_link(
        "<redmax><robot><link" + attribute(link) + "><joint type=\"fixed\"" + attribute(joint) +
        "/><body type=\"sphere\" radius=\"1\"" + attribute(body) + "/></link></robot></redmax>");
    return std::vector<std::string>{read.name, read.joint.name, read.body.name};
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("l", "j", "b"), (Names{"l", "j", "b"}));
  EXPECT_EQ(names("l", "", ""), (Names{"l", "l", "l"}));
  EXPECT_EQ(names("", "j", "b"), (Names{"b", "j", "b"}));
  EXPECT_EQ(names("", "j", ""), (Names{"j", "j", "j"}));
}

TEST(Links, LimitsThatExcludeTheStartAreNoticed) {
  EXPECT_EQ(
      read_scene_text(
          scene_with_joint("<joint type=\"revolute\" axis=\"0 1 0\" lim=\"-3.07 -0.07\"/>"),
          "a.xml")
          .notices,
      (std::vector<std::string>{
          "a.xml:4: <joint>: the limits exclude the start configuration 0; give a start inside "
          "them",
          "a.xml:4: <joint>: lim has no effect on the motion without lim_stiffness, which is 0; it "
          "bounds optimisations alone (a)"}));
  const Scene scene = read_scene_text(
      scene_with_joint("<joint type=\"revolute\" axis=\"0 0 1\" lim=\"1 2\" lim_stiffness=\"3\"/>"),
      "a.xml");
  EXPECT_EQ(scene.notices,
            std::vector<std::string>{"a.xml:4: <joint>: the limits exclude the start "
                                     "configuration 0; their spring pulls it"});
}

const std::vector<BadScene> kRefusedLinks = {
    {"unknown type", scene_with_joint("<joint type=\"hinge\"/>"),
     "bad.xml:4: <joint type=\"hinge\">: unknown type; type takes one of fixed, revolute, "
     "prismatic, planar, translational, free2d, spherical-euler, spherical-exp, free3d-euler, "
     "free3d-exp, universal, spherical, free3d"},
    {"missing type", scene_with_joint("<joint/>"),
     "bad.xml:4: <joint>: attribute type is missing; type takes one of fixed, revolute, prismatic, "
     "planar, translational, free2d, spherical-euler, spherical-exp, free3d-euler, free3d-exp, "
     "universal, spherical, free3d"},
    {"missing axis", scene_with_joint("<joint type=\"revolute\"/>"),
     "bad.xml:4: <joint>: attribute axis is missing; axis takes 3 numbers, not all 0"},
    {"zero axis", scene_with_joint("<joint type=\"revolute\" axis=\"0 0 0\"/>"),
     "bad.xml:4: <joint axis=\"0 0 0\">: all numbers are 0; axis takes 3 numbers, not all 0"},
    {"parallel planar axes",
     scene_with_joint("<joint type=\"planar\" axis0=\"1 0 0\" axis1=\"-2 0 0\"/>"),
     "bad.xml:4: <joint axis1=\"-2 0 0\">: parallel to axis0; the two axes must not be parallel"},
    {"parallel universal axes", scene_with_joint("<joint type=\"universal\" axis0=\"0 1 0\"/>"),
     "bad.xml:4: <joint axis1=\"0 1 0\">: parallel to axis0; the two axes must not be parallel"},
    {"limits reversed", scene_with_joint("<joint type=\"revolute\" axis=\"0 0 1\" lim=\"1 -1\"/>"),
     "bad.xml:4: <joint lim=\"1 -1\">: the lower number is above the upper one; lim takes 2 "
     "numbers, lower <= upper"},
    {"negative damping", scene_with_joint("<joint type=\"fixed\" damping=\"-1\"/>"),
     "bad.xml:4: <joint damping=\"-1\">: out of range; damping takes 1 number >= 0"},
    {"negative stiffness", scene_with_joint("<joint type=\"free2d\" stiffness=\"-1\"/>"),
     "bad.xml:4: <joint stiffness=\"-1\">: out of range; stiffness takes 1 number >= 0"},
    {"negative limit stiffness", scene_with_joint("<joint type=\"fixed\" lim_stiffness=\"-1\"/>"),
     "bad.xml:4: <joint lim_stiffness=\"-1\">: out of range; lim_stiffness takes 1 number >= 0"},
    {"rest of the wrong size", scene_with_joint("<joint type=\"free2d\" rest=\"0 0\"/>"),
     "bad.xml:4: <joint rest=\"0 0\">: found 2 numbers; rest takes one number per joint "
     "coordinate"},
    {"unknown frame", scene_with_joint("<joint type=\"fixed\" frame=\"PARENT\"/>"),
     "bad.xml:4: <joint frame=\"PARENT\">: unknown frame; frame takes one of LOCAL, WORLD"},
    {"unknown body", scene_with_body("<body type=\"torus\"/>"),
     "bad.xml:5: <body type=\"torus\">: unknown type; type takes one of cuboid, sphere, cylinder, "
     "capsule, mesh, abstract"},
    {"side of no length", scene_with_body("<body type=\"cuboid\" size=\"1 0 1\"/>"),
     "bad.xml:5: <body size=\"1 0 1\">: out of range; size takes 3 numbers > 0"},
    {"missing size", scene_with_body("<body type=\"cuboid\"/>"),
     "bad.xml:5: <body>: attribute size is missing; size takes 3 numbers > 0"},
    {"negative radius", scene_with_body("<body type=\"sphere\" radius=\"-1\"/>"),
     "bad.xml:5: <body radius=\"-1\">: out of range; radius takes 1 number > 0"},
    {"capsule of no length", scene_with_body("<body type=\"capsule\" radius=\"1\" length=\"0\"/>"),
     "bad.xml:5: <body length=\"0\">: out of range; length takes 1 number > 0"},
    {"density of nothing", scene_with_body("<body type=\"sphere\" radius=\"1\" density=\"0\"/>"),
     "bad.xml:5: <body density=\"0\">: out of range; density takes 1 number > 0"},
    {"mass of nothing", scene_with_body("<body type=\"abstract\" mass=\"0\" inertia=\"1 1 1\"/>"),
     "bad.xml:5: <body mass=\"0\">: out of range; mass takes 1 number > 0"},
    {"negative moment", scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 -1\"/>"),
     "bad.xml:5: <body inertia=\"1 1 -1\">: a moment is not positive; principal moments are > 0 "
     "and none is above the sum of the other two"},
    {"unphysical moments",
     scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 2.5\"/>"),
     "bad.xml:5: <body inertia=\"1 1 2.5\">: one moment is above the sum of the other two, by 0.2 "
     "of it; "
     "principal moments are > 0 and none is above the sum of the other two"},
    {"four moments", scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1 1\"/>"),
     "bad.xml:5: <body inertia=\"1 1 1 1\">: found 4 numbers; inertia takes 3 or 6 numbers"},
    {"indefinite inertia",
     scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"1 2 0 1 0 1\"/>"),
     "bad.xml:5: <body inertia=\"1 2 0 1 0 1\">: a moment is not positive; the principal moments "
     "are > 0 and none is above the sum of the other two"},
    {"unphysical inertia",
     scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"1 0.9 0 1 0 0.5\"/>"),
     "bad.xml:5: <body inertia=\"1 0.9 0 1 0 0.5\">: one moment is above the sum of the other two, "
     "by 0.684211 of it; "
     "the principal moments are > 0 and none is above the sum of the other two"},
    {"missing file", scene_with_body("<body type=\"mesh\"/>"),
     "bad.xml:5: <body>: attribute filename is missing; filename takes a text that is not empty"},
    {"flattened mesh", scene_with_body("<body type=\"mesh\" filename=\"a.obj\" scale=\"1 1 0\"/>"),
     "bad.xml:5: <body scale=\"1 1 0\">: out of range; scale takes 3 numbers, none 0"},
    {"grid of one point",
     scene_with_body("<body type=\"cuboid\" size=\"1 1 1\" general_contact_resolution=\"1 2 2\"/>"),
     "bad.xml:5: <body general_contact_resolution=\"1 2 2\">: out of range; "
     "general_contact_resolution takes 3 whole numbers >= 2"},
    {"too many points of a cuboid",
     scene_with_body(
         "<body type=\"cuboid\" size=\"1 1 1\" general_contact_resolution=\"3000 3000 3000\"/>"),
     "bad.xml:5: <body general_contact_resolution=\"3000 3000 3000\">: that makes 5.3964e+07 "
     "contact points; a body has at most 1000000"},
    {"too many points of a ball",
     scene_with_body(
         "<body type=\"sphere\" radius=\"1\" general_contact_resolution=\"2000 1000\"/>"),
     "bad.xml:5: <body general_contact_resolution=\"2000 1000\">: that makes 2e+06 contact points; "
     "a body has at most 1000000"},
    {"too many points of a cylinder",
     scene_with_body("<body type=\"cylinder\" radius=\"1\" length=\"1\" "
                     "general_contact_angle_resolution=\"2000000000\"/>"),
     "bad.xml:5: <body general_contact_angle_resolution=\"2000000000\">: that makes 1.2e+10 "
     "contact points; a body has at most 1000000"},
    {"too many points of a capsule",
     scene_with_body("<body type=\"capsule\" radius=\"1\" length=\"1\" "
                     "general_contact_resolution=\"2000 1000\"/>"),
     "bad.xml:5: <body general_contact_resolution=\"2000 1000\">: that makes 2e+06 contact points; "
     "a body has at most 1000000"},
    {"too many vertices",
     scene_with_body("<body type=\"mesh\" filename=\"a.obj\" contact_count=\"1000001\"/>"),
     "bad.xml:5: <body contact_count=\"1000001\">: out of range; contact_count takes 1 whole "
     "number "
     "from 1 to 1000000"},
    {"visual of a solid",
     scene_with_body("<body type=\"sphere\" radius=\"1\"><visual mesh=\"a.obj\"/></body>"),
     "bad.xml:5: <visual>: stands in a body that is not abstract; only those have it"},
    {"no joint",
     scene_with_section(
         "<robot><link name=\"z\"><body type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:2: <link>: has no <joint>; a link has one <joint> and one <body>"},
    {"no body",
     scene_with_section("<robot><link name=\"z\"><joint type=\"fixed\"/></link></robot>"),
     "bad.xml:2: <link>: has no <body>; a link has one <joint> and one <body>"},
    {"two joints",
     scene_with_section(
         "<robot><link name=\"z\"><joint type=\"fixed\"/><joint type=\"fixed\"/></link></robot>"),
     "bad.xml:2: <joint>: a second one in this <link>, the first is in line 2; at most one is "
     "allowed"},
    {"no name",
     scene_with_section(
         "<robot><link><joint type=\"fixed\"/><body type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:2: <link>: attribute name is missing; name the link, its joint or its body"},
    {"dangling parent",
     scene_with_section("<robot><link name=\"z\" parent=\"y\"><joint type=\"fixed\"/><body "
                        "type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:2: <link parent=\"y\">: no link of this name comes before in this robot; parent "
     "names an earlier link of the same robot"},
    {"nested with parent",
     scene_with_section("<robot><link name=\"z\"><joint type=\"fixed\"/><body type=\"sphere\" "
                        "radius=\"1\"/><link name=\"y\" parent=\"z\"><joint type=\"fixed\"/><body "
                        "type=\"sphere\" radius=\"1\"/></link></link></robot>"),
     "bad.xml:2: <link parent=\"z\">: this link is nested; only links written under <robot> have "
     "parent"},
};

TEST(Links, RefusesWithTheWholeMessage) { expect_refused(kRefusedLinks); }

}  // namespace
}  // namespace hbar::scene
