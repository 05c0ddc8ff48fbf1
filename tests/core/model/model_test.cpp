#include "hbar/core/model/model.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using testing::brick;
using testing::message_of;

/// Three links: a hinge, a sliding table below it and a free body beside them; two motors.
ModelBuilder small_builder() {
  ModelBuilder builder("small", Units::kCentimetreGram);
  builder.set_gravity({0.0, 0.0, -980.0});
  builder.add_link(-1, {.name = "hinge", .kind = RevoluteJoint{}}, brick("arm"), "first");
  builder.add_link(0, {.name = "table", .kind = PlanarJoint{}}, brick("plate"), "second");
  builder.add_link(-1, {.name = "float", .kind = Free3dExpJoint{}}, brick("ball"), "third");
  builder.add_motor({.link = 1});
  builder.add_motor({.link = 0, .kind = Motor::Kind::kPosition, .P = 1.0});
  builder.add_end_effector({.name = "tip", .link = 0, .position = {1.0, 0.0, 0.0}});
  return builder;
}

TEST(Model, CountsAndNamesWhatItHolds) {
  const Model model = small_builder().build();
  EXPECT_EQ(model.name(), "small");
  EXPECT_EQ(model.units(), Units::kCentimetreGram);
  EXPECT_EQ(model.gravity(), Eigen::Vector3d(0.0, 0.0, -980.0));
  EXPECT_EQ(model.dof(), 9);
  EXPECT_EQ(model.control_count(), 3);
  EXPECT_EQ(model.variable_count(), 3);
  const std::vector<std::string> coordinates = {"hinge",    "table.d0", "table.d1",
                                                "float.x",  "float.y",  "float.z",
                                                "float.rx", "float.ry", "float.rz"};
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    EXPECT_EQ(model.coordinate_name(static_cast<int>(i)), coordinates[i]);
  }
  const std::vector<std::string> controls = {"table.d0", "table.d1", "hinge"};
  for (std::size_t i = 0; i < controls.size(); ++i) {
    EXPECT_EQ(model.control_name(static_cast<int>(i)), controls[i]);
  }
  EXPECT_EQ(model.first_control(1), 2);
  EXPECT_EQ(model.coordinates_of_link(0), (CoordinateRange{0, 1}));
  EXPECT_EQ(model.coordinates_of_link(1), (CoordinateRange{1, 3}));
  EXPECT_EQ(model.coordinates_of_link(2), (CoordinateRange{3, 9}));
}

TEST(Model, FindsContactsByName) {
  ModelBuilder builder("touching");
  builder.add_link(-1, {.name = "j", .kind = TranslationalJoint{}},
                   solid_body("ball", Sphere{1.0}, 1.0));
  builder.add_contact({.name = "wall", .link = 0, .surface = Plane{}});
  builder.add_contact({.name = "floor", .link = 0, .surface = Plane{}});
  const Model model = builder.build();
  EXPECT_EQ(model.find_contact("floor"), 1);
  EXPECT_EQ(message_of<InvalidInput>([&] { static_cast<void>(model.find_contact("flor")); }),
            "there is no contact 'flor'; did you mean 'floor'?");
}

TEST(Model, FindsByNameAndSuggestsTheNearest) {
  const Model model = small_builder().build();
  EXPECT_EQ(model.find_link("second"), 1);
  EXPECT_EQ(model.find_joint("float"), 2);
  EXPECT_EQ(model.find_body("arm"), 0);
  const auto message = [](const std::function<int()>& find) {
    return message_of<InvalidInput>([&] { static_cast<void>(find()); });
  };
  EXPECT_EQ(message([&] { return model.find_link("secnd"); }),
            "there is no link 'secnd'; did you mean 'second'?");
  EXPECT_EQ(message([&] { return model.find_joint("knuckle"); }),
            "there is no joint 'knuckle'; known: hinge, table, float");
  EXPECT_EQ(message([&] { return model.find_body("bal"); }),
            "there is no body 'bal'; did you mean 'ball'?");
  EXPECT_EQ(message_of<InvalidInput>([] {
              ModelBuilder builder("none");
              builder.add_link(-1, {.name = "j"}, brick("b"));
              static_cast<void>(builder.build().control_name(0));
            }),
            "there is no control 0; the model has 0");
}

TEST(Model, IsEqualToItsCopyAndToNoneThatDiffers) {
  const Model model = small_builder().build();
  EXPECT_TRUE(model == small_builder().build());
  const std::vector<std::function<void(ModelBuilder&)>> changes = {
      [](ModelBuilder& b) {
        b.set_gravity({0.0, 0.0, -981.0});
      },
      [](ModelBuilder& b) { b.add_link(2, {.name = "more"}, brick("more")); },
      [](ModelBuilder& b) { b.add_motor({.link = 2}); },
      [](ModelBuilder& b) { b.add_end_effector({.name = "", .link = 1}); },
  };
  for (const auto& change : changes) {
    ModelBuilder builder = small_builder();
    change(builder);
    EXPECT_FALSE(model == builder.build());
  }
  EXPECT_FALSE(testing::random_model(1) == testing::random_model(2));
  EXPECT_TRUE(testing::random_model(1) == testing::random_model(1));
}

TEST(Model, ComparesEveryFieldOfItsParts) {
  const Body body = brick("b");
  const auto differs = [](auto original, const auto& change) {
    auto other = original;
    change(other);
    return !(original == other) && original == original;
  };
  EXPECT_TRUE(differs(body, [](Body& b) { b.name = "c"; }));
  EXPECT_TRUE(differs(body, [](Body& b) { b.X_JB.p.y() = 1.0; }));
  EXPECT_TRUE(differs(body, [](Body& b) { b.mass = 1.0; }));
  EXPECT_TRUE(differs(body, [](Body& b) { b.inertia.z() = 1.0; }));
  EXPECT_TRUE(differs(body, [](Body& b) { b.shape = Sphere{1.0}; }));
  EXPECT_TRUE(differs(body, [](Body& b) { b.shape = Cuboid{{1.0, 2.0, 4.0}}; }));
  const EndEffector point{.name = "p", .link = 0, .position = {1.0, 2.0, 3.0}};
  EXPECT_TRUE(differs(point, [](EndEffector& p) { p.name = "q"; }));
  EXPECT_TRUE(differs(point, [](EndEffector& p) { p.link = 1; }));
  EXPECT_TRUE(differs(point, [](EndEffector& p) { p.position.z() = 0.0; }));
  const Motor motor{.link = 0};
  EXPECT_TRUE(differs(motor, [](Motor& m) { m.implicit = true; }));
  EXPECT_TRUE(differs(motor, [](Motor& m) { m.lower = 0.0; }));
  const Link link{.name = "l", .parent = -1, .joint = {.name = "j"}, .body = body};
  EXPECT_TRUE(differs(link, [](Link& l) { l.design_mask = 1; }));
  EXPECT_TRUE(differs(link, [](Link& l) { l.parent = 0; }));
  EXPECT_TRUE(differs(link, [](Link& l) { l.joint.damping = 1.0; }));
}

TEST(UnitNames, AreThoseOfTheUnitSystem) {
  EXPECT_EQ(length_unit(Units::kCentimetreGram), "cm");
  EXPECT_EQ(mass_unit(Units::kCentimetreGram), "g");
  EXPECT_EQ(length_unit(Units::kMetreKilogram), "m");
  EXPECT_EQ(mass_unit(Units::kMetreKilogram), "kg");
}

}  // namespace
}  // namespace hbar
