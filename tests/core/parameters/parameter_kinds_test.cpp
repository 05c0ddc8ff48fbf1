#include "hbar/core/parameters/parameter_kinds.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using testing::kInfinity;

constexpr ContactCoefficients kFirmTable = {.kn = 1e4, .kt = 20.0, .mu = 0.7, .damping = 3.0};

Body with_points(Body body, int count) {
  body.contact_points = Eigen::Matrix3Xd::Random(3, count);
  return body;
}

/// A box with two contact points on the ground, a can that it touches, too, a ball on the ground
/// and a pill without contact, each with a shape of its own.
Model table(Units units = Units::kMetreKilogram, unsigned mask = 0) {
  ModelBuilder builder("table", units);
  const auto add = [&](const std::string& name, const Body& body) {
    builder.add_link(-1, {.name = "j" + name, .kind = TranslationalJoint{}}, body, name, mask);
  };
  add("box", with_points(solid_body("box", Cuboid{{1.0, 2.0, 3.0}}, 1.0), 2));
  add("can", solid_body("can", Cylinder{0.5, 2.0}, 1.0));
  add("ball", solid_body("ball", Sphere{0.25}, 1.0));
  add("pill", with_points(solid_body("pill", Capsule{0.3, 0.6}, 1.0), 1));
  builder.add_contact({.link = 0, .surface = Plane{}, .coefficients = kFirmTable});
  builder.add_contact({.name = "grip", .link = 0, .other = 1, .coefficients = kFirmTable});
  builder.add_contact({.link = 2,
                       .surface = Plane{},
                       .coefficients = kFirmTable,
                       .normal_law = NormalLaw::kLinear});
  return builder.build();
}

std::vector<std::string> names_of(const std::vector<Parameter>& list, ParameterKind kind) {
  std::vector<std::string> names;
  for (const Parameter& parameter : list) {
    if (parameter.kind == kind) {
      names.push_back(parameter.name);
    }
  }
  return names;
}

using Names = std::vector<std::string>;

TEST(ParameterList, NamesContactsAsTheSceneFormatDoes) {
  const std::vector<Parameter> list = list_parameters(table());
  EXPECT_EQ(names_of(list, ParameterKind::kContactPoint),
            (Names{"body.box.contact.0.x", "body.box.contact.0.y", "body.box.contact.0.z",
                   "body.box.contact.1.x", "body.box.contact.1.y", "body.box.contact.1.z"}));
  // Of bodies whose points a contact tests: the ball's deepest point counts, the pill's do not.
  EXPECT_EQ(names_of(list, ParameterKind::kContactScale),
            (Names{"body.box.contact_scale", "body.ball.contact_scale"}));
  EXPECT_EQ(
      names_of(list, ParameterKind::kContactCoefficient),
      (Names{"contact.box-ground.kn", "contact.box-ground.kt", "contact.box-ground.mu",
             "contact.box-ground.damping", "contact.grip.kn", "contact.grip.kt", "contact.grip.mu",
             "contact.grip.damping", "contact.ball-ground.kn", "contact.ball-ground.kt",
             "contact.ball-ground.mu", "contact.ball-ground.damping"}));
  EXPECT_EQ(names_of(list, ParameterKind::kSize),
            (Names{"body.box.size.x", "body.box.size.y", "body.box.size.z", "body.can.radius",
                   "body.can.length", "body.ball.radius", "body.pill.radius", "body.pill.length"}));
}

TEST(ParameterList, HasNominalValuesUnitsAndBoundsOfContacts) {
  const Model model = table();
  const ParameterSet set = ParameterSet::all(model);
  const auto expect = [](const ParameterSet& of, const std::string& name, double nominal,
                         const std::string& unit, double lower, double upper) {
    const Parameter& parameter = of[of.find(name)];
    EXPECT_EQ(parameter.nominal, nominal) << name;
    EXPECT_EQ(parameter.unit, unit) << name;
    EXPECT_EQ(parameter.lower, lower) << name;
    EXPECT_EQ(parameter.upper, upper) << name;
  };
  expect(set, "body.box.contact.1.y", model.link(0).body.contact_points(1, 1), "m", -kInfinity,
         kInfinity);
  expect(set, "body.ball.contact_scale", 1.0, "1", 0.0, kInfinity);
  expect(set, "contact.grip.kn", 1e4, "N/m", 0.0, kInfinity);
  expect(set, "contact.grip.kt", 20.0, "N·s/m", 0.0, kInfinity);
  expect(set, "contact.grip.mu", 0.7, "1", 0.0, kInfinity);
  expect(set, "contact.grip.damping", 3.0, "N·s/m²", 0.0, kInfinity);
  expect(set, "contact.ball-ground.damping", 3.0, "N·s/m", 0.0, kInfinity);
  expect(set, "body.box.size.z", 3.0, "m", 3e-6, kInfinity);
  expect(set, "body.pill.length", 0.6, "m", 1e-6 * 0.6, kInfinity);
  const ParameterSet small = ParameterSet::all(table(Units::kCentimetreGram));
  expect(small, "contact.grip.kn", 1e4, "dyn/cm", 0.0, kInfinity);
  expect(small, "contact.grip.damping", 3.0, "dyn·s/cm²", 0.0, kInfinity);
  expect(small, "body.can.radius", 0.5, "cm", 5e-7, kInfinity);
}

TEST(ParameterList, ListsPointsAndScalesThatAMaskAsksForThoughNothingTouches) {
  const std::vector<Parameter> list =
      list_parameters(table(Units::kMetreKilogram, kMaskContactPoints | kMaskContactScale));
  const Names points = names_of(list, ParameterKind::kContactPoint);
  EXPECT_EQ(points.size(), 9U);
  EXPECT_EQ(points.back(), "body.pill.contact.0.z");
  EXPECT_EQ(
      names_of(list, ParameterKind::kContactScale),
      (Names{"body.box.contact_scale", "body.ball.contact_scale", "body.pill.contact_scale"}));
}

TEST(ParameterList, IsOrderedByKindOwnerAndComponentWithoutRepeats) {
  for (const Model& model : {table(), testing::random_contact_model(1)}) {
    const std::vector<Parameter> list = list_parameters(model);
    std::set<std::string> names;
    for (std::size_t i = 0; i < list.size(); ++i) {
      names.insert(list[i].name);
      const auto key = [&list](std::size_t k) {
        const Parameter& at = list[k];
        // Mass and inertia, stiffness and damping, both gains stand together.
        const bool second = at.kind == ParameterKind::kInertia ||
                            at.kind == ParameterKind::kDamping || at.kind == ParameterKind::kMotorD;
        return std::tuple{static_cast<int>(at.kind) - (second ? 1 : 0), at.owner, second,
                          at.component};
      };
      EXPECT_TRUE(i == 0 || key(i - 1) < key(i)) << list[i].name;
      EXPECT_LE(list[i].lower, list[i].nominal) << list[i].name;
      EXPECT_LE(list[i].nominal, list[i].upper) << list[i].name;
      EXPECT_FALSE(list[i].unit.empty()) << list[i].name;
    }
    EXPECT_EQ(names.size(), list.size());
  }
}

TEST(MaskBit, SelectsEachTypeOfTableTwoByItsOwnBitAndNothingElse) {
  const std::map<ParameterKind, unsigned> expected = {
      {ParameterKind::kJointTransform, kMaskJointTransform},
      {ParameterKind::kBodyTransform, kMaskBodyTransform},
      {ParameterKind::kContactPoint, kMaskContactPoints},
      {ParameterKind::kMass, kMaskMassInertia},
      {ParameterKind::kInertia, kMaskMassInertia},
      {ParameterKind::kStiffness, kMaskStiffnessDamping},
      {ParameterKind::kDamping, kMaskStiffnessDamping},
      {ParameterKind::kContactScale, kMaskContactScale}};
  for (const ParameterKindRow& row_of_kind : parameter_kinds()) {
    const ParameterKind kind = row_of_kind.kind;
    const auto found = expected.find(kind);
    EXPECT_EQ(row_of_kind.mask_bit, found == expected.end() ? 0U : found->second)
        << kind_name(kind);
  }
  for (const unsigned bit : {1U, 2U, 4U, 8U, 16U, 32U}) {
    const ParameterSet set = ParameterSet::masked(table(Units::kMetreKilogram, bit));
    EXPECT_GT(set.size(), 0);
    for (const Parameter& parameter : set.parameters()) {
      EXPECT_EQ(row_of(parameter.kind).mask_bit, bit) << parameter.name;
    }
  }
}

}  // namespace
}  // namespace hbar
