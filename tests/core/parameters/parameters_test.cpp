#include "hbar/core/parameters/parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <set>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::message_of;
using testing::relative_gap;

/// A hinge "hip" carrying "thigh", then "knee" (a position motor, free in x, y, θ) carrying "shin".
Model leg(Units units = Units::kMetreKilogram) {
  ModelBuilder builder("leg", units);
  builder.set_gravity({0.0, -9.81, 0.0});
  builder.add_link(-1, {.name = "hip", .kind = RevoluteJoint{}, .damping = 0.1, .stiffness = 0.2},
                   solid_body("thigh", Cuboid{{1.0, 2.0, 3.0}}, 1.0), "", kMaskBodyTransform);
  builder.add_link(0, {.name = "knee", .kind = PlanarJoint{}}, solid_body("shin", Sphere{0.5}, 1.0),
                   "", kMaskMassInertia | kMaskStiffnessDamping | kMaskContactScale);
  builder.add_motor({.link = 0});
  builder.add_motor({.link = 1, .kind = Motor::Kind::kPosition, .P = 5.0, .D = 0.5});
  return builder.build();
}

std::vector<std::string> names_of(const ParameterSet& set) {
  std::vector<std::string> names;
  for (const Parameter& parameter : set.parameters()) {
    names.push_back(parameter.name);
  }
  return names;
}

std::vector<std::string> frame_names(const std::string& owner) {
  std::vector<std::string> names;
  for (const char* part : {".rotation", ".translation"}) {
    for (const char* axis : {".x", ".y", ".z"}) {
      names.push_back(owner + part + axis);
    }
  }
  return names;
}

std::vector<std::string> joined(const std::vector<std::vector<std::string>>& parts) {
  std::vector<std::string> out;
  for (const std::vector<std::string>& part : parts) {
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

TEST(ParameterSet, ListsEverythingByTypeThenByLinkInFileOrder) {
  EXPECT_EQ(names_of(ParameterSet::all(leg())),
            joined({frame_names("joint.hip"),
                    frame_names("joint.knee"),
                    frame_names("body.thigh"),
                    frame_names("body.shin"),
                    {"body.thigh.mass", "body.thigh.inertia.x", "body.thigh.inertia.y",
                     "body.thigh.inertia.z", "body.shin.mass", "body.shin.inertia.x",
                     "body.shin.inertia.y", "body.shin.inertia.z"},
                    {"joint.hip.stiffness", "joint.hip.damping", "joint.knee.stiffness",
                     "joint.knee.damping"},
                    {"motor.knee.P", "motor.knee.D"},
                    {"gravity.x", "gravity.y", "gravity.z"},
                    {"body.thigh.size.x", "body.thigh.size.y", "body.thigh.size.z",
                     "body.shin.radius"}}));
}

TEST(ParameterSet, HasNominalValuesUnitsAndBounds) {
  const Model model = leg();
  const ParameterSet set = ParameterSet::all(model);
  const double infinity = std::numeric_limits<double>::infinity();
  const auto expect = [&set](const std::string& name, double nominal, const std::string& unit,
                             double lower, double upper) {
    const Parameter& parameter = set[set.find(name)];
    EXPECT_EQ(parameter.nominal, nominal) << name;
    EXPECT_EQ(parameter.unit, unit) << name;
    EXPECT_EQ(parameter.lower, lower) << name;
    EXPECT_EQ(parameter.upper, upper) << name;
  };
  const Body& thigh = model.link(0).body;
  expect("joint.hip.rotation.y", 0.0, "rad", -std::numbers::pi, std::numbers::pi);
  expect("body.shin.translation.z", 0.0, "m", -infinity, infinity);
  expect("body.thigh.mass", thigh.mass, "kg", 1e-6 * thigh.mass, infinity);
  expect("body.thigh.inertia.z", thigh.inertia.z(), "kg·m²", 1e-6 * thigh.inertia.z(), infinity);
  expect("joint.hip.stiffness", 0.2, "N·m/rad", 0.0, infinity);
  expect("joint.hip.damping", 0.1, "N·m/rad·s", 0.0, infinity);
  expect("joint.knee.stiffness", 0.0, "N/m", 0.0, infinity);
  expect("motor.knee.P", 5.0, "N/m", 0.0, infinity);
  expect("motor.knee.D", 0.5, "N/m·s", 0.0, infinity);
  expect("gravity.y", -9.81, "m/s²", -infinity, infinity);
  for (int i = 0; i < set.size(); ++i) {
    EXPECT_EQ(set.nominal()[i], set[i].nominal);
    EXPECT_EQ(set.lower()[i], set[i].lower);
    EXPECT_EQ(set.upper()[i], set[i].upper);
  }
  const ParameterSet small = ParameterSet::all(leg(Units::kCentimetreGram));
  EXPECT_EQ(small[small.find("joint.hip.damping")].unit, "dyn·cm/rad·s");
  EXPECT_EQ(small[small.find("body.shin.inertia.x")].unit, "g·cm²");
  EXPECT_EQ(small[small.find("gravity.x")].unit, "cm/s²");
}

TEST(ParameterSet, IsMadeOfWholeBlocksInOrder) {
  const ParameterSet set = ParameterSet::all(testing::random_contact_model(1));
  int next = 0;
  for (const ParameterBlock& block : set.blocks()) {
    EXPECT_EQ(block.first, next);
    EXPECT_GT(block.size, 0);
    for (int i = block.first; i < block.first + block.size; ++i) {
      EXPECT_EQ(set[i].kind, block.kind);
      EXPECT_EQ(set[i].owner, block.owner);
      EXPECT_EQ(set[i].component, i - block.first);
    }
    next += block.size;
  }
  EXPECT_EQ(next, set.size());
  EXPECT_EQ(ParameterSet().size(), 0);
}

TEST(EveryParameterKind, IsListedWithANameOfItsOwn) {
  const ParameterSet set = ParameterSet::all(testing::random_contact_model(1));
  std::set<std::string_view> names;
  for (const ParameterKindRow& row_of_kind : parameter_kinds()) {
    const ParameterKind kind = row_of_kind.kind;
    names.insert(kind_name(kind));
    EXPECT_TRUE(std::any_of(set.parameters().begin(), set.parameters().end(),
                            [kind](const Parameter& p) { return p.kind == kind; }))
        << kind_name(kind);
  }
  EXPECT_EQ(names.size(), parameter_kinds().size());
  EXPECT_FALSE(names.contains(""));
}

TEST(ParameterSet, SelectsByMask) {
  EXPECT_EQ(names_of(ParameterSet::masked(leg())),
            joined({frame_names("body.thigh"),
                    {"body.shin.mass", "body.shin.inertia.x", "body.shin.inertia.y",
                     "body.shin.inertia.z", "joint.knee.stiffness", "joint.knee.damping"}}));
}

TEST(ParameterSet, SelectsByNamesAndPrefixesInTheOrderOfTheRegistry) {
  const Model model = leg();
  EXPECT_EQ(names_of(ParameterSet::named(
                model, {"gravity.y", "body.shin.inertia", "joint.hip.translation.x"})),
            (std::vector<std::string>{"joint.hip.translation.x", "body.shin.inertia.x",
                                      "body.shin.inertia.y", "body.shin.inertia.z", "gravity.y"}));
  EXPECT_EQ(ParameterSet::named(model, {"gravity", "gravity.x"}).size(), 3);
  EXPECT_EQ(ParameterSet::named(model, {"joint", "body", "motor", "gravity"}).size(),
            ParameterSet::all(model).size());
}

TEST(ParameterSet, FindsEveryComponentByItsKindAndOwner) {
  const Model model = testing::random_contact_model(2);
  const ParameterSet all = ParameterSet::all(model);
  // Whole blocks, parts of blocks, and nothing.
  for (const ParameterSet& set :
       {all, ParameterSet::masked(model), ParameterSet(),
        ParameterSet::named(model, {"body.b3.inertia.y", "joint.j3.translation.z", "gravity.y",
                                    "body.b5.contact.2.x", "body.b5.contact.4.z", "body.b2.length",
                                    "body.b6.mass", "joint.j1.damping"})}) {
    const std::vector<std::string> names = names_of(set);
    for (const Parameter& p : all.parameters()) {
      const auto at = std::find(names.begin(), names.end(), p.name);
      const int expected = at == names.end() ? -1 : static_cast<int>(at - names.begin());
      EXPECT_EQ(set.index(p.kind, p.owner, p.component), expected) << p.name;
    }
    EXPECT_EQ(set.index(ParameterKind::kMass, model.link_count(), 0), -1);
    EXPECT_EQ(set.index(ParameterKind::kMass, -1, 0), -1);
    EXPECT_EQ(set.index(ParameterKind::kMass, 1, 1), -1);
  }
}

TEST(ParameterSet, RefusesNamesThatMatchNothing) {
  const Model model = leg();
  const auto named = [&model](const std::string& name) {
    return message_of<InvalidInput>([&] { static_cast<void>(ParameterSet::named(model, {name})); });
  };
  EXPECT_EQ(named("body.shin.mas"),
            "there is no parameter 'body.shin.mas'; did you mean 'body.shin.mass'?");
  // A prefix ends at a dot.
  EXPECT_EQ(named("body.shin.mass.x"),
            "there is no parameter 'body.shin.mass.x'; did you mean 'body.shin.mass'?");
  EXPECT_NE(named("gravit"), "");
  EXPECT_NE(named("gravity."), "");
  EXPECT_NE(named(""), "");
  EXPECT_EQ(message_of<InvalidInput>([&] {
              static_cast<void>(ParameterSet::named(model, {"gravity"}).find("gravity.w"));
            }),
            "parameter 'gravity.w' is not in the set; did you mean 'gravity.x'?");
}

TEST(ApplyParameters, LeavesTheNominalMechanismAtNominalValues) {
  const Model model = testing::random_model(2);
  const ParameterSet set = ParameterSet::all(model);
  auto mechanism = nominal_mechanism<double>(model);
  const auto nominal = mechanism;
  apply_parameters<double>(model, set, set.nominal(), mechanism);
  for (std::size_t i = 0; i < nominal.X_PJ.size(); ++i) {
    EXPECT_TRUE(mechanism.X_PJ[i] == nominal.X_PJ[i]);
    EXPECT_TRUE(mechanism.X_JB[i] == nominal.X_JB[i]);
    EXPECT_EQ(mechanism.inertia[i].second, nominal.inertia[i].second);
  }
  EXPECT_EQ(mechanism.mass, nominal.mass);
  EXPECT_EQ(mechanism.stiffness, nominal.stiffness);
  EXPECT_EQ(mechanism.motor_P, nominal.motor_P);
}

TEST(ApplyParameters, TurnsRightOfTheNominalAndMovesInTheParentsAxes) {
  const Model model = testing::random_model(3);
  testing::Random random(1);
  for (const bool joint : {true, false}) {
    const std::string owner = joint ? "joint.j4" : "body.b4";
    const ParameterSet set =
        ParameterSet::named(model, {owner + ".rotation", owner + ".translation"});
    const VectorXd p = random.vector(6);
    auto mechanism = nominal_mechanism<double>(model);
    apply_parameters<double>(model, set, p, mechanism);
    const RigidTransform<double>& nominal =
        joint ? model.link(4).joint.X_PJ : model.link(4).body.X_JB;
    const RigidTransform<double>& found = joint ? mechanism.X_PJ[4] : mechanism.X_JB[4];
    const Eigen::Vector3d w = p.head<3>();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix();
    EXPECT_LT(relative_gap(found.R, nominal.R * turn), 1e-14);
    EXPECT_LT(relative_gap(found.p, nominal.p + p.tail<3>()), 1e-15);
    EXPECT_TRUE(mechanism.X_PJ[3] == model.link(3).joint.X_PJ);
  }
}

TEST(ApplyParameters, PutsEveryOtherNumberInItsPlace) {
  const Model model = leg();
  const ParameterSet set =
      ParameterSet::named(model, {"body.shin.mass", "body.thigh.inertia", "joint.hip.stiffness",
                                  "joint.knee.damping", "motor.knee", "gravity.z"});
  VectorXd p(9);
  p << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0;
  auto mechanism = nominal_mechanism<double>(model);
  const auto at = [&](const std::string& name) { return p[set.find(name)]; };
  apply_parameters<double>(model, set, p, mechanism);
  EXPECT_EQ(mechanism.mass[1], at("body.shin.mass"));
  EXPECT_EQ(mechanism.mass[0], model.link(0).body.mass);
  EXPECT_EQ(mechanism.moments(1, 0), at("body.thigh.inertia.y"));
  EXPECT_EQ(mechanism.stiffness[0], at("joint.hip.stiffness"));
  EXPECT_EQ(mechanism.damping[1], at("joint.knee.damping"));
  EXPECT_EQ(mechanism.motor_P[1], at("motor.knee.P"));
  EXPECT_EQ(mechanism.motor_D[1], at("motor.knee.D"));
  EXPECT_EQ(mechanism.motor_P[0], 0.0);
  EXPECT_EQ(mechanism.gravity, Eigen::Vector3d(0.0, -9.81, at("gravity.z")));
  // What is no longer in the set goes back to the model's own.
  apply_parameters<double>(model, ParameterSet(), VectorXd(), mechanism);
  EXPECT_EQ(mechanism.mass[1], model.link(1).body.mass);
  EXPECT_EQ(mechanism.gravity, model.gravity());
}

TEST(ApplyParameters, PutsContactNumbersInTheirPlaces) {
  const Model model = testing::random_contact_model(3);
  const std::string contact = "contact." + model.contact(2).name;
  const std::string body = "body." + model.link(4).body.name;
  const ParameterSet set = ParameterSet::named(
      model, {contact + ".kt", contact + ".damping", body + ".contact_scale", body + ".contact.3"});
  VectorXd p = VectorXd::Zero(set.size());
  p << 3.0, 4.0, 5.0, 6.0, 7.0, 8.0;  // the point, the scale, then the coefficients
  auto mechanism = nominal_mechanism<double>(model);
  const auto nominal = mechanism;
  apply_parameters<double>(model, set, p, mechanism);
  EXPECT_EQ(mechanism.contact_points[4].col(3), Eigen::Vector3d(3.0, 4.0, 5.0));
  EXPECT_EQ(mechanism.contact_points[4].col(2), nominal.contact_points[4].col(2));
  EXPECT_EQ(mechanism.contact_scale[4], 6.0);
  EXPECT_EQ(mechanism.contact_scale[3], 1.0);
  const ContactCoefficients& own = model.contact(2).coefficients;
  EXPECT_EQ(mechanism.contact_coefficients.col(2), Eigen::Vector4d(own.kn, 7.0, own.mu, 8.0));
  EXPECT_EQ(mechanism.contact_coefficients.col(1), nominal.contact_coefficients.col(1));
  // The bound on how far points reach follows them.
  EXPECT_DOUBLE_EQ(mechanism.contact_radius[4], Eigen::Vector3d(3.0, 4.0, 5.0).norm());
}

/// A body of every shape in turn, homogeneous, with contact points on its surface.
Model resizable() {
  ModelBuilder builder("resizable");
  const std::vector<Shape> shapes = {Cuboid{{1.0, 2.0, 3.0}}, Sphere{0.5}, Cylinder{0.5, 2.0},
                                     Capsule{0.4, 1.0}};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    Body body = solid_body(concat("b", i), shapes[i], 3.0);
    body.contact_points = surface_points(shapes[i], {.sphere = {2, 3}});
    builder.add_link(-1, {.name = concat("j", i)}, body);
    builder.add_contact({.link = static_cast<int>(i), .surface = Plane{}});
  }
  return builder.build();
}

TEST(ApplyParameters, LetsMassMomentsAndContactPointsFollowSizes) {
  const Model model = resizable();
  for (int link = 0; link < model.link_count(); ++link) {
    const Body& body = model.link(link).body;
    std::vector<std::string> names;
    for (const std::string& size : size_names(body.shape)) {
      names.push_back(concat("body.", body.name, '.', size));
    }
    const ParameterSet set = ParameterSet::named(model, names);
    std::vector<double> sizes = sizes_of(body.shape);
    VectorXd p(set.size());
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      sizes[k] *= 1.0 + 0.2 * static_cast<double>(k + 1);
      p[static_cast<Eigen::Index>(k)] = sizes[k];
    }
    const Shape larger = with_sizes(body.shape, sizes);
    const MassProperties expected = solid_mass_properties(larger, 3.0);
    const Eigen::Matrix3Xd points = surface_points(larger, {.sphere = {2, 3}});
    auto mechanism = nominal_mechanism<double>(model);
    apply_parameters<double>(model, set, p, mechanism);
    EXPECT_NEAR(mechanism.mass[link], expected.mass, 1e-14 * expected.mass);
    EXPECT_LT(relative_gap(mechanism.moments.col(link), expected.inertia), 1e-14);
    EXPECT_LT(relative_gap(mechanism.contact_points[static_cast<std::size_t>(link)], points),
              1e-14);
    EXPECT_DOUBLE_EQ(mechanism.contact_radius[link], points.colwise().norm().maxCoeff());
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      EXPECT_EQ(mechanism.sizes(static_cast<Eigen::Index>(k), link), sizes[k]);
    }
    // The others are as they were.
    const int other = (link + 1) % model.link_count();
    EXPECT_EQ(mechanism.mass[other], model.link(other).body.mass);
  }
}

TEST(ApplyParameters, ReadsMassAndPointsAsThoseAtNominalSizes) {
  const Model model = resizable();
  const ParameterSet set = ParameterSet::named(
      model, {"body.b1.mass", "body.b1.inertia", "body.b1.contact.0", "body.b1.radius"});
  VectorXd p = set.nominal();
  p[set.find("body.b1.mass")] = 10.0;
  p[set.find("body.b1.inertia.x")] *= 1.5;
  p[set.find("body.b1.contact.0.x")] += 0.1;
  p[set.find("body.b1.radius")] = 1.0;  // twice as large
  auto mechanism = nominal_mechanism<double>(model);
  apply_parameters<double>(model, set, p, mechanism);
  EXPECT_DOUBLE_EQ(mechanism.mass[1], 80.0);
  EXPECT_DOUBLE_EQ(mechanism.moments(0, 1), 32.0 * p[set.find("body.b1.inertia.x")]);
  // The first pole moves along with the surface from where it was put.
  EXPECT_LT(relative_gap(mechanism.contact_points[1].col(0), Eigen::Vector3d(0.1, 0.0, 1.0)),
            1e-15);
}

TEST(ApplyParameters, RefusesContactNumbersThatCannotBe) {
  const Model model = resizable();
  const auto message = [&model](const std::string& name, double value) {
    auto mechanism = nominal_mechanism<double>(model);
    return message_of<InvalidInput>([&] {
      const ParameterSet set = ParameterSet::named(model, {name});
      require_in_range(set, VectorXd::Constant(1, value));
      apply_parameters<double>(model, set, VectorXd::Constant(1, value), mechanism);
    });
  };
  for (const char* name : {"kn", "kt", "mu", "damping"}) {
    const std::string full = concat("contact.b0-ground.", name);
    EXPECT_EQ(message(full, -0.5), full + " is -0.5; it must be ≥ 0");
    EXPECT_EQ(message(full, std::nan("")), full + " is nan; it must be finite");
    EXPECT_EQ(message(full, 0.0), "");
  }
  EXPECT_EQ(message("body.b2.contact_scale", -1.0), "body.b2.contact_scale is -1; it must be ≥ 0");
  EXPECT_EQ(message("body.b2.contact_scale", 0.0), "");
  EXPECT_EQ(message("body.b1.radius", 0.0), "body.b1.radius is 0; it must be positive");
  EXPECT_EQ(message("body.b0.size.y", -2.0), "body.b0.size.y is -2; it must be positive");
  EXPECT_NE(message("body.b3.length", std::nan("")), "");
  EXPECT_NE(message("body.b3.length", std::numeric_limits<double>::infinity()), "");
  EXPECT_EQ(message("body.b0.contact.1.x", std::nan("")),
            "body.b0.contact.1.x is nan; it must be finite");
}

TEST(ApplyParameters, RefusesVectorsAndBodiesThatCannotBe) {
  const Model model = leg();
  const auto message = [&model](const std::string& name, const VectorXd& p) {
    auto mechanism = nominal_mechanism<double>(model);
    return message_of<InvalidInput>(
        [&] { apply_parameters<double>(model, ParameterSet::named(model, {name}), p, mechanism); });
  };
  EXPECT_EQ(message("gravity", VectorXd::Zero(2)), "p has 2 entries; the parameter set has 3");
  EXPECT_EQ(message("gravity.x", VectorXd::Constant(1, std::nan(""))),
            "gravity.x is nan; it must be finite");
  EXPECT_EQ(message("body.shin.mass", VectorXd::Zero(1)),
            "body.shin.mass is 0; it must be positive");
  const std::string moments =
      "); moments must be positive and none may exceed the sum of the other two (see "
      "inertia_chart for a chart that keeps to that)";
  EXPECT_EQ(message("body.shin.inertia", Eigen::Vector3d(1.0, 1.0, 3.0)),
            "body.shin.inertia is (1 1 3" + moments);
  EXPECT_EQ(message("body.shin.inertia", Eigen::Vector3d(1.0, -1.0, 1.0)),
            "body.shin.inertia is (1 -1 1" + moments);
}

}  // namespace
}  // namespace hbar
