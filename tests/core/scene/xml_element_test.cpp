#include "hbar/core/scene/xml_element.h"

#include <tinyxml2.h>

#include <cmath>

#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

TEST(XmlElement, ReadsFromElementThenDefaultThenTable) {
  tinyxml2::XMLDocument document;
  document.Parse("<joint type=\"revolute\" damping=\"2\"/>");
  ReadContext context;
  context.defaults["joint"]["damping"] = {"3", 1, true};
  context.defaults["joint"]["stiffness"] = {"4", 1, true};
  XmlElement joint(*document.RootElement(), context);
  EXPECT_EQ(joint.read_type("type"), 1U);
  EXPECT_EQ(joint.number("damping"), 2.0);
  EXPECT_EQ(joint.number("stiffness"), 4.0);
  EXPECT_EQ(joint.number("lim_stiffness"), 0.0);
  EXPECT_TRUE(joint.states("damping"));
  EXPECT_FALSE(joint.states("stiffness"));
  EXPECT_TRUE(joint.has("stiffness"));
  EXPECT_FALSE(joint.has("lim"));
  EXPECT_EQ(joint.optional_numbers<2>("lim"), std::nullopt);
  EXPECT_FALSE(joint.applies("axis0"));
}

TEST(XmlElement, NormalisesQuaternionsOnce) {
  tinyxml2::XMLDocument document;
  document.Parse("<joint type=\"fixed\" quat=\"1e200 -1e200 0 0\"/>");
  ReadContext context;
  const std::array<double, 4> q = XmlElement(*document.RootElement(), context).quaternion("quat");
  EXPECT_NEAR(q[0], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(q[1], -std::sqrt(0.5), 1e-15);
}

TEST(XmlElement, NoticesTheSameOnce) {
  ReadContext context{"a.xml", {}, {}};
  context.notice(3, "odd");
  context.notice(4, "odd");
  context.notice(4, "even");
  EXPECT_EQ(context.notices, (std::vector<std::string>{"a.xml:3: odd", "a.xml:4: even"}));
}

TEST(XmlElement, NoticesWhatHasNoEffect) {
  const Scene scene = read_scene_text(
      scene_with_joint("<joint type=\"fixed\" axis=\"0 0 0\" format=\"LOCAL\"/>"), "a.xml");
  EXPECT_EQ(scene.notices,
            (std::vector<std::string>{
                "a.xml:4: <joint>: format has no effect",
                "a.xml:4: <joint type=\"fixed\">: axis has no effect on this type"}));
}

const std::vector<BadScene> kRefusedElements = {
    {"trailing letter", scene_with_section("<option timestep=\"1.5x\"/>"),
     "bad.xml:2: <option timestep=\"1.5x\">: \"1.5x\" is not a finite number; timestep takes 1 "
     "number > 0"},
    {"decimal comma", scene_with_section("<option timestep=\"1,5\"/>"),
     "bad.xml:2: <option timestep=\"1,5\">: \"1,5\" is not a finite number (decimals take a point, "
     "entries are separated by blanks); timestep takes 1 number > 0"},
    {"not a number", scene_with_section("<option timestep=\"nan\"/>"),
     "bad.xml:2: <option timestep=\"nan\">: \"nan\" is not a finite number; timestep takes 1 "
     "number > 0"},
    {"infinity", scene_with_section("<option timestep=\"inf\"/>"),
     "bad.xml:2: <option timestep=\"inf\">: \"inf\" is not a finite number; timestep takes 1 "
     "number > 0"},
    {"too large", scene_with_section("<option timestep=\"1e999\"/>"),
     "bad.xml:2: <option timestep=\"1e999\">: \"1e999\" is too large or too small; timestep takes "
     "1 number > 0"},
    {"too small", scene_with_section("<option timestep=\"1e-999\"/>"),
     "bad.xml:2: <option timestep=\"1e-999\">: \"1e-999\" is too large or too small; timestep "
     "takes 1 number > 0"},
    {"empty", scene_with_section("<option timestep=\"\"/>"),
     "bad.xml:2: <option timestep=\"\">: found 0 numbers; timestep takes 1 number > 0"},
    {"blank", scene_with_section("<option timestep=\" \"/>"),
     "bad.xml:2: <option timestep=\" \">: found 0 numbers; timestep takes 1 number > 0"},
    {"hexadecimal", scene_with_section("<option timestep=\"0x10\"/>"),
     "bad.xml:2: <option timestep=\"0x10\">: \"0x10\" is not a finite number; timestep takes 1 "
     "number > 0"},
    {"two numbers", scene_with_section("<option timestep=\"1 2\"/>"),
     "bad.xml:2: <option timestep=\"1 2\">: found 2 numbers; timestep takes 1 number > 0"},
    {"double sign", scene_with_section("<option timestep=\"+-1\"/>"),
     "bad.xml:2: <option timestep=\"+-1\">: \"+-1\" is not a finite number; timestep takes 1 "
     "number > 0"},
    {"word", scene_with_section("<option timestep=\"fast\"/>"),
     "bad.xml:2: <option timestep=\"fast\">: \"fast\" is not a finite number; timestep takes 1 "
     "number > 0"},
    {"zero", scene_with_section("<option timestep=\"0\"/>"),
     "bad.xml:2: <option timestep=\"0\">: out of range; timestep takes 1 number > 0"},
    {"negative", scene_with_section("<option timestep=\"-0.01\"/>"),
     "bad.xml:2: <option timestep=\"-0.01\">: out of range; timestep takes 1 number > 0"},
    {"too few entries", scene_with_section("<option gravity=\"0 0\"/>"),
     "bad.xml:2: <option gravity=\"0 0\">: found 2 numbers; gravity takes 3 numbers"},
    {"too many entries", scene_with_section("<option gravity=\"0 0 -9.81 0\"/>"),
     "bad.xml:2: <option gravity=\"0 0 -9.81 0\">: found 4 numbers; gravity takes 3 numbers"},
    {"comma separated", scene_with_section("<option gravity=\"0,0,-9.81\"/>"),
     "bad.xml:2: <option gravity=\"0,0,-9.81\">: \"0,0,-9.81\" is not a finite number (decimals "
     "take a point, entries are separated by blanks); gravity takes 3 numbers"},
    {"not a whole number", scene_with_section("<solver_option max_iter=\"2.5\"/>"),
     "bad.xml:2: <solver_option max_iter=\"2.5\">: \"2.5\" is not a whole number; max_iter takes 1 "
     "whole number from 1 to 1000000"},
    {"overflowing count", scene_with_section("<solver_option max_iter=\"99999999999\"/>"),
     "bad.xml:2: <solver_option max_iter=\"99999999999\">: \"99999999999\" is too large or too "
     "small; max_iter takes 1 whole number from 1 to 1000000"},
    {"no iteration", scene_with_section("<solver_option max_iter=\"0\"/>"),
     "bad.xml:2: <solver_option max_iter=\"0\">: out of range; max_iter takes 1 whole number from "
     "1 to 1000000"},
    {"unknown choice", scene_with_section("<option unit=\"inch\"/>"),
     "bad.xml:2: <option unit=\"inch\">: unknown unit; unit takes one of cm-g, m-kg"},
    {"not a flag",
     scene_with_section("<contact><ground_contact body=\"b\" render=\"yes\"/></contact>"),
     "bad.xml:2: <ground_contact render=\"yes\">: \"yes\" is neither; render takes true or false"},
    {"empty text", scene_with_section("<virtual><sphere name=\"\" radius=\"1\"/></virtual>"),
     "bad.xml:2: <sphere name=\"\">: the text is empty; name takes a text that is not empty"},
    {"near attribute", scene_with_section("<option timstep=\"0.01\"/>"),
     "bad.xml:2: <option timstep=\"0.01\">: unknown attribute; did you mean 'timestep'?"},
    {"far attribute", scene_with_section("<option colour_of_the_sky=\"blue\"/>"),
     "bad.xml:2: <option colour_of_the_sky=\"blue\">: unknown attribute; known: integrator, "
     "timestep, gravity, unit"},
    {"attribute where none is taken", scene_with_section("<actuator name=\"all\"/>"),
     "bad.xml:2: <actuator name=\"all\">: unknown attribute; <actuator> takes no attributes"},
    {"missing attribute", scene_with_section("<actuator><motor/></actuator>"),
     "bad.xml:2: <motor>: attribute joint is missing; joint takes a text that is not empty"},
    {"zero quaternion", scene_with_joint("<joint type=\"fixed\" quat=\"0 0 0 0\"/>"),
     "bad.xml:4: <joint quat=\"0 0 0 0\">: all numbers are 0; quat takes 4 numbers, not all 0"},
    {"mask too large",
     scene_with_section("<robot><link name=\"z\" design_params=\"64\"><joint type=\"fixed\"/><body "
                        "type=\"sphere\" radius=\"1\"/></link></robot>"),
     "bad.xml:2: <link design_params=\"64\">: out of range; design_params takes 1 whole number "
     "from 0 to 63"},
    {"bad number in a default", scene_with_section("<default><joint damping=\"much\"/></default>"),
     "bad.xml:2: <joint damping=\"much\">: \"much\" is not a finite number; damping takes 1 number "
     ">= 0"},
    {"bad choice in a default", scene_with_section("<default><body type=\"cube\"/></default>"),
     "bad.xml:2: <body type=\"cube\">: unknown type; type takes one of cuboid, sphere, cylinder, "
     "capsule, mesh, abstract"},
    {"default used where it does not fit",
     scene_with_section("<default><body general_contact_resolution=\"3 2\"/></default>"),
     "bad.xml:2: <body general_contact_resolution=\"3 2\">: found 2 numbers; "
     "general_contact_resolution takes 3 whole numbers >= 2"},
    {"long and unprintable text",
     scene_with_section(
         "<option "
         "timestep=\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx&#7;\"/"
         ">"),
     "bad.xml:2: <option "
     "timestep=\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...\">: "
     "\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...\" is not a finite number; "
     "timestep takes 1 number > 0"},
};

TEST(XmlElement, RefusesWithTheWholeMessage) { expect_refused(kRefusedElements); }

}  // namespace
}  // namespace hbar::scene
