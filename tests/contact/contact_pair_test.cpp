#include "hbar/contact/contact_pair.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/support/duals.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::largest;
using testing::Random;
using testing::relative_gap;

using Wrench = Vector6<double>;

/// A contact whose points are inside, and what moves it.
struct Scene {
  Contact contact;
  Shape other = NoShape{};
  LawNumbers<double> k;
  PairMotion<double> motion;
  std::vector<Vector3d> points;  ///< on A; a ball's centre
  double radius = 0.0;           ///< of that ball; 0: contact points
};

constexpr int kSurfaces = 11;

/// Pairs by number: points in a cuboid, a ball, a cylinder, a capsule, below a plane, in a field;
/// then a ball against the first five.
Scene random_scene(int surface, Reaction reaction, Random& random) {
  const std::vector<Shape> shapes = {Cuboid{{3.0, 3.5, 4.0}}, Sphere{2.0}, Cylinder{2.0, 4.0},
                                     Capsule{1.5, 2.0}};
  Scene scene;
  scene.contact.reaction = reaction;
  scene.contact.friction_law =
      random.between(0.0, 1.0) < 0.5 ? FrictionLaw::kDocument : FrictionLaw::kSmooth;
  scene.contact.friction_width = 0.5;
  const bool ball = surface > 5;
  const int kind = ball ? surface - 6 : surface;
  if (kind < 4) {
    scene.other = shapes[static_cast<std::size_t>(kind)];
  } else if (kind == 4) {
    scene.contact.surface = Plane{random.vector3(0.2), random.direction()};
  } else {
    scene.contact.surface =
        std::make_shared<const testing::QuadricField>(Vector3d(1.0, 0.7, 1.4).asDiagonal(), 2.5);
  }
  scene.k = {random.between(1.0, 5.0), random.between(0.2, 1.0), random.between(0.2, 1.0),
             random.between(0.1, 1.0), random.between(0.5, 2.0)};
  const auto body = [&random]() -> BodyMotion<double> {
    return {testing::random_pose(random), random.vector(6, 2.0)};
  };
  scene.motion = {body(), body()};
  scene.radius = ball ? 0.8 : 0.0;
  // Points in A's frame that lie within B.
  const auto& motion = scene.motion;
  const RigidTransform<double> X_AB = inverse(motion.a.X_WB) * motion.b.X_WB;
  const std::vector<double> listed = sizes_of(scene.other);
  Vector3d present = Vector3d::Zero();
  std::copy(listed.begin(), listed.end(), present.begin());
  const SurfaceDistance<double> distance(scene.contact.surface, scene.other, present);
  while (scene.points.size() < 3) {
    // A ball's centre may be outside, and beside a corner.
    const Vector3d x_B = random.vector3(ball ? 3.0 : 1.4);
    const double d = distance.sample(x_B).d - scene.radius;
    if (d < -0.05 && (!ball || d > -1.5)) {
      scene.points.push_back(X_AB.R * x_B + X_AB.p);
    }
  }
  return scene;
}

/// The scene's numbers, to be moved.
template <Scalar S>
struct Numbers {
  explicit Numbers(const Scene& scene) : points(scene.points.size()) {
    const LawNumbers<double>& n = scene.k;
    k = {S(n.kn), S(n.kt), S(n.mu), S(n.damping), S(n.scale)};
    const auto body = [](const BodyMotion<double>& b) -> BodyMotion<S> {
      return {{b.X_WB.R.cast<S>(), b.X_WB.p.cast<S>()}, b.V.cast<S>()};
    };
    motion = {body(scene.motion.a), body(scene.motion.b)};
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = scene.points[i].cast<S>();
    }
    const std::vector<double> listed = sizes_of(scene.other);
    std::copy(listed.begin(), listed.end(), sizes.begin());
    radius = S(scene.radius);
  }
  LawNumbers<S> k;
  PairMotion<S> motion;
  std::vector<Vector3<S>> points;
  Vector3<S> sizes = Vector3<S>::Zero();
  S radius;
};

template <Scalar S>
SurfaceDistance<S> distance_of(const Scene& scene, const Numbers<S>& at) {
  return {scene.contact.surface, scene.other, at.sizes};
}

template <Scalar S>
std::vector<TouchingPoint<S>> touches(const Scene& scene, const Numbers<S>& at,
                                      TouchDetail how = TouchDetail::kDerivatives) {
  std::vector<TouchingPoint<S>> out(at.points.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int index = scene.radius > 0.0 ? -1 : static_cast<int>(i);
    compute_touch<S>(scene.contact, at.k, distance_of<S>(scene, at), at.motion, index, at.points[i],
                     at.radius, how, out[i]);
  }
  return out;
}

template <Scalar S>
PairWrenches<S> wrenches(const Scene& scene, const Numbers<S>& at) {
  PairWrenches<S> out;
  for (const TouchingPoint<S>& point : touches<S>(scene, at, TouchDetail::kForce)) {
    add_wrenches<S>(scene.contact.reaction, point, out);
  }
  return out;
}

PairStiffness<double> stiffness(const Scene& scene) {
  const Numbers<double> at(scene);
  PairStiffness<double> out;
  for (auto* matrix : {&out.K_a, &out.C_a, &out.K_b, &out.C_b}) {
    matrix->setZero();
  }
  out.E_a.setZero();
  out.E_b.setZero();
  for (const TouchingPoint<double>& point : touches<double>(scene, at)) {
    add_stiffness<double>(scene.contact.reaction, at.motion, point, out);
  }
  complete<double>(scene.contact.reaction, at.motion, out);
  return out;
}

/// Displaces a body along a world twist D, which carries its twist along, and adds Ψ̇ to that: what
/// a displacement column (doc/notation.md) does to everything that it moves.
void displace(BodyMotion<Dual>& body, const Wrench& D, const Wrench& psi_dot) {
  const Eigen::Matrix3d R = testing::values(body.X_WB.R);
  const Vector3d p = testing::values(body.X_WB.p);
  const Wrench V = testing::values(body.V);
  const Vector3d w = D.head<3>();
  body.X_WB.R = testing::with_slope(R, skew<double>(w) * R);
  body.X_WB.p = testing::with_slope(p, w.cross(p) + D.tail<3>());
  body.V = testing::with_slope(V, psi_dot + cross_twist<double>(D, V));
}

struct Case {
  int surface;
  Reaction reaction;
};

std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (int surface = 0; surface < kSurfaces; ++surface) {
    cases.push_back({surface, Reaction::kPoint});
    cases.push_back({surface, Reaction::kSurface});
  }
  return cases;
}

void PrintTo(const Case& at, std::ostream* out) { *out << at.surface; }

class EveryPair : public ::testing::TestWithParam<Case> {
 protected:
  static constexpr int kScenes = 40;
  Scene scene() { return random_scene(GetParam().surface, GetParam().reaction, random); }
  bool reacts_at_surface() const { return GetParam().reaction == Reaction::kSurface; }

  Random random{static_cast<unsigned>(GetParam().surface + 1)};
};

TEST_P(EveryPair, HasActionAndReaction) {
  for (int i = 0; i < kScenes; ++i) {
    const Scene at = scene();
    const PairWrenches<double> found = wrenches(at, Numbers<double>(at));
    const double scale = largest(found.on_a);
    ASSERT_GT(scale, 0.0);
    EXPECT_LT(largest((found.on_a + found.on_b).tail<3>().eval()), 1e-14 * scale);
    // Turning moments cancel where both bodies feel the same point; else the normal offset turns.
    Vector3d turning = Vector3d::Zero();
    if (reacts_at_surface()) {
      for (const TouchingPoint<double>& point : touches(at, Numbers<double>(at))) {
        turning += (point.d * point.n).cross(point.force.f);
      }
      EXPECT_GT(largest(turning), 0.0);
    }
    EXPECT_LT(
        largest((found.on_a + found.on_b - spatial<double>(turning, Vector3d::Zero())).eval()),
        1e-14 * scale * 4.0);
  }
}

TEST_P(EveryPair, ReadsItsPointAsTheBodiesMove) {
  for (int i = 0; i < kScenes; ++i) {
    const Scene at = scene();
    const BodyMotion<double>& a = at.motion.a;
    const BodyMotion<double>& b = at.motion.b;
    const Numbers<double> numbers(at);
    const auto distance = distance_of<double>(at, numbers);
    const auto found = touches<double>(at, numbers);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const TouchingPoint<double>& point = found[k];
      const Vector3d centre = a.X_WB.R * at.points[k] + a.X_WB.p;
      EXPECT_LT(relative_gap(point.lever, centre), 1e-14);
      EXPECT_LT(relative_gap(point.x, centre - at.radius * point.n), 1e-14);
      EXPECT_LT(relative_gap(point.x, b.X_WB.R * point.x_B + b.X_WB.p), 1e-14);
      const SurfaceSample<double> sample = distance.sample(point.lever_B);
      EXPECT_NEAR(point.d, sample.d - at.radius, 1e-14);
      EXPECT_LT(point.d, 0.0);
      EXPECT_LT(relative_gap(point.n, b.X_WB.R * sample.n), 1e-14);
      EXPECT_LT(relative_gap(point.gradient, b.X_WB.R * sample.gradient), 1e-14);
      // Material velocities: A's at x, B's at x or at its surface.
      const Vector3d x_B = reacts_at_surface() ? Vector3d(point.x - point.d * point.n) : point.x;
      const Vector3d v_A = a.V.tail<3>() + Vector3d(a.V.head<3>()).cross(point.x);
      const Vector3d v_B = b.V.tail<3>() + Vector3d(b.V.head<3>()).cross(x_B);
      const PointForce<double> force =
          contact_force<double>(law_of(at.contact), at.k, point.d, point.n, v_A - v_B);
      EXPECT_LT(largest((point.force.f - force.f).eval()), 1e-13 * (1.0 + largest(force.f)));
    }
  }
}

TEST_P(EveryPair, NeedsNoDerivativesForItsForce) {
  const Scene at = scene();
  const auto full = touches<double>(at, Numbers<double>(at));
  const auto bare = touches<double>(at, Numbers<double>(at), TouchDetail::kForce);
  for (std::size_t k = 0; k < full.size(); ++k) {
    EXPECT_EQ(full[k].force.f, bare[k].force.f);
    EXPECT_EQ(full[k].force.sticks, bare[k].force.sticks);
    EXPECT_EQ(full[k].x, bare[k].x);
    EXPECT_EQ(full[k].d, bare[k].d);
  }
}

TEST_P(EveryPair, HasTheStiffnessThatDualsGiveMovingEitherBodyOrBoth) {
  for (int i = 0; i < kScenes; ++i) {
    const Scene at = scene();
    const PairStiffness<double> k = stiffness(at);
    const PairWrenches<double> still = wrenches(at, Numbers<double>(at));
    for (int column = 0; column < 12; ++column) {
      // Unit displacements, then unit twists.
      const Wrench D = column < 6 ? Wrench(Wrench::Unit(column)) : Wrench(Wrench::Zero());
      const Wrench psi = column < 6 ? Wrench(Wrench::Zero()) : Wrench(Wrench::Unit(column - 6));
      for (const auto& [a, b] : {std::pair{true, false}, {false, true}, {true, true}}) {
        Numbers<Dual> moved(at);
        if (a) {
          displace(moved.motion.a, D, psi);
        }
        if (b) {
          displace(moved.motion.b, D, psi);
        }
        const PairWrenches<Dual> exact = wrenches(at, moved);
        const double sigma = (a ? 1.0 : 0.0) - (b ? 1.0 : 0.0);
        Wrench on_a = sigma * (k.K_a * D + k.C_a * psi - cross_wrench<double>(D, still.on_a));
        Wrench on_b = sigma * (k.K_b * D + k.C_b * psi);
        if (b) {
          on_a += k.E_a * psi.head<3>();
          on_b += k.E_b * psi.head<3>();
          on_b += cross_wrench<double>(D, still.on_b);
        }
        if (a) {
          on_a += cross_wrench<double>(D, still.on_a);
        }
        const double scale = 1.0 + largest(k.K_a) + largest(still.on_a);
        EXPECT_LT(largest((on_a - testing::slopes(exact.on_a)).eval()), 1e-13 * scale);
        EXPECT_LT(largest((on_b - testing::slopes(exact.on_b)).eval()), 1e-13 * scale);
      }
    }
  }
}

TEST_P(EveryPair, IsSymmetricUnlessItReactsAtASurface) {
  const PairStiffness<double> k = stiffness(scene());
  if (reacts_at_surface()) {
    EXPECT_GT(largest(k.E_a), 0.0);
    EXPECT_GT(largest(k.E_b), 0.0);
  } else {
    EXPECT_EQ(k.K_b, -k.K_a);
    EXPECT_EQ(k.C_b, -k.C_a);
    EXPECT_EQ(largest(k.E_a), 0.0);
    EXPECT_EQ(largest(k.E_b), 0.0);
  }
}

/// Σ over the points of wrench_change by what `change` gives each.                       [12]
template <typename Change>
VectorXd changes(const Scene& scene, const Change& change) {
  const Numbers<double> at(scene);
  VectorXd out = VectorXd::Zero(12);
  for (const TouchingPoint<double>& point : touches<double>(scene, at)) {
    const PairWrenches<double> by =
        wrench_change<double>(scene.contact.reaction, at.motion, point, change(point));
    out.head<6>() += by.on_a;
    out.tail<6>() += by.on_b;
  }
  return out;
}

void expect_slopes(const VectorXd& found, const PairWrenches<Dual>& exact) {
  VectorXd expected(12);
  expected << testing::slopes(exact.on_a), testing::slopes(exact.on_b);
  EXPECT_LT(largest((found - expected).eval()), 1e-13 * (1.0 + largest(expected)));
}

TEST_P(EveryPair, AnswersToItsPointsAsDualsDo) {
  for (int i = 0; i < kScenes; ++i) {
    const Scene at = scene();
    const Vector3d step = random.vector3();
    Numbers<Dual> moved(at);
    for (std::size_t k = 0; k < at.points.size(); ++k) {
      moved.points[k] = testing::with_slope(at.points[k], step);
    }
    const Vector3d in_world = at.motion.a.X_WB.R * step;
    expect_slopes(changes(at, [&](const auto&) { return PointChange<double>{.x = in_world}; }),
                  wrenches(at, moved));
  }
}

TEST_P(EveryPair, AnswersToItsCoefficientsAsDualsDo) {
  for (int i = 0; i < kScenes; ++i) {
    const Scene at = scene();
    for (std::size_t k = 0; k < 4; ++k) {
      Numbers<Dual> moved(at);
      Dual* const numbers[] = {&moved.k.kn, &moved.k.kt, &moved.k.mu, &moved.k.damping};
      numbers[k]->slope = 1.0;
      expect_slopes(changes(at,
                            [k](const auto& point) {
                              return PointChange<double>{.f = point.law.by_coefficient[k]};
                            }),
                    wrenches(at, moved));
    }
    Numbers<Dual> moved(at);
    moved.k.scale.slope = 1.0;
    expect_slopes(
        changes(at, [](const auto& point) { return PointChange<double>{.f = point.law.by_scale}; }),
        wrenches(at, moved));
  }
}

TEST_P(EveryPair, AnswersToSizesAsDualsDo) {
  for (int i = 0; i < kScenes; ++i) {
    const Scene at = scene();
    const auto distance = distance_of<double>(at, Numbers<double>(at));
    for (int size = 0; size < distance.size_count(); ++size) {
      Numbers<Dual> moved(at);
      moved.sizes[size].slope = 1.0;
      const auto by_size = [&](const TouchingPoint<double>& point) {
        const SizeRate<double> rate = distance.by_size(point.lever_B, size);
        const Vector3d n = at.motion.b.X_WB.R * rate.n;
        return PointChange<double>{.place = -at.radius * n, .d = rate.d, .n = n};
      };
      expect_slopes(changes(at, by_size), wrenches(at, moved));
    }
    if (at.radius > 0.0) {
      Numbers<Dual> moved(at);
      moved.radius.slope = 1.0;
      expect_slopes(changes(at,
                            [](const auto& point) {
                              return PointChange<double>{.place = -point.n, .d = -1.0};
                            }),
                    wrenches(at, moved));
    }
  }
  EXPECT_EQ(scene().points.size(), 3U);
}

INSTANTIATE_TEST_SUITE_P(Pairs, EveryPair, ::testing::ValuesIn(every_case()));

}  // namespace
}  // namespace hbar
