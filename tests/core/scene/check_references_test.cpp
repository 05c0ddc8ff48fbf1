#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

TEST(References, MayPrecedeWhatTheyName) {
  EXPECT_NO_THROW(static_cast<void>(
      read_scene_text(scene_with_section("<actuator><motor joint=\"j\"/></actuator>"
                                         "<contact><ground_contact body=\"b\"/></contact>"
                                         "<variable><endeffector joint=\"k\"/></variable>"),
                      "a.xml")));
}

TEST(References, NamesOfDifferentKindsMayBeEqual) {
  EXPECT_NO_THROW(static_cast<void>(read_scene_text(
      scene_with_section("<robot><link name=\"b\"><joint name=\"d\" type=\"fixed\"/><body "
                         "name=\"j\" type=\"sphere\" radius=\"1\"/></link></robot>"),
      "a.xml")));
}

/// A robot whose body "f" is abstract and has no contact points.
const std::string kAbstractRobot =
    "<robot><link name=\"f\"><joint type=\"fixed\"/><body type=\"abstract\" mass=\"1\" "
    "inertia=\"1 1 1\"/></link></robot>";

TEST(References, ToBodiesThatHavePointsAreTaken) {
  const auto robot = [](const std::string& body) {
    return "<robot><link name=\"f\"><joint type=\"fixed\"/>" + body + "</link></robot>";
  };
  for (const std::string body :
       {"<body type=\"sphere\" radius=\"1\"/>",
        "<body type=\"sphere\" radius=\"1\" general_contact_resolution=\"2 3\"/>",
        "<body type=\"mesh\" filename=\"m.obj\"/>",
        "<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1\" contacts=\"c.txt\"/>",
        "<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1\"><collision "
        "contacts=\"c.txt\"/></body>"}) {
    EXPECT_NO_THROW(static_cast<void>(read_scene_text(
        scene_with_section("<contact><general_primitive_contact general_body=\"f\" "
                           "primitive_body=\"b\"/><ground_contact body=\"f\"/></contact>" +
                           robot(body)),
        "a.xml")));
  }
}

const std::vector<BadScene> kRefusedReferences = {
    {"motor of a missing joint", scene_with_section("<actuator><motor joint=\"jj\"/></actuator>"),
     "bad.xml:2: <motor joint=\"jj\">: no joint has this name; did you mean 'j'?"},
    {"motor of a fixed joint", scene_with_section("<actuator><motor joint=\"k\"/></actuator>"),
     "bad.xml:2: <motor joint=\"k\">: this joint is fixed; motors drive joints that move"},
    {"two motors on one joint",
     scene_with_section("<actuator><motor joint=\"j\"/>\n<motor joint=\"j\"/></actuator>"),
     "bad.xml:3: <motor joint=\"j\">: the motor of line 2 drives this joint; a joint has at most "
     "one motor"},
    {"end effector of a missing joint",
     scene_with_section("<variable><endeffector joint=\"finger_tip\"/></variable>"),
     "bad.xml:2: <endeffector joint=\"finger_tip\">: no joint has this name; known: j, k"},
    {"contact of a missing body",
     scene_with_section("<contact><ground_contact body=\"x\"/></contact>"),
     "bad.xml:2: <ground_contact body=\"x\">: no body has this name; did you mean 'b'?"},
    {"contact without points of an abstract body",
     scene_with_section("<contact><ground_contact body=\"f\"/></contact>" + kAbstractRobot),
     "bad.xml:2: <ground_contact body=\"f\">: this abstract body has no contact points; give its "
     "<body> contacts or a <collision>"},
    {"contact without points of a ball",
     scene_with_section("<contact><general_primitive_contact general_body=\"b\" "
                        "primitive_body=\"m\"/></contact><robot><link name=\"m\"><joint "
                        "type=\"fixed\"/><body type=\"mesh\" filename=\"m.obj\"/></link></robot>"),
     "bad.xml:2: <general_primitive_contact general_body=\"b\">: this ball has no contact points, "
     "which a mesh needs; give its <body> general_contact_resolution, or make it the "
     "primitive_body"},
    {"contact with an abstract body",
     scene_with_section("<contact><general_primitive_contact general_body=\"d\" "
                        "primitive_body=\"f\"/></contact>" +
                        kAbstractRobot),
     "bad.xml:2: <general_primitive_contact primitive_body=\"f\">: an abstract body has no "
     "distance; primitive_body names a cuboid, sphere, cylinder, capsule or mesh"},
    {"two contacts of one name",
     scene_with_section("<contact><ground_contact body=\"b\" name=\"touch\"/>\n<ground_contact "
                        "body=\"d\" name=\"touch\"/></contact>"),
     "bad.xml:3: <ground_contact name=\"touch\">: the contact of line 2 has this name; names of "
     "contacts must differ"},
    {"contact with a missing body",
     scene_with_section(
         "<contact><general_primitive_contact general_body=\"b\" primitive_body=\"x\"/></contact>"),
     "bad.xml:2: <general_primitive_contact primitive_body=\"x\">: no body has this name; did you "
     "mean 'b'?"},
    {"contact with itself",
     scene_with_section(
         "<contact><general_primitive_contact general_body=\"b\" primitive_body=\"b\"/></contact>"),
     "bad.xml:2: <general_primitive_contact primitive_body=\"b\">: a body does not touch itself; "
     "name two bodies"},
    {"cuboid contact of a ball",
     scene_with_section("<contact><cuboid_cuboid_contact body_a=\"b\" body_b=\"d\"/></contact>"),
     "bad.xml:2: <cuboid_cuboid_contact body_a=\"b\">: this body is not a cuboid; both must be"},
    {"sensor on a missing body",
     scene_with_section("<sensor><tactile body=\"x\" type=\"abstract\" spec=\"s.txt\"/></sensor>"),
     "bad.xml:2: <tactile body=\"x\">: no body has this name; did you mean 'b'?"},
    {"two sensors of one name",
     scene_with_section("<sensor><tactile body=\"b\" type=\"abstract\" spec=\"s.txt\"/><tactile "
                        "body=\"b\" type=\"abstract\" spec=\"s.txt\"/></sensor>"),
     "bad.xml:2: <tactile name=\"b\">: the tactile of line 2 has this name; names of tactiles must "
     "differ"},
    {"two links of one name",
     scene_with_section("<robot><link name=\"a\"><joint name=\"x\" type=\"fixed\"/><body "
                        "name=\"x\" type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:4: <link name=\"a\">: the link of line 2 has this name; names of links must differ"},
    {"two joints of one name",
     scene_with_section("<robot><link name=\"x\"><joint name=\"j\" type=\"fixed\"/><body "
                        "name=\"x\" type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:5: <joint name=\"j\">: the joint of line 2 has this name; names of joints must "
     "differ"},
    {"two bodies of one name",
     scene_with_section("<robot><link name=\"x\"><joint name=\"x\" type=\"fixed\"/><body "
                        "name=\"b\" type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:6: <body name=\"b\">: the body of line 2 has this name; names of bodies must differ"},
};

TEST(References, RefusesWithTheWholeMessage) { expect_refused(kRefusedReferences); }

}  // namespace
}  // namespace hbar::scene
