#include "hbar/contact/contact_law.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/duals.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::largest;
using testing::Random;
using testing::relative_gap;

constexpr double kWidth = 0.4;
constexpr int kInputs = 12;  // d, n, u, k_n, k_t, μ, k_d, s

/// Every choice there is.
std::vector<LawChoice> every_law() {
  std::vector<LawChoice> laws;
  for (const NormalLaw normal : {NormalLaw::kDocument, NormalLaw::kLinear}) {
    for (const FrictionLaw friction : {FrictionLaw::kDocument, FrictionLaw::kSmooth}) {
      for (const bool adhesion : {true, false}) {
        laws.push_back({normal, friction, kWidth, adhesion});
      }
    }
  }
  return laws;
}

std::string law_name(const ::testing::TestParamInfo<LawChoice>& info) {
  return std::string(info.param.normal == NormalLaw::kLinear ? "Linear" : "Document") +
         (info.param.friction == FrictionLaw::kSmooth ? "Smooth" : "Coulomb") +
         (info.param.adhesion ? "Adhesive" : "PushingOnly");
}

/// All that a force depends on.
struct Touch {
  LawNumbers<double> k;
  double d = 0.0;
  Vector3d n = Vector3d::UnitZ();
  Vector3d u = Vector3d::Zero();

  Vector3d sliding() const { return u - n.dot(u) * n; }
  VectorXd inputs() const {
    VectorXd x(kInputs);
    x << d, n, u, k.kn, k.kt, k.mu, k.damping, k.scale;
    return x;
  }
};

PointForce<double> force_of(const LawChoice& law, const Touch& at) {
  return contact_force<double>(law, at.k, at.d, at.n, at.u);
}

/// Numbers of order one that stick, slide, push and pull, each often.
Touch random_touch(Random& random) {
  Touch at;
  at.k = {random.between(0.5, 5.0), random.between(0.0, 2.0), random.between(0.0, 1.5),
          random.between(0.0, 5.0), random.between(0.5, 2.0)};
  at.d = -random.between(0.01, 1.0);
  at.n = random.direction();
  at.u = random.vector3(2.0);
  return at;
}

/// f as a function of Touch::inputs.
template <Scalar S>
VectorX<S> force_at(const LawChoice& law, const VectorX<S>& x) {
  const LawNumbers<S> k = {x[7], x[8], x[9], x[10], x[11]};
  return contact_force<S>(law, k, x[0], x.template segment<3>(1), x.template segment<3>(4)).f;
}

/// ∂f/∂(Touch::inputs) as the law gives it.                                         [3 x 12]
MatrixXd jacobian_of(const LawChoice& law, const Touch& at) {
  PointForceDerivatives<double> by;
  const PointForce<double> force = contact_force<double>(law, at.k, at.d, at.n, at.u, by);
  EXPECT_EQ(force.f, force_of(law, at).f);
  MatrixXd out(3, kInputs);
  out << by.by_d, by.by_n, by.by_u, by.by_coefficient[0], by.by_coefficient[1],
      by.by_coefficient[2], by.by_coefficient[3], by.by_scale;
  return out;
}

MatrixXd by_duals(const LawChoice& law, const Touch& at) {
  return testing::dual_jacobian([&](const VectorX<Dual>& x) { return force_at<Dual>(law, x); },
                                at.inputs());
}

/// Depth 0.1, approached at 2 while sliding at 0.5 along (0.6, 0.8).
Touch landing(double kt) {
  return {{.kn = 100.0, .kt = kt, .mu = 0.5, .damping = 5.0, .scale = 2.0},
          -0.1,
          Vector3d::UnitZ(),
          {0.3, 0.4, -2.0}};
}

void expect_force(const LawChoice& law, const Touch& at, const Vector3d& f, double friction,
                  bool sticks) {
  const PointForce<double> force = force_of(law, at);
  EXPECT_LT(relative_gap(force.f, f), 1e-15);
  EXPECT_DOUBLE_EQ(force.normal, f.z());
  EXPECT_DOUBLE_EQ(force.friction, friction);
  EXPECT_EQ(force.sticks, sticks);
}

TEST(DocumentLaw, HasTheForceThatIsWorkedOutByHand) {
  const LawChoice law;
  // f_n = 2 (100·0.1 + 5·2·0.1) = 22, its bound on friction 11; k_t |ṫ| s is 1 or 100.
  expect_force(law, landing(1.0), {-0.6, -0.8, 22.0}, 1.0, true);
  expect_force(law, landing(100.0), {-6.6, -8.8, 22.0}, 11.0, false);
  // Opened fast enough, damping pulls: f_n = 2 (10 − 5·30·0.1) = −10.
  Touch opening = landing(100.0);
  opening.u.z() = 30.0;
  expect_force(law, opening, {-3.0, -4.0, -10.0}, 5.0, false);
  expect_force({.adhesion = false}, opening, Vector3d::Zero(), 0.0, false);
}

TEST(LinearLaw, HasTheForceThatIsWorkedOutByHand) {
  const LawChoice law = {.normal = NormalLaw::kLinear};
  // f_n = 10 + 5·2; friction's bound is μ k_n |d| = 5, and s has no part.
  expect_force(law, landing(1.0), {-0.3, -0.4, 20.0}, 0.5, true);
  expect_force(law, landing(100.0), {-3.0, -4.0, 20.0}, 5.0, false);
  Touch opening = landing(100.0);
  opening.u.z() = 4.0;
  expect_force(law, opening, {-3.0, -4.0, -10.0}, 5.0, false);
  expect_force({.normal = NormalLaw::kLinear, .adhesion = false}, opening, Vector3d::Zero(), 0.0,
               false);
}

TEST(SmoothLaw, HasTheForceThatIsWorkedOutByHand) {
  // |ṫ| = 0.5 with width 1.2 gives the root 1.3.
  const LawChoice law = {.friction = FrictionLaw::kSmooth, .friction_width = 1.2};
  const double share = 0.5 / 1.3;
  expect_force(law, landing(7.0), {-6.6 * share, -8.8 * share, 22.0}, 11.0 * share, true);
  // As much as 1/√2 of the bound at its width, where it begins to count as sliding.
  const LawChoice narrow = {.friction = FrictionLaw::kSmooth, .friction_width = 0.5};
  EXPECT_NEAR(force_of(narrow, landing(7.0)).friction, 11.0 / std::sqrt(2.0), 1e-14 * 11.0);
  EXPECT_FALSE(
      force_of({.friction = FrictionLaw::kSmooth, .friction_width = 0.499}, landing(7.0)).sticks);
  EXPECT_TRUE(
      force_of({.friction = FrictionLaw::kSmooth, .friction_width = 0.501}, landing(7.0)).sticks);
}

TEST(SmoothLaw, TendsToCoulombsAsItsWidthVanishes) {
  const double coulomb = force_of({}, landing(1e6)).friction;
  for (const double width : {1e-2, 1e-3, 1e-4}) {
    const double smooth =
        force_of({.friction = FrictionLaw::kSmooth, .friction_width = width}, landing(1e6))
            .friction;
    // 1 − 1/√(1 + r²) = r²/2 to the fourth order, r = width / |ṫ|.
    const double r = width / 0.5;
    EXPECT_NEAR(1.0 - smooth / coulomb, 0.5 * r * r, r * r * r * r + 1e-15);
  }
}

TEST(LawOf, TakesTheChoicesOfAContact) {
  Contact contact;
  contact.normal_law = NormalLaw::kLinear;
  contact.friction_law = FrictionLaw::kSmooth;
  contact.friction_width = 0.3;
  contact.adhesion = false;
  const LawChoice law = law_of(contact);
  EXPECT_EQ(law.normal, NormalLaw::kLinear);
  EXPECT_EQ(law.friction, FrictionLaw::kSmooth);
  EXPECT_EQ(law.friction_width, 0.3);
  EXPECT_FALSE(law.adhesion);
}

class EveryLaw : public ::testing::TestWithParam<LawChoice> {
 protected:
  const LawChoice law = GetParam();
  Random random{7};
};

TEST_P(EveryLaw, HasTheDerivativesThatDualsGiveInEveryBranch) {
  int sticking = 0;
  int sliding = 0;
  int pulling = 0;
  int idle = 0;
  for (int i = 0; i < 3000; ++i) {
    const Touch at = random_touch(random);
    const PointForce<double> force = force_of(law, at);
    sticking += force.sticks ? 1 : 0;
    sliding += !force.sticks && force.friction > 0.0 ? 1 : 0;
    pulling += force.normal < 0.0 ? 1 : 0;
    idle += force.normal == 0.0 ? 1 : 0;
    const MatrixXd exact = by_duals(law, at);
    if (largest(exact) == 0.0) {
      EXPECT_EQ(largest(jacobian_of(law, at)), 0.0);
    } else {
      EXPECT_LT(relative_gap(jacobian_of(law, at), exact), 1e-13) << "state " << i;
    }
  }
  EXPECT_GT(sticking, 100);
  EXPECT_GT(sliding, 100);
  EXPECT_GT(law.adhesion ? pulling : idle, 100);
  EXPECT_EQ(law.adhesion ? idle : pulling, 0);
}

TEST_P(EveryLaw, HasARemainderOfSecondOrder) {
  for (int i = 0; i < 20; ++i) {
    const Touch at = random_touch(random);
    const VectorXd x = at.inputs();
    const VectorXd direction = random.vector(kInputs, 0.1);
    const Vector3d z = random.vector3();
    const Vector3d slope = jacobian_of(law, at) * direction;
    const auto along = [&](double e) { return z.dot(force_at<double>(law, x + e * direction)); };
    if (force_of(law, at).normal > 0.1 && std::abs(z.dot(slope)) > 1e-2) {
      // Small enough to stay in a branch.
      EXPECT_NEAR(testing::taylor_slope(along, z.dot(slope), 1e-2), 2.0, 0.1) << "state " << i;
    }
  }
}

TEST_P(EveryLaw, IsFiniteAndRightExactlyAtRest) {
  for (int i = 0; i < 200; ++i) {
    Touch at = random_touch(random);
    const int axis = i % 3;
    at.n = Vector3d::Unit(axis);
    at.u = random.between(-2.0, 2.0) * at.n;
    ASSERT_EQ(at.sliding(), Vector3d::Zero());
    const PointForce<double> force = force_of(law, at);
    EXPECT_EQ(force.friction, 0.0);
    EXPECT_EQ(force.f, force.normal * at.n);
    const MatrixXd jacobian = jacobian_of(law, at);
    ASSERT_TRUE(jacobian.allFinite());
    // Friction resists the first motion by s k_t, or by the smooth law's greatest slope.
    const double scale = law.normal == NormalLaw::kLinear ? 1.0 : at.k.scale;
    const double bound = law.normal == NormalLaw::kLinear ? at.k.mu * at.k.kn * -at.d
                                                          : at.k.mu * std::abs(force.normal);
    const bool idle = !law.adhesion && force.normal == 0.0;
    const double resistance = idle                                   ? 0.0
                              : law.friction == FrictionLaw::kSmooth ? bound / kWidth
                                                                     : scale * at.k.kt;
    const int side = (axis + 1) % 3;
    EXPECT_NEAR(jacobian(side, 4 + side), -resistance, 1e-14 * (1.0 + resistance));
    const MatrixXd exact = by_duals(law, at);
    EXPECT_LT(largest((jacobian - exact).eval()), 1e-13 * (1.0 + largest(exact)));
  }
}

TEST_P(EveryLaw, IsFiniteAndOneSidedWhereItGrazes) {
  for (int i = 0; i < 400; ++i) {
    Touch at = random_touch(random);
    if (i % 4 == 0) {
      at.u = random.between(-2.0, 2.0) * at.n;
    }
    at.d = 0.0;
    const PointForce<double> force = force_of(law, at);
    if (law.normal == NormalLaw::kDocument) {
      EXPECT_EQ(force.f, Vector3d::Zero());
      EXPECT_EQ(force.friction, 0.0);
    }
    const MatrixXd grazing = jacobian_of(law, at);
    ASSERT_TRUE(grazing.allFinite());
    if (at.sliding().norm() < 1e-9) {
      continue;  // at rest there is no side to take
    }
    at.d = -1e-14;
    const MatrixXd inside = jacobian_of(law, at);
    EXPECT_LT(largest((grazing - inside).eval()), 1e-12) << "state " << i;
  }
}

TEST_P(EveryLaw, IsFrictionlessWithoutFriction) {
  for (int i = 0; i < 200; ++i) {
    Touch at = random_touch(random);
    at.k.mu = 0.0;
    if (i % 4 == 0) {
      at.u = Vector3d::Zero();
    }
    if (i % 4 == 1) {
      at.k.kt = 0.0;
    }
    const PointForce<double> force = force_of(law, at);
    EXPECT_EQ(force.friction, 0.0);
    EXPECT_LT((force.f - force.normal * at.n).norm(), 1e-15);
    const MatrixXd jacobian = jacobian_of(law, at);
    ASSERT_TRUE(jacobian.allFinite());
    EXPECT_LT(largest((jacobian - by_duals(law, at)).eval()), 1e-13);
  }
}

TEST_P(EveryLaw, KeepsToItsConeAndOpposesSliding) {
  // Along an axis, so that the tangential part of f is exact.
  for (int i = 0; i < 1000000; ++i) {
    Touch at = random_touch(random);
    const int axis = i % 3;
    at.n = (i % 2 == 0 ? 1.0 : -1.0) * Vector3d::Unit(axis);
    const PointForce<double> force = force_of(law, at);
    Vector3d friction = force.f;
    friction[axis] = 0.0;
    const double bound = law.normal == NormalLaw::kLinear ? at.k.mu * at.k.kn * -at.d
                                                          : at.k.mu * std::abs(force.normal);
    const double size = friction.norm();
    const double along = friction.dot(at.sliding());
    const bool holds = size <= bound * (1.0 + 1e-14) &&
                       std::abs(size - force.friction) <= 1e-14 * size &&
                       along <= -size * at.sliding().norm() * (1.0 - 1e-14);
    ASSERT_TRUE(holds) << "state " << i << ": " << size << ' ' << bound << ' ' << along;
  }
}

TEST_P(EveryLaw, ReportsTheNormOfTheTangentialForce) {
  for (int i = 0; i < 3000; ++i) {
    const Touch at = random_touch(random);
    const PointForce<double> force = force_of(law, at);
    const Vector3d friction = force.f - at.n.dot(force.f) * at.n;
    EXPECT_NEAR(at.n.dot(force.f), force.normal, 1e-14 * (1.0 + force.f.norm()));
    EXPECT_NEAR(friction.norm(), force.friction, 1e-14 * (1.0 + force.f.norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, ::testing::ValuesIn(every_law()), law_name);

TEST(CoulombFriction, IsContinuousWhereStickingTurnsIntoSliding) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    Touch at = random_touch(random);
    at.k.kt += 0.1;
    const PointForce<double> force = force_of({}, at);
    const Vector3d along = at.sliding().normalized();
    const double turn = at.k.mu * std::abs(force.normal) / (at.k.scale * at.k.kt);
    const Vector3d normal_part = at.n.dot(at.u) * at.n;
    at.u = normal_part + turn * (1.0 - 1e-9) * along;
    const PointForce<double> below = force_of({}, at);
    at.u = normal_part + turn * (1.0 + 1e-9) * along;
    const PointForce<double> above = force_of({}, at);
    EXPECT_TRUE(below.sticks);
    EXPECT_FALSE(above.sticks);
    EXPECT_LT((above.f - below.f).norm(), 1e-8 * (1.0 + below.f.norm()));
  }
}

TEST(SmoothLaw, HasAContinuousSlopeThroughRest) {
  Random random(4);
  const LawChoice law = {.friction = FrictionLaw::kSmooth, .friction_width = kWidth};
  for (int i = 0; i < 300; ++i) {
    Touch at = random_touch(random);
    const Vector3d along = at.sliding().normalized();
    const Vector3d still = at.n.dot(at.u) * at.n;
    const double bound = at.k.mu * std::abs(force_of(law, at).normal);
    at.u = still;
    const Vector3d f0 = force_of(law, at).f;
    const MatrixXd at_rest = jacobian_of(law, at);
    for (const double t : {-1e-3, -1e-6, -1e-9, 1e-9, 1e-6, 1e-3}) {
      at.u = still + t * along;
      // The value moves by bound t / width; the slope by 3/2 bound t² / width³ at most, plus what
      // the cone's growth with ḋ and d adds along the new direction: t / width of it.
      const Vector3d df = force_of(law, at).f - f0;
      EXPECT_LT((df + bound * t / kWidth * along).norm(),
                bound * t * t / kWidth + 1e-14 * f0.norm() + 1e-14);
      EXPECT_LT(largest((jacobian_of(law, at) - at_rest).eval()), 200.0 * std::abs(t) + 1e-12);
    }
  }
}

TEST(PushingOnly, NeverPullsAndLetsGoContinuously) {
  Random random(5);
  for (const NormalLaw normal : {NormalLaw::kDocument, NormalLaw::kLinear}) {
    const LawChoice law = {.normal = normal, .adhesion = false};
    for (int i = 0; i < 20000; ++i) {
      Touch at = random_touch(random);
      at.k.damping += 0.1;
      EXPECT_GE(force_of(law, at).normal, 0.0);
      // ḋ at which f_n vanishes.
      const double release =
          normal == NormalLaw::kLinear ? -at.k.kn * at.d / at.k.damping : at.k.kn / at.k.damping;
      const Vector3d sliding = at.sliding();
      at.u = sliding + (release - 1e-9) * at.n;
      const PointForce<double> before = force_of(law, at);
      at.u = sliding + (release + 1e-9) * at.n;
      const PointForce<double> after = force_of(law, at);
      EXPECT_GT(before.normal, 0.0);
      EXPECT_LT(before.normal, 1e-7);
      EXPECT_EQ(after.f, Vector3d::Zero());
      // The linear law's friction follows depth, not f_n: it stops at once.
      if (normal == NormalLaw::kDocument) {
        EXPECT_LT(before.friction, 1e-7);
      }
    }
  }
}

}  // namespace
}  // namespace hbar
