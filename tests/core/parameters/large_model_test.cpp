#include <gtest/gtest.h>

#include <utility>

#include "hbar/core/model/model_builder.h"
#include "hbar/core/parameters/parameters.h"
#include "tests/support/message_of.h"

/// What must not grow faster than the model: each of these tests would take minutes if it did.
namespace hbar {
namespace {

/// Model of a root and links of which each hangs on parent(i), with everything that links can have.
template <typename Parent>
Model large_model(int links, const Parent& parent) {
  ModelBuilder builder("large");
  Body body = solid_body("", Sphere{0.1}, 1.0);
  body.contact_points = Eigen::Matrix3Xd::Zero(3, 1);
  Contact ground{.surface = Plane{}};
  for (int i = 0; i < links; ++i) {
    body.name = concat("b", i);
    builder.add_link(parent(i), {.name = concat("j", i), .kind = RevoluteJoint{}}, body);
    builder.add_motor({.link = i});
    builder.add_end_effector({.link = i});
    ground.link = i % 2 == 0 ? i : 0;  // half of the contacts would have the same name
    builder.add_contact(ground);
    EXPECT_EQ(builder.rest_pose(i).p, Eigen::Vector3d::Zero());
  }
  return std::move(builder).build();
}

TEST(LargeModel, IsBuiltWithTenThousandOfEverythingInAnyTree) {
  // All of this would take minutes if one of the steps looked at all that came before it.
  constexpr int kLinks = 10'000;
  const auto chain = [](int i) { return i - 1; };
  const auto star = [](int i) { return i == 0 ? -1 : 0; };
  const auto wide = [](int i) { return i == 0 ? -1 : (i - 1) / 10; };
  const auto spine_with_ribs = [](int i) { return i == 0 ? -1 : (i % 2 == 0 ? i - 2 : i - 1); };
  for (const Model& model : {large_model(kLinks, chain), large_model(kLinks, star),
                             large_model(kLinks, wide), large_model(kLinks, spine_with_ribs)}) {
    EXPECT_EQ(model.dof(), kLinks);
    EXPECT_EQ(model.contact(kLinks - 1).name, concat("b0-ground-", kLinks / 2 + 1));
    for (int i = 0; i < kLinks; ++i) {
      ASSERT_EQ(model.find_link(concat("b", i)), i);
      ASSERT_EQ(model.find_joint(concat("j", i)), i);
      ASSERT_EQ(model.find_body(concat("b", i)), i);
      ASSERT_EQ(model.find_contact(model.contact(i).name), i);
      ASSERT_EQ(model.control_name(i), concat("j", i));
      ASSERT_EQ(model.is_tested(i), i % 2 == 0);
    }
  }
}

TEST(LargeModel, IsBuiltWithoutACopyWhereTheBuilderIsNotNeededAnyMore) {
  ModelBuilder builder("m");
  builder.add_link(-1, {.name = "j"}, solid_body("b", Sphere{1.0}, 1.0));
  const Model copied = builder.build();
  EXPECT_EQ(std::move(builder).build(), copied);
  EXPECT_EQ(
      testing::message_of<InvalidInput>([] { static_cast<void>(ModelBuilder("empty").build()); }),
      "model 'empty' has no link");
}

TEST(LargeModel, SelectsEachOfThousandsOfParametersByName) {
  // 2000 links have 36000 parameters: comparing each name with each of them would take minutes.
  ModelBuilder builder("long");
  for (int i = 0; i < 2000; ++i) {
    builder.add_link(i - 1, {.name = concat("j", i), .kind = RevoluteJoint{}},
                     solid_body(concat("b", i), Sphere{1.0}, 1.0));
  }
  const Model model = builder.build();
  const ParameterSet all = ParameterSet::all(model);
  std::vector<std::string> names;
  for (const Parameter& parameter : all.parameters()) {
    names.push_back(parameter.name);
  }
  EXPECT_EQ(ParameterSet::named(model, names).parameters(), all.parameters());
}

}  // namespace
}  // namespace hbar
