#include <gtest/gtest.h>

#include <algorithm>

#include "hbar/core/scene/vocabulary_table.h"
#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

const Link& link_of(const Scene& scene) { return scene.description.robots.at(0).links.at(0); }

TEST(JointAttributes, DefaultToThoseOfTheStruct) {
  const Scene scene = read_scene_text(scene_with_joint("<joint type=\"fixed\"/>"), "a.xml");
  Joint joint;
  joint.name = "a";
  EXPECT_EQ(link_of(scene).joint, joint);
  EXPECT_EQ(joint_attributes().size(), find_element("joint")->attributes.size());
}

TEST(BodyAttributes, DefaultToThoseOfTheStructs) {
  const auto read = [](const std::string& body) {
    return link_of(read_scene_text(scene_with_body(body), "a.xml")).body.shape;
  };
  EXPECT_EQ(read("<body type=\"cuboid\" size=\"1 1 1\"/>"), BodyShape(CuboidBody()));
  EXPECT_EQ(read("<body type=\"sphere\" radius=\"1\"/>"), BodyShape(SphereBody()));
  EXPECT_EQ(read("<body type=\"cylinder\" radius=\"1\" length=\"1\"/>"), BodyShape(CylinderBody()));
  EXPECT_EQ(read("<body type=\"capsule\" radius=\"1\" length=\"1\"/>"), BodyShape(CapsuleBody()));
  MeshBody mesh;
  mesh.filename = "m.obj";
  EXPECT_EQ(read("<body type=\"mesh\" filename=\"m.obj\"/>"), BodyShape(mesh));
  EXPECT_EQ(read("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1\"/>"),
            BodyShape(AbstractBody()));
}

TEST(EveryBodyType, HasItsShapeInTheSameOrder) {
  const auto rows = body_attributes();
  const auto type = std::find_if(rows.begin(), rows.end(),
                                 [](const AttributeInfo& row) { return row.name == "type"; });
  ASSERT_NE(type, rows.end());
  EXPECT_EQ(listed(type->choices, '|').size(), std::variant_size_v<BodyShape>);
}

}  // namespace
}  // namespace hbar::scene
