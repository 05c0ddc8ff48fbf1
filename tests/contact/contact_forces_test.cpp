#include "hbar/contact/contact_forces.h"

#include <gtest/gtest.h>

#include "hbar/core/geometry/surface_points.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::largest;
using testing::Random;
using testing::relative_gap;

using Wrench = Vector6<double>;

/// A model at one instant with its contact forces.
struct Instant {
  explicit Instant(const Model& m) : model(m) {}

  void move_to(const VectorXd& q, const VectorXd& qdot) {
    compute_motion<double>(model.tree(), mechanism, q, qdot, VectorXd::Zero(model.dof()), motion);
  }
  void linearize(const VectorXd& q, const VectorXd& qdot) {
    move_to(q, qdot);
    contacts.linearize(mechanism, motion);
  }
  void evaluate(const VectorXd& q, const VectorXd& qdot) {
    move_to(q, qdot);
    contacts.evaluate(mechanism, motion);
  }
  /// Generalised forces of contact: Σ Jᵀ w.                                             [dof]
  VectorXd joint_forces() const {
    VectorXd out = VectorXd::Zero(model.dof());
    for (int l = 0; l < model.dof(); ++l) {
      for (int link = 0; link < model.link_count(); ++link) {
        if (model.tree().is_on_path(model.tree().node_of(l), model.node_of_link(link))) {
          out[l] += contacts.wrenches()[static_cast<std::size_t>(link)].dot(motion.J.col(l));
        }
      }
    }
    return out;
  }

  const Model& model;
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Motion<double> motion{model.tree()};
  ContactForces<double> contacts{model};
};

constexpr ContactCoefficients kFirmGround = {.kn = 100.0, .kt = 2.0, .mu = 0.5, .damping = 0.0};

/// A body free to translate over the world's plane z = 0.
Model on_the_ground(const Shape& shape, const ContactCoefficients& coefficients = kFirmGround) {
  ModelBuilder builder("ground");
  Body body = solid_body("b", shape, 1.0);
  if (!std::holds_alternative<Sphere>(shape)) {
    body.contact_points = surface_points(shape, {.cuboid = {2, 2, 2}});
  }
  builder.add_link(-1, {.name = "j", .kind = TranslationalJoint{}}, body);
  builder.add_contact({.link = 0, .surface = Plane{}, .coefficients = coefficients});
  return builder.build();
}

TEST(ContactForces, OfABallOnAPlaneActAtItsDeepestPoint) {
  const Model model = on_the_ground(Sphere{0.5});
  Instant at(model);
  at.linearize(Vector3d(1.0, 2.0, 0.4), Vector3d(0.3, 0.0, 0.0));
  // f_n = 100·0.1 and friction 2·0.3 act at (1, 2, −0.1).
  const Vector3d f(-0.6, 0.0, 10.0);
  const Wrench expected = spatial<double>(Vector3d(1.0, 2.0, -0.1).cross(f), f);
  ASSERT_EQ(at.contacts.wrenches().size(), 1U);
  EXPECT_LT(relative_gap(at.contacts.wrenches()[0], expected), 1e-14);
  const ContactSummary& summary = at.contacts.summary(0);
  EXPECT_EQ(summary.active, 1);
  EXPECT_EQ(summary.sticking, 1);
  EXPECT_NEAR(summary.penetration, 0.1, 1e-15);
  EXPECT_NEAR(summary.normal_force, 10.0, 1e-13);
  EXPECT_NEAR(summary.friction_force, 0.6, 1e-14);
  ASSERT_EQ(at.contacts.active().size(), 1U);
  EXPECT_EQ(at.contacts.points(at.contacts.active()[0])[0].index, -1);
}

TEST(ContactForces, OfABallFollowItsPresentRadius) {
  const Model model = on_the_ground(Sphere{0.5});
  Instant at(model);
  at.mechanism.sizes(0, 0) = 0.7;
  at.evaluate(Vector3d(0.0, 0.0, 0.6), Vector3d::Zero());
  EXPECT_NEAR(at.contacts.wrenches()[0][5], 10.0, 1e-13);
  at.mechanism.sizes(0, 0) = 0.5;
  at.evaluate(Vector3d(0.0, 0.0, 0.6), Vector3d::Zero());
  EXPECT_EQ(at.contacts.wrenches()[0], Wrench::Zero());
}

TEST(ContactForces, SumOverThePointsThatTouchAndSaySo) {
  const Model model = on_the_ground(Cuboid{{1.0, 2.0, 0.4}});
  Instant at(model);
  at.linearize(Vector3d(0.0, 0.0, 0.15), Vector3d(30.0, 40.0, 0.0));
  const ContactSummary& summary = at.contacts.summary(0);
  EXPECT_EQ(summary.active, 4);
  EXPECT_EQ(summary.sticking, 0);
  EXPECT_NEAR(summary.penetration, 0.05, 1e-15);
  EXPECT_NEAR(summary.normal_force, 20.0, 1e-13);
  EXPECT_NEAR(summary.friction_force, 10.0, 1e-13);
  // Corners share alike; friction at depth 0.05 tips the body.
  const Vector3d f(-6.0, -8.0, 20.0);
  const Wrench expected = spatial<double>(Vector3d(0.0, 0.0, -0.05).cross(f), f);
  EXPECT_LT(relative_gap(at.contacts.wrenches()[0], expected), 1e-14);
  ASSERT_EQ(at.contacts.active().size(), 1U);
  EXPECT_EQ(at.contacts.active()[0].count, 4U);
  for (const TouchingPoint<double>& point : at.contacts.points(at.contacts.active()[0])) {
    EXPECT_LT(model.link(0).body.contact_points(2, point.index), 0.0);
  }
}

TEST(ContactForces, CountAPointThatGrazesAPlaneButPressWithNothing) {
  const Model model = on_the_ground(Cuboid{{1.0, 2.0, 0.5}});
  Instant at(model);
  at.linearize(Vector3d(0.0, 0.0, 0.25), Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(at.contacts.summary(0).active, 4);
  EXPECT_EQ(at.contacts.summary(0).penetration, 0.0);
  EXPECT_EQ(at.contacts.wrenches()[0], Wrench::Zero());
  EXPECT_TRUE(at.contacts.active()[0].stiffness.K_a.allFinite());
  // Pressed down, it would resist: four corners at k_n.
  EXPECT_NEAR(at.contacts.active()[0].stiffness.K_a(5, 5), -400.0, 1e-12);
}

TEST(ContactForces, OfAPairFarApartAreNone) {
  const Model model = on_the_ground(Cuboid{{1.0, 2.0, 0.4}});
  Instant at(model);
  for (const double height : {5.0, 1.0, 0.21}) {
    at.linearize(Vector3d(0.0, 0.0, 0.1), Vector3d::Zero());
    EXPECT_EQ(at.contacts.active().size(), 1U);
    at.linearize(Vector3d(0.0, 0.0, height), Vector3d::Zero());
    EXPECT_EQ(at.contacts.wrenches()[0], Wrench::Zero());
    EXPECT_EQ(at.contacts.summary(0).active, 0);
    EXPECT_EQ(at.contacts.summary(0).penetration, 0.0);
    EXPECT_TRUE(at.contacts.active().empty());
    VectorXd column = VectorXd::Zero(3);
    at.contacts.add_displacement_below(at.motion, 0, Wrench::Ones(), Wrench::Ones(), column);
    EXPECT_EQ(column, VectorXd::Zero(3));
  }
}

TEST(ContactForces, OfAModelWithoutContactsAreEmpty) {
  const Model model = testing::random_model(1);
  Instant at(model);
  at.linearize(VectorXd::Zero(model.dof()), VectorXd::Zero(model.dof()));
  EXPECT_TRUE(at.contacts.wrenches().empty());
  EXPECT_TRUE(at.contacts.active().empty());
}

TEST(ContactForces, TouchAPlaneThatAnotherBodyCarries) {
  // A ball sinks by 0.1 into the face y = 0.3 of a body that has moved along with it.
  ModelBuilder builder("carried");
  builder.add_link(-1, {.name = "j0", .kind = TranslationalJoint{}},
                   solid_body("table", Cuboid{}, 1.0));
  builder.add_link(-1, {.name = "j1", .kind = TranslationalJoint{}},
                   solid_body("ball", Sphere{0.2}, 1.0));
  builder.add_contact({.link = 1,
                       .other = 0,
                       .surface = Plane{{0.0, 0.3, 0.0}, Vector3d::UnitY()},
                       .coefficients = kFirmGround});
  const Model model = builder.build();
  Instant at(model);
  VectorXd q(6);
  q << 5.0, 6.0, 7.0, 5.5, 6.4, 7.5;
  at.evaluate(q, VectorXd::Ones(6));
  EXPECT_LT(relative_gap(at.contacts.wrenches()[1].tail<3>(), Vector3d(0.0, 10.0, 0.0)), 1e-13);
  EXPECT_EQ(at.contacts.wrenches()[0], -at.contacts.wrenches()[1]);
}

/// The same model built somewhere else: every root, and every plane of the world, moved by X.
Model moved_with_planes(const Model& model, const RigidTransform<double>& X) {
  ModelBuilder builder(model.name());
  for (const Link& link : model.links()) {
    Joint joint = link.joint;
    if (link.parent < 0) {
      joint.X_PJ = X * joint.X_PJ;
    }
    builder.add_link(link.parent, joint, link.body, link.name, link.design_mask);
  }
  for (Contact contact : model.contacts()) {
    if (contact.other < 0) {
      auto& plane = std::get<Plane>(contact.surface);
      plane.point = X.R * plane.point + X.p;
      plane.normal = (X.R * plane.normal).normalized();
    }
    builder.add_contact(contact);
  }
  return builder.build();
}

class EveryModelsContacts : public ::testing::TestWithParam<unsigned> {
 protected:
  void linearize(Instant& at) {
    const testing::State state = testing::random_state(model, random);
    at.linearize(state.q, state.qdot);
  }

  const Model model = testing::random_contact_model(GetParam());
  Random random{GetParam()};
};

TEST_P(EveryModelsContacts, DoNotKnowWhereTheWorldIs) {
  int touching = 0;
  for (int i = 0; i < 10; ++i) {
    const RigidTransform<double> X = testing::random_pose(random);
    const Model elsewhere = moved_with_planes(model, X);
    const testing::State state = testing::random_state(model, random);
    Instant here(model);
    Instant there(elsewhere);
    here.evaluate(state.q, state.qdot);
    there.evaluate(state.q, state.qdot);
    // World wrenches turn and shift their origin; joint-space forces stay.
    double scale = 0.0;
    for (const Wrench& w : here.contacts.wrenches()) {
      scale = std::max(scale, largest(w));
    }
    for (std::size_t k = 0; k < here.contacts.wrenches().size(); ++k) {
      const Wrench& w = here.contacts.wrenches()[k];
      const Vector3d f = X.R * w.tail<3>();
      const Vector3d m = X.R * w.head<3>() + X.p.cross(f);
      const Wrench expected = spatial<double>(m, f);
      EXPECT_LT(largest((there.contacts.wrenches()[k] - expected).eval()), 1e-12 * scale);
    }
    EXPECT_LT(relative_gap(there.joint_forces(), here.joint_forces()), 1e-12);
    for (int c = 0; c < model.contact_count(); ++c) {
      EXPECT_EQ(there.contacts.summary(c).active, here.contacts.summary(c).active);
      EXPECT_EQ(there.contacts.summary(c).sticking, here.contacts.summary(c).sticking);
      touching += here.contacts.summary(c).active > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(touching, 50);
}

TEST_P(EveryModelsContacts, HaveTheSameWrenchesWithAndWithoutDerivatives) {
  for (int i = 0; i < 10; ++i) {
    const testing::State state = testing::random_state(model, random);
    Instant plain(model);
    Instant full(model);
    plain.evaluate(state.q, state.qdot);
    full.linearize(state.q, state.qdot);
    std::size_t pairs = 0;
    for (std::size_t k = 0; k < plain.contacts.wrenches().size(); ++k) {
      EXPECT_EQ(plain.contacts.wrenches()[k], full.contacts.wrenches()[k]);
    }
    for (int c = 0; c < model.contact_count(); ++c) {
      const ContactSummary& a = plain.contacts.summary(c);
      const ContactSummary& b = full.contacts.summary(c);
      EXPECT_EQ(a.active, b.active);
      EXPECT_EQ(a.sticking, b.sticking);
      EXPECT_EQ(a.penetration, b.penetration);
      EXPECT_EQ(a.normal_force, b.normal_force);
      EXPECT_EQ(a.friction_force, b.friction_force);
      pairs += a.active > 0 ? 1 : 0;
    }
    EXPECT_EQ(full.contacts.active().size(), pairs);
  }
}

TEST_P(EveryModelsContacts, AreTheSumsOfTheirPairs) {
  Instant at(model);
  linearize(at);
  std::vector<Wrench> sums(at.contacts.wrenches().size(), Wrench::Zero());
  for (const ActivePair<double>& pair : at.contacts.active()) {
    const Contact& contact = model.contact(pair.contact);
    PairWrenches<double> of_points;
    for (const TouchingPoint<double>& point : at.contacts.points(pair)) {
      add_wrenches<double>(contact.reaction, point, of_points);
    }
    EXPECT_EQ(of_points.on_a, pair.wrenches.on_a);
    sums[static_cast<std::size_t>(contact.link)] += of_points.on_a;
    if (contact.other >= 0) {
      sums[static_cast<std::size_t>(contact.other)] += of_points.on_b;
    }
    EXPECT_EQ(at.contacts.summary(pair.contact).active, static_cast<int>(pair.count));
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    EXPECT_LT(largest((sums[k] - at.contacts.wrenches()[k]).eval()), 1e-13);
  }
}

TEST_P(EveryModelsContacts, PullBackByTheTransposeOfDisplacements) {
  Instant at(model);
  const Tree& tree = model.tree();
  for (int i = 0; i < 5; ++i) {
    linearize(at);
    const VectorXd z = random.vector(model.dof());
    std::vector<Wrench> W(static_cast<std::size_t>(tree.node_count()), Wrench::Zero());
    for (int node = 0; node < tree.node_count(); ++node) {
      for (int l = 0; l < model.dof(); ++l) {
        if (tree.is_on_path(tree.node_of(l), node)) {
          W[static_cast<std::size_t>(node)] += at.motion.J.col(l) * z[l];
        }
      }
    }
    LinkCovectors<double> covectors(model.link_count());
    at.contacts.pull_back(W, covectors);
    for (int node = 0; node < tree.node_count(); ++node) {
      const Wrench D = random.vector(6);
      const Wrench psi = random.vector(6);
      VectorXd column = VectorXd::Zero(model.dof());
      at.contacts.add_displacement_below(at.motion, node, D, psi, column);
      double expected = 0.0;
      double scale = 0.0;
      for (int link = 0; link < model.link_count(); ++link) {
        if (tree.is_on_path(node, model.node_of_link(link))) {
          const auto k = static_cast<std::size_t>(link);
          expected += covectors.by_displacement[k].dot(D) + covectors.by_twist[k].dot(psi);
          scale += covectors.by_displacement[k].norm() + covectors.by_twist[k].norm();
        }
      }
      EXPECT_NEAR(z.dot(column), expected, 1e-13 * (scale + column.norm()));
    }
  }
}

TEST_P(EveryModelsContacts, WeighByTheTransposeOfChanges) {
  Instant at(model);
  linearize(at);
  const VectorXd z = random.vector(model.dof());
  const Tree& tree = model.tree();
  std::vector<Wrench> W(static_cast<std::size_t>(tree.node_count()), Wrench::Zero());
  for (int l = 0; l < model.dof(); ++l) {
    for (int node = 0; node < tree.node_count(); ++node) {
      if (tree.is_on_path(tree.node_of(l), node)) {
        W[static_cast<std::size_t>(node)] += at.motion.J.col(l) * z[l];
      }
    }
  }
  for (int c = 0; c < model.contact_count(); ++c) {
    const PairWrenches<double> change = {random.vector(6), random.vector(6)};
    VectorXd column = VectorXd::Zero(model.dof());
    at.contacts.add_change(at.motion, c, change, column);
    EXPECT_NEAR(at.contacts.weigh(W, c, change), z.dot(column), 1e-13 * (1.0 + column.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsContacts, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
