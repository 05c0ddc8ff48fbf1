#include "hbar/core/scene/build_contacts.h"

#include <filesystem>
#include <fstream>

#include "hbar/core/scene/build_model.h"
#include "tests/core/scene/build_refusal.h"
#include "tests/core/scene/scene_testing.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

/// A scene of bodies d and e (cuboids), b (a ball), m (a mesh) and p (a point file), with one more
/// section in line 2.
std::string scene_text(const std::string& section) {
  const auto link = [](const std::string& name, const std::string& body) {
    return "<link name=\"" + name + "\"><joint type=\"free3d-exp\"/><body " + body + "/></link>\n";
  };
  return "<redmax>\n" + section + "\n<robot>\n" + link("d", "type=\"cuboid\" size=\"1 1 1\"") +
         link("e", "type=\"cuboid\" size=\"2 2 2\"") + link("b", "type=\"sphere\" radius=\"1\"") +
         link("m", "type=\"mesh\" filename=\"wedge.obj\" distance_cells=\"8\"") +
         link("p", "type=\"abstract\" mass=\"1\" inertia=\"1 1 1\" contacts=\"none.txt\"") +
         "</robot>\n</redmax>\n";
}

/// A folder for what a mesh leaves behind.
class Contacts : public ::testing::Test {
 protected:
  Contacts() {
    std::filesystem::copy_file(HBAR_SOURCE_DIR "/tests/golden/scenes/wedge.obj",
                               folder_ / "wedge.obj",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder_ / "none.txt") << "0\n";
  }

  [[nodiscard]] Scene scene(const std::string& section) const {
    return read_scene_text(scene_text(section), "a.xml", folder_.path());
  }
  [[nodiscard]] std::vector<hbar::Contact> contacts(const std::string& section) const {
    return build_model(scene(section)).contacts();
  }

  TemporaryFolder folder_;
};

TEST_F(Contacts, WithTheGroundTouchItsPlane) {
  const auto made = contacts(
      "<ground pos=\"1 2 3\" normal=\"0 3 4\"/><contact><ground_contact body=\"e\" kn=\"1\" "
      "kt=\"2\" "
      "mu=\"3\" damping=\"4\" law=\"linear\"/></contact>");
  hbar::Contact expected;
  expected.name = "e-ground";
  expected.link = 1;
  expected.other = -1;
  expected.surface = Plane{{1.0, 2.0, 3.0}, {0.0, 0.6, 0.8}};
  expected.coefficients = {1.0, 2.0, 3.0, 4.0};
  expected.normal_law = NormalLaw::kLinear;
  EXPECT_EQ(made, std::vector<hbar::Contact>{expected});
}

TEST_F(Contacts, WithNoGroundTouchThePlaneOfZero) {
  const auto made = contacts("<contact><ground_contact body=\"b\"/></contact>");
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].surface, ContactSurface(Plane{}));
}

TEST_F(Contacts, OfTwoBodiesSayAllTheyHave) {
  const auto made = contacts(
      "<contact><general_primitive_contact general_body=\"d\" primitive_body=\"b\" name=\"touch\" "
      "friction=\"smooth\" friction_width=\"0.5\" adhesion=\"false\" reaction=\"surface\" "
      "caps=\"false\" kn=\"5\"/><general_primitive_contact general_body=\"m\" "
      "primitive_body=\"e\"/></contact>");
  hbar::Contact touch;
  touch.name = "touch";
  touch.link = 0;
  touch.other = 2;
  touch.surface = OwnShape{false};
  touch.coefficients.kn = 5.0;
  touch.friction_law = FrictionLaw::kSmooth;
  touch.friction_width = 0.5;
  touch.adhesion = false;
  touch.reaction = hbar::Reaction::kSurface;
  hbar::Contact plain;
  plain.name = "m-e";
  plain.link = 3;
  plain.other = 1;
  plain.surface = OwnShape{true};
  EXPECT_EQ(made, (std::vector<hbar::Contact>{touch, plain}));
}

TEST_F(Contacts, OfTwoCuboidsAreTwo) {
  const auto made = contacts(
      "<contact><cuboid_cuboid_contact body_a=\"e\" body_b=\"d\" kn=\"5\" name=\"stack\"/>"
      "<cuboid_cuboid_contact body_a=\"d\" body_b=\"e\"/></contact>");
  ASSERT_EQ(made.size(), 4U);
  EXPECT_EQ(made[0].name, "stack-a");
  EXPECT_EQ(made[0].link, 1);
  EXPECT_EQ(made[0].other, 0);
  hbar::Contact other = made[0];
  other.name = "stack-b";
  std::swap(other.link, other.other);
  EXPECT_EQ(made[1], other);
  EXPECT_EQ(made[2].name, "d-e");
  EXPECT_EQ(made[3].name, "e-d");
}

TEST_F(Contacts, WithAMeshShareItsDistance) {
  const auto made = contacts(
      "<contact><general_primitive_contact general_body=\"d\" primitive_body=\"m\"/>"
      "<general_primitive_contact general_body=\"e\" primitive_body=\"m\"/></contact>");
  ASSERT_EQ(made.size(), 2U);
  EXPECT_EQ(made[0].surface, made[1].surface);
  const auto field = std::get<std::shared_ptr<const DistanceField>>(made[0].surface);
  EXPECT_LT(field->sample(Eigen::Vector3d::Zero()).distance, 0.0) << "the centre of mass is inside";
  EXPECT_GT(field->sample(Eigen::Vector3d::Constant(0.2)).distance, 0.1);
}

TEST_F(Contacts, WithAMeshThatIsLoadedTwiceAreTheSame) {
  const auto made = [this](const std::string& body) {
    return contacts("<contact><general_primitive_contact general_body=\"" + body +
                    "\" primitive_body=\"m\"/></contact>")[0];
  };
  const hbar::Contact once = made("d");
  const hbar::Contact again = made("d");
  EXPECT_NE(std::get<std::shared_ptr<const DistanceField>>(once.surface),
            std::get<std::shared_ptr<const DistanceField>>(again.surface));
  EXPECT_EQ(once, again);
  EXPECT_FALSE(once == made("e"));
}

TEST_F(Contacts, SayWhereTheModelRefusesThem) {
  EXPECT_EQ(refusal(scene("<contact><ground_contact body=\"p\"/></contact>")),
            "a.xml:2: <ground_contact>: contact 'p-ground': body 'p' has no contact points (see "
            "surface_points; a ball needs none but against a distance field)");
  EXPECT_EQ(refusal(scene("<contact><ground_contact body=\"d\"/>\n<ground_contact body=\"e\" "
                          "name=\"d-ground\"/></contact>")),
            "a.xml:3: <ground_contact name=\"d-ground\">: contact 'd-ground': this name is taken");
  Scene unread = scene("<contact><ground_contact body=\"d\"/></contact>");
  unread.description.contacts[0].body_a = "x";
  EXPECT_EQ(refusal(unread), "a.xml:2: <ground_contact>: no body is named 'x'");
}

}  // namespace
}  // namespace hbar::scene
