#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

Description section(const std::string& text) {
  return read_scene_text(scene_with_section(text), "a.xml").description;
}

TEST(Sections, ReadOptions) {
  const Description d = section(
      "<option integrator=\"SDIRK2\" timestep=\"0.01\" gravity=\"1 2 3\" unit=\"m-kg\"/>"
      "<solver_option tol=\"1e-6\" rtol=\"1e-7\" max_iter=\"7\" max_ls=\"8\" "
      "linear_solver=\"spqr\"/>"
      "<ground pos=\"0 0 1\" normal=\"0 1 0\"/>");
  EXPECT_EQ(d.options, (Options{Integrator::kSdirk2, 0.01, {1.0, 2.0, 3.0}, UnitSystem::kMKg}));
  EXPECT_EQ(d.solver_options, (SolverOptions{1e-6, 1e-7, 7, 8, "spqr"}));
  EXPECT_EQ(d.ground, (Ground{{0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {}}));
}

TEST(Sections, ReadMotorsInOrder) {
  const Description d = section(
      "<actuator><motor joint=\"j\" ctrl=\"position\" ctrl_range=\"-1 2\" P=\"3\" D=\"4\" "
      "implicit=\"true\"/></actuator>");
  EXPECT_EQ(d.motors.at(0), (Motor{"j", Control::kPosition, Vec2{-1.0, 2.0}, 3.0, 4.0, true, {}}));
}

TEST(Sections, ReadContacts) {
  const Description d = section(
      "<contact><ground_contact body=\"b\" kn=\"1\" kt=\"2\" mu=\"3\" damping=\"4\" "
      "law=\"linear\"/>"
      "<general_primitive_contact general_body=\"d\" primitive_body=\"b\" reaction=\"surface\" "
      "caps=\"false\" render=\"true\" friction=\"smooth\" friction_width=\"0.5\" "
      "adhesion=\"false\" name=\"touch\"/>"
      "<cuboid_cuboid_contact body_a=\"d\" body_b=\"e\"/></contact><robot><link name=\"e\">"
      "<joint type=\"fixed\"/><body type=\"cuboid\" size=\"1 1 1\"/></link></robot>");
  Contact ground{ContactKind::kGround, {}, "b", "", 1.0, 2.0, 3.0, 4.0};
  ground.law = ContactLaw::kLinear;
  Contact general{ContactKind::kGeneralPrimitive, "touch", "d", "b"};
  general.render = true;
  general.friction = Friction::kSmooth;
  general.friction_width = 0.5;
  general.adhesion = false;
  general.reaction = Reaction::kSurface;
  general.caps = false;
  const Contact cuboids{ContactKind::kCuboidCuboid, {}, "d", "e"};
  EXPECT_EQ(d.contacts, (std::vector<Contact>{ground, general, cuboids}));
}

TEST(Sections, ReadVariablesSensorsAndVirtualShapes) {
  const Description d = section(
      "<variable><endeffector joint=\"j\" pos=\"1 2 3\" radius=\"4\" name=\"tip\" "
      "rgba=\"1 0 0 1\"/></variable>"
      "<sensor><tactile body=\"b\" name=\"pad\" type=\"rect_array\" rect_pos0=\"0 0 0\" "
      "rect_pos1=\"1 2 0\" axis0=\"1 0 0\" axis1=\"0 1 0\" resolution=\"3 4\" kn=\"5\" kt=\"6\" "
      "mu=\"7\" damping=\"8\" render=\"false\"/>"
      "<tactile body=\"d\" type=\"abstract\" spec=\"s.txt\" pos=\"1 0 0\" quat=\"0 2 0 "
      "0\"/></sensor>"
      "<virtual><sphere name=\"goal\" pos=\"1 1 1\" radius=\"2\" rgba=\"0 1 0 1\"/>"
      "<cuboid size=\"1 2 3\" quat=\"0 0 0 3\"/></virtual>");
  EXPECT_EQ(d.end_effectors.at(0),
            (EndEffector{"j", {1.0, 2.0, 3.0}, 4.0, "tip", Vec4{1.0, 0.0, 0.0, 1.0}, {}}));
  EXPECT_EQ(d.tactile_sensors.at(0),
            (TactileSensor{"b",
                           "pad",
                           RectArray{{}, {1.0, 2.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {3, 4}},
                           5.0,
                           6.0,
                           7.0,
                           8.0,
                           false,
                           {}}));
  EXPECT_EQ(d.tactile_sensors.at(1).name, "d");
  EXPECT_EQ(std::get<PointList>(d.tactile_sensors.at(1).points),
            (PointList{"s.txt", {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}));
  EXPECT_EQ(d.virtual_shapes.at(0),
            (VirtualShape{"goal", VirtualSphere{2.0}, {1.0, 1.0, 1.0}, Vec4{0.0, 1.0, 0.0, 1.0}}));
  EXPECT_EQ(d.virtual_shapes.at(1),
            (VirtualShape{{}, VirtualCuboid{{1.0, 2.0, 3.0}, {0.0, 0.0, 0.0, 1.0}}, {}, {}}));
}

TEST(Sections, NoticeAWidthThatHasNoEffect) {
  const Scene scene = read_scene_text(
      scene_with_section(
          "<ground/><contact><ground_contact body=\"b\" kn=\"1\" friction_width=\"1\"/>"
          "</contact>"),
      "a.xml");
  EXPECT_EQ(scene.description.contacts.at(0).friction_width, std::nullopt);
  EXPECT_EQ(scene.notices,
            std::vector<std::string>{"a.xml:2: <ground_contact friction=\"document\">: "
                                     "friction_width has no effect on this friction"});
}

TEST(Sections, NoticeGravityOfTheOtherUnits) {
  EXPECT_EQ(read_scene_text(scene_with_section("<option unit=\"m-kg\"/>"), "a.xml").notices,
            std::vector<std::string>{"a.xml:2: <option unit=\"m-kg\">: gravity is not given, so it "
                                     "is 0 0 -980 metres per second squared"});
}

const std::vector<BadScene> kRefusedSections = {
    {"runge-kutta", scene_with_section("<option integrator=\"rk4\"/>"),
     "bad.xml:2: <option integrator=\"rk4\">: explicit integrators are not supported; integrator "
     "takes one of BDF1, BDF2, SDIRK2"},
    {"euler", scene_with_section("<option integrator=\"euler\"/>"),
     "bad.xml:2: <option integrator=\"euler\">: explicit integrators are not supported; integrator "
     "takes one of BDF1, BDF2, SDIRK2"},
    {"unknown integrator", scene_with_section("<option integrator=\"BDF7\"/>"),
     "bad.xml:2: <option integrator=\"BDF7\">: unknown integrator; integrator takes one of BDF1, "
     "BDF2, SDIRK2"},
    {"unknown linear solver", scene_with_section("<solver_option linear_solver=\"kul\"/>"),
     "bad.xml:2: <solver_option linear_solver=\"kul\">: unknown linear_solver; linear_solver takes "
     "one of "
     "sweep, auto, block_substitution, block_banded, lapack_band, klu, umfpack, eigen_sparse_lu, "
     "mumps, cholmod_normal, spqr"},
    {"no tolerance", scene_with_section("<solver_option tol=\"0\"/>"),
     "bad.xml:2: <solver_option tol=\"0\">: out of range; tol takes 1 number > 0"},
    {"ground without a normal", scene_with_section("<ground normal=\"0 0 0\"/>"),
     "bad.xml:2: <ground normal=\"0 0 0\">: all numbers are 0; normal takes 3 numbers, not all 0"},
    {"unknown control",
     scene_with_section("<actuator><motor joint=\"j\" ctrl=\"velocity\"/></actuator>"),
     "bad.xml:2: <motor ctrl=\"velocity\">: unknown ctrl; ctrl takes one of force, position"},
    {"range reversed",
     scene_with_section("<actuator><motor joint=\"j\" ctrl_range=\"1 -1\"/></actuator>"),
     "bad.xml:2: <motor ctrl_range=\"1 -1\">: the lower number is above the upper one; ctrl_range "
     "takes 2 numbers, lower <= upper"},
    {"position motor without P",
     scene_with_section("<actuator><motor joint=\"j\" ctrl=\"position\"/></actuator>"),
     "bad.xml:2: <motor>: attribute P is missing; P takes 1 number >= 0"},
    {"negative P",
     scene_with_section("<actuator><motor joint=\"j\" ctrl=\"position\" P=\"-1\"/></actuator>"),
     "bad.xml:2: <motor P=\"-1\">: out of range; P takes 1 number >= 0"},
    {"negative contact stiffness",
     scene_with_section("<contact><ground_contact body=\"b\" kn=\"-1\"/></contact>"),
     "bad.xml:2: <ground_contact kn=\"-1\">: out of range; kn takes 1 number >= 0"},
    {"unknown law",
     scene_with_section("<contact><ground_contact body=\"b\" law=\"cubic\"/></contact>"),
     "bad.xml:2: <ground_contact law=\"cubic\">: unknown law; law takes one of document, linear"},
    {"unknown friction",
     scene_with_section("<contact><ground_contact body=\"b\" friction=\"coulomb\"/></contact>"),
     "bad.xml:2: <ground_contact friction=\"coulomb\">: unknown friction; friction takes one of "
     "document, smooth"},
    {"smooth friction without a width",
     scene_with_section("<contact><ground_contact body=\"b\" friction=\"smooth\"/></contact>"),
     "bad.xml:2: <ground_contact>: attribute friction_width is missing; friction_width takes 1 "
     "number > 0"},
    {"smooth friction of no width",
     scene_with_section("<contact><ground_contact body=\"b\" friction=\"smooth\" "
                        "friction_width=\"0\"/></contact>"),
     "bad.xml:2: <ground_contact friction_width=\"0\">: out of range; friction_width takes 1 "
     "number > 0"},
    {"adhesion in between",
     scene_with_section("<contact><ground_contact body=\"b\" adhesion=\"some\"/></contact>"),
     "bad.xml:2: <ground_contact adhesion=\"some\">: \"some\" is neither; adhesion takes true or "
     "false"},
    {"end effector without a joint",
     scene_with_section("<variable><endeffector pos=\"0 0 0\"/></variable>"),
     "bad.xml:2: <endeffector>: attribute joint is missing; joint takes a text that is not empty"},
    {"end effector of no size",
     scene_with_section("<variable><endeffector joint=\"j\" radius=\"0\"/></variable>"),
     "bad.xml:2: <endeffector radius=\"0\">: out of range; radius takes 1 number > 0"},
    {"sensor with parallel axes",
     scene_with_section(
         "<sensor><tactile body=\"b\" type=\"rect_array\" rect_pos0=\"0 0 0\" rect_pos1=\"1 1 0\" "
         "axis0=\"1 0 0\" axis1=\"1 0 0\" resolution=\"2 2\"/></sensor>"),
     "bad.xml:2: <tactile axis1=\"1 0 0\">: parallel to axis0; the two axes must not be parallel"},
    {"sensor of too many points",
     scene_with_section(
         "<sensor><tactile body=\"b\" type=\"rect_array\" rect_pos0=\"0 0 0\" rect_pos1=\"1 1 0\" "
         "axis0=\"1 0 0\" axis1=\"0 1 0\" resolution=\"2000 1000\"/></sensor>"),
     "bad.xml:2: <tactile resolution=\"2000 1000\">: that makes 2e+06 points; a sensor has at most "
     "1000000"},
    {"sensor whose axes do not reach",
     scene_with_section(
         "<sensor><tactile body=\"b\" type=\"rect_array\" rect_pos0=\"0 0 0\" rect_pos1=\"1 1 1\" "
         "axis0=\"1 0 0\" axis1=\"0 1 0\" resolution=\"2 2\"/></sensor>"),
     "bad.xml:2: <tactile rect_pos1=\"1 1 1\">: the axes do not reach from rect_pos0 to here; "
     "rect_pos1 - rect_pos0 is a combination of axis0 and axis1"},
    {"sensor without points",
     scene_with_section("<sensor><tactile body=\"b\" type=\"abstract\"/></sensor>"),
     "bad.xml:2: <tactile>: attribute spec is missing; spec takes a text that is not empty"},
    {"virtual ball of no size", scene_with_section("<virtual><sphere radius=\"0\"/></virtual>"),
     "bad.xml:2: <sphere radius=\"0\">: out of range; radius takes 1 number > 0"},
};

TEST(Sections, RefusesWithTheWholeMessage) { expect_refused(kRefusedSections); }

}  // namespace
}  // namespace hbar::scene
