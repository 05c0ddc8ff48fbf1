#include <algorithm>

#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

using Notices = std::vector<std::string>;

Notices notices_of(const std::string& text) { return read_scene_text(text, "a.xml").notices; }

TEST(NoticeEffects, LimitsWithoutStiffness) {
  EXPECT_EQ(
      notices_of("<redmax>\n<robot><link>\n<joint name=\"j\" type=\"revolute\" axis=\"0 0 1\" "
                 "lim=\"-1 1\"/>" +
                 kBall +
                 "<link>\n<joint name=\"k\" type=\"revolute\" axis=\"0 0 1\" lim=\"-2 1\"/>" +
                 kBall + "</link></link></robot></redmax>"),
      Notices{"a.xml:3: <joint>: lim has no effect on the motion without lim_stiffness, which "
              "is 0; it bounds optimisations alone (j, k)"});
  EXPECT_EQ(notices_of(scene_with_joint(
                "<joint type=\"revolute\" axis=\"0 0 1\" lim=\"-1 1\" lim_stiffness=\"9\"/>")),
            Notices());
}

TEST(NoticeEffects, ContactsWithoutStiffnessAndFrictionWithoutSlope) {
  const auto contact = [](const std::string& coefficients) {
    return notices_of(
        scene_with_section("<ground/><contact>\n<ground_contact body=\"b\" name=\"c\" " +
                           coefficients + "/></contact>"));
  };
  EXPECT_EQ(contact("mu=\"0.5\""),
            Notices{"a.xml:3: <ground_contact>: kn is 0, so nothing is held apart (c)"});
  EXPECT_EQ(contact("kn=\"9\" mu=\"0.5\""),
            Notices{"a.xml:3: <ground_contact>: mu has no effect without kt, which is 0 (c)"});
  EXPECT_EQ(contact("kn=\"9\" mu=\"0.5\" kt=\"1\""), Notices());
  EXPECT_EQ(contact("kn=\"9\" mu=\"0.5\" friction=\"smooth\" friction_width=\"0.1\""), Notices());
  EXPECT_EQ(contact("kn=\"9\""), Notices());
}

TEST(NoticeEffects, SensorsThatReadNothing) {
  EXPECT_EQ(
      notices_of(scene_with_section(
          "<sensor>\n<tactile body=\"b\" name=\"s\" type=\"abstract\" spec=\"s.txt\"/></sensor>")),
      Notices{"a.xml:3: <tactile>: kn is 0, so its readings are 0 (s)"});
}

TEST(NoticeEffects, DefaultDampingOfFreeBodies) {
  const auto scene = [](const std::string& joint) {
    return "<redmax>\n<default><joint damping=\"2\"/></default>\n<robot><link name=\"l\">\n" +
           joint + kBall + "</link></robot></redmax>";
  };
  EXPECT_EQ(notices_of(scene("<joint name=\"f\" type=\"free3d-exp\"/>")),
            Notices{"a.xml:4: <joint name=\"f\">: the default damping 2 slows this free body, too; "
                    "damping=\"0\" leaves it free"});
  EXPECT_EQ(notices_of(scene("<joint type=\"free3d-exp\" damping=\"0\"/>")), Notices());
  EXPECT_EQ(notices_of(scene("<joint type=\"free3d-exp\" damping=\"3\"/>")), Notices());
  EXPECT_EQ(notices_of(scene("<joint type=\"revolute\" axis=\"0 0 1\"/>")), Notices());
}

TEST(NoticeEffects, RoundedMomentsOfAFlatBody) {
  EXPECT_EQ(notices_of(scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"0.08333333 "
                                       "0.08333333 0.16666667\"/>")),
            Notices{"a.xml:5: <body>: inertia: one moment is above the sum of the other two, by "
                    "6e-08 of it: taken as rounded"});
  EXPECT_EQ(notices_of(scene_with_body("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 2\"/>")),
            Notices());
}

}  // namespace
}  // namespace hbar::scene
