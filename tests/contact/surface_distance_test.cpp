#include "hbar/contact/surface_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "tests/support/duals.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::kNan;
using testing::largest;
using testing::Random;
using testing::relative_gap;

/// φ = (xᵀ A x − 1) / 2 + (b·x)³ / 6: no distance, with all three derivatives.
class CubicField final : public DistanceField {
 public:
  [[nodiscard]] double lower_bound(const Vector3d& x) const override {
    return 0.5 * (x.dot(A_ * x) - 1.0) + std::pow(b_.dot(x), 3) / 6.0;
  }
  [[nodiscard]] Sample sample(const Vector3d& x) const override {
    const double along = b_.dot(x);
    return {lower_bound(x), A_ * x + 0.5 * along * along * b_, A_ + along * b_ * b_.transpose()};
  }
  [[nodiscard]] Matrix3d hessian_slope(const Vector3d&, const Vector3d& direction) const override {
    return b_.dot(direction) * b_ * b_.transpose();
  }

 private:
  const Matrix3d A_ = Vector3d(1.0, 0.7, 1.4).asDiagonal();
  const Vector3d b_ = {0.5, -0.8, 0.4};
};

/// A surface, and what is known of it in other words.
struct Solid {
  std::string name;
  ContactSurface surface;
  Shape shape;
  int sizes = 0;
  std::function<bool(const Vector3d&)> inside;  ///< null: not a body
};

void PrintTo(const Solid& solid, std::ostream* out) { *out << solid.name; }
std::string solid_name(const ::testing::TestParamInfo<Solid>& info) { return info.param.name; }

std::vector<Solid> every_solid() {
  const Vector3d normal = Vector3d(0.6, 0.0, 0.8);
  const auto within_capsule = [](const Vector3d& x) {
    const Vector3d nearest(0.0, 0.0, std::clamp(x.z(), -0.75, 0.75));
    return (x - nearest).norm() < 0.6;
  };
  return {
      {"Cuboid", OwnShape{}, Cuboid{{1.0, 1.6, 2.2}}, 3,
       [](const Vector3d& x) { return (x.cwiseAbs() - Vector3d(0.5, 0.8, 1.1)).maxCoeff() < 0.0; }},
      {"Sphere", OwnShape{}, Sphere{0.9}, 1, [](const Vector3d& x) { return x.norm() < 0.9; }},
      {"Cylinder", OwnShape{}, Cylinder{0.7, 1.5}, 2,
       [](const Vector3d& x) { return x.head<2>().norm() < 0.7 && std::abs(x.z()) < 0.75; }},
      {"Capsule", OwnShape{}, Capsule{0.6, 1.5}, 2, within_capsule},
      {"Tube", OwnShape{.caps = false}, Cylinder{0.7, 1.5}, 2, {}},
      {"Plane", Plane{{0.1, 0.2, 0.3}, normal}, NoShape{}, 0, {}},
      {"Field", std::make_shared<const CubicField>(), NoShape{}, 0, {}},
  };
}

class EverySurface : public ::testing::TestWithParam<Solid> {
 protected:
  VectorXd sizes() const {
    VectorXd out = VectorXd::Constant(3, kNan);
    const std::vector<double> listed = sizes_of(solid.shape);
    for (std::size_t k = 0; k < listed.size(); ++k) {
      out[static_cast<Eigen::Index>(k)] = listed[k];
    }
    return out;
  }
  template <Scalar S>
  SurfaceDistance<S> distance(const VectorX<S>& with) const {
    return {solid.surface, solid.shape, with};
  }
  /// φ, ∇φ, n and ∂n/∂x, one after another.                                           [16]
  template <Scalar S>
  VectorX<S> sample(const VectorX<S>& x, const VectorX<S>& with) const {
    const SurfaceSample<S> at = distance<S>(with).sample(x);
    VectorX<S> out(16);
    out << at.d, at.gradient, at.n, at.dn_dx.reshaped();
    return out;
  }
  VectorXd sample(const VectorXd& x) const { return sample<double>(x, sizes()); }

  /// A point of the box [−1.5, 1.5]³ that is not next to an edge of the distance: there,
  /// derivatives differ on both sides.
  Vector3d smooth_point(bool inside) {
    for (;;) {
      const Vector3d x = random.vector3(1.5);
      if (inside && distance<double>(sizes()).lower_bound(x) >= 0.0) {
        continue;
      }
      const Vector3d n = distance<double>(sizes()).sample(x).n;
      bool smooth = true;
      for (int k = 0; k < 60; ++k) {
        const Vector3d near = x + 0.02 * random.direction();
        smooth = smooth && (distance<double>(sizes()).sample(near).n - n).norm() < 0.3;
      }
      const bool at_cap =
          solid.name == "Capsule" && std::abs(std::abs(x.z()) - 0.75) < 0.02;  // n has a corner
      if (smooth && !at_cap) {
        return x;
      }
    }
  }

  const Solid solid = GetParam();
  const SurfaceDistance<double> surface = distance<double>(sizes());
  Random random{11};
};

TEST_P(EverySurface, HasAUnitNormalAlongItsGradient) {
  for (int i = 0; i < 500; ++i) {
    const SurfaceSample<double> at = surface.sample(random.vector3(1.5));
    EXPECT_NEAR(at.n.norm(), 1.0, 1e-15);
    EXPECT_LT(largest((at.n * at.gradient.norm() - at.gradient).eval()), 1e-15 * 4.0);
    // A unit vector stays one.
    EXPECT_LT(largest((at.n.transpose() * at.dn_dx).eval()), 1e-14);
    if (solid.name != "Field") {
      EXPECT_EQ(at.n, at.gradient);
      EXPECT_LT(largest((at.dn_dx - at.dn_dx.transpose()).eval()), 1e-15);
    }
  }
}

TEST_P(EverySurface, HasTheGradientAndCurvatureThatDifferencesGive) {
  for (int i = 0; i < 100; ++i) {
    const Vector3d x = smooth_point(i % 2 == 0);
    const SurfaceSample<double> at = surface.sample(x);
    const MatrixXd expected =
        testing::differences([&](const VectorXd& y) { return sample(y); }, x, 1e-3);
    EXPECT_LT(largest((at.gradient.transpose() - expected.row(0)).eval()), 1e-8) << x.transpose();
    EXPECT_LT(largest((at.dn_dx - expected.middleRows(4, 3)).eval()), 1e-5) << x.transpose();
  }
}

TEST_P(EverySurface, CarriesTheSlopesOfDuals) {
  for (int i = 0; i < 100; ++i) {
    const Vector3d x = smooth_point(i % 2 == 0);
    const SurfaceSample<double> at = surface.sample(x);
    const VectorX<Dual> constant = sizes().cast<Dual>();
    const MatrixXd duals = testing::dual_jacobian(
        [&](const VectorX<Dual>& y) { return sample<Dual>(y, constant); }, x);
    EXPECT_LT(largest((duals.row(0) - at.gradient.transpose()).eval()), 1e-14);
    EXPECT_LT(largest((duals.middleRows(4, 3) - at.dn_dx).eval()), 1e-13);
    // And of second derivatives, which duals alone have.
    const MatrixXd expected =
        testing::differences([&](const VectorXd& y) { return sample(y); }, x, 2e-4);
    EXPECT_LT(largest((duals - expected).eval()), 1e-5 * (1.0 + largest(expected)))
        << x.transpose();
  }
}

TEST_P(EverySurface, AnswersToItsSizesAsDualsAndResizingDo) {
  EXPECT_EQ(surface.size_count(), solid.sizes);
  const auto values = VectorXd(sizes().head(solid.sizes));
  for (int i = 0; i < 100; ++i) {
    const Vector3d x = smooth_point(i % 2 == 0);
    const auto resized = [&]<Scalar S>(const VectorX<S>& by) -> VectorX<S> {
      VectorX<S> with = sizes().cast<S>();
      with.head(solid.sizes) = by;
      return sample<S>(x.cast<S>(), with);
    };
    if (solid.sizes == 0) {
      EXPECT_EQ(surface.by_size(x, 0).d, 0.0);
      EXPECT_EQ(surface.by_size(x, 0).n, Vector3d::Zero());
      continue;
    }
    const MatrixXd duals =
        testing::dual_jacobian([&](const VectorX<Dual>& by) { return resized(by); }, values);
    const MatrixXd differences =
        testing::differences([&](const VectorXd& by) { return resized(by); }, values, 1e-3);
    for (int k = 0; k < solid.sizes; ++k) {
      const SizeRate<double> rate = surface.by_size(x, k);
      EXPECT_NEAR(rate.d, duals(0, k), 1e-15);
      EXPECT_LT(largest((rate.n - duals.block<3, 1>(4, k)).eval()), 1e-13);
      EXPECT_NEAR(rate.d, differences(0, k), 1e-9);
      EXPECT_LT(largest((rate.n - differences.block<3, 1>(4, k)).eval()), 1e-5);
    }
  }
}

TEST_P(EverySurface, BoundsItsDistanceFromBelow) {
  int inside = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d x = random.vector3(1.5);
    const double bound = surface.lower_bound(x);
    const bool end_of_tube = solid.name == "Tube" && std::abs(x.z()) > 0.75;
    if (bound <= 0.0) {
      ++inside;
      EXPECT_NEAR(bound, surface.sample(x).d, 1e-15);
      EXPECT_EQ(surface.touches(bound), bound < 0.0 || solid.name == "Plane");
    } else if (!end_of_tube) {
      EXPECT_GT(surface.sample(x).d, 0.0);
      EXPECT_FALSE(surface.touches(bound));
    }
    if (solid.inside) {
      EXPECT_EQ(solid.inside(x), bound < 0.0) << x.transpose();
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_EQ(surface.is_plane(), solid.name == "Plane");
  EXPECT_EQ(surface.touches(0.0), solid.name == "Plane");
}

TEST_P(EverySurface, IsFiniteAtItsCentreAndOnItsAxes) {
  for (const Vector3d& x : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.0, 0.0, 0.1),
                            Vector3d(0.0, 0.0, 0.75), Vector3d(0.3, 0.0, 0.0)}) {
    const VectorXd at = sample(x);
    EXPECT_TRUE(at.allFinite());
    EXPECT_NEAR(at.segment<3>(4).norm(), 1.0, 1e-15);
    for (int k = 0; k < solid.sizes; ++k) {
      EXPECT_TRUE(std::isfinite(surface.by_size(x, k).d));
    }
    const VectorX<Dual> moved = testing::with_slope(x, Vector3d(1.0, 2.0, 3.0));
    const VectorX<Dual> constant = sizes().cast<Dual>();
    EXPECT_TRUE(testing::slopes(sample<Dual>(moved, constant)).allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, EverySurface, ::testing::ValuesIn(every_solid()), solid_name);

/// The bodies: of these the distance is exact, inside and outside.
class EveryBody : public EverySurface {};

TEST_P(EveryBody, HasItsNearestSurfacePointAlongTheNormal) {
  // Points of the surface: where rays from the centre leave the solid.
  std::vector<Vector3d> skin;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d ray = random.direction();
    double inner = 0.0;
    double outer = 3.0;
    while (outer - inner > 1e-13) {
      const double middle = 0.5 * (inner + outer);
      (solid.inside(middle * ray) ? inner : outer) = middle;
    }
    skin.push_back(inner * ray);
  }
  int within = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d x = random.vector3(i % 2 == 0 ? 0.9 : 2.5);
    within += solid.inside(x) ? 1 : 0;
    const SurfaceSample<double> at = surface.sample(x);
    EXPECT_EQ(at.d < 0.0, solid.inside(x));
    const Vector3d foot = x - at.d * at.n;
    EXPECT_FALSE(solid.inside(foot + 1e-9 * at.n));
    EXPECT_TRUE(solid.inside(foot - 1e-9 * at.n));
    for (const Vector3d& y : skin) {
      ASSERT_GE((y - x).norm(), std::abs(at.d) - 1e-12);
    }
  }
  EXPECT_GT(within, 150);
}

TEST_P(EveryBody, HasNothingInsideNearerThanItsLowerBound) {
  std::vector<Vector3d> points;
  while (points.size() < 2000) {
    const Vector3d y = random.vector3(1.4);
    if (solid.inside(y)) {
      points.push_back(y);
    }
  }
  for (int i = 0; i < 500; ++i) {
    const Vector3d x = random.vector3(4.0);
    const double bound = surface.lower_bound(x);
    for (const Vector3d& y : points) {
      ASSERT_GT((x - y).norm(), bound);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, EveryBody, ::testing::ValuesIn([] {
                           std::vector<Solid> bodies = every_solid();
                           std::erase_if(bodies, [](const Solid& s) { return !s.inside; });
                           return bodies;
                         }()),
                         solid_name);

SurfaceDistance<double> surface_of(const ContactSurface& surface, const Shape& shape,
                                   const Vector3d& sizes) {
  return {surface, shape, sizes};
}

TEST(SurfaceDistance, HasTheValuesThatAreWorkedOutByHand) {
  const auto cuboid = surface_of(OwnShape{}, Cuboid{}, {2.0, 4.0, 6.0});
  EXPECT_DOUBLE_EQ(cuboid.sample({0.2, -1.7, 1.0}).d, -0.3);
  EXPECT_EQ(cuboid.sample({0.2, -1.7, 1.0}).n, Vector3d(0.0, -1.0, 0.0));
  const auto ball = surface_of(OwnShape{}, Sphere{}, {2.0, kNan, kNan});
  EXPECT_DOUBLE_EQ(ball.sample({0.0, 0.6, 0.8}).d, -1.0);
  EXPECT_EQ(ball.sample({0.0, 0.6, 0.8}).n, Vector3d(0.0, 0.6, 0.8));
  EXPECT_LT(relative_gap(ball.sample({0.5, 0.0, 0.0}).dn_dx,
                         Matrix3d(Vector3d(0.0, 2.0, 2.0).asDiagonal())),
            1e-15);
  const auto capsule = surface_of(OwnShape{}, Capsule{}, {1.0, 4.0, kNan});
  EXPECT_DOUBLE_EQ(capsule.sample({0.3, 0.0, 2.4}).d, -0.5);
  EXPECT_LT(relative_gap(capsule.sample({0.3, 0.0, 2.4}).n, Vector3d(0.6, 0.0, 0.8)), 1e-15);
  EXPECT_EQ(capsule.sample({0.0, 0.5, -1.0}).n, Vector3d::UnitY());
  const auto plane = surface_of(Plane{{0.0, 0.0, 3.0}, {0.0, 0.6, 0.8}}, NoShape{}, {});
  EXPECT_DOUBLE_EQ(plane.sample({7.0, 1.0, 4.0}).d, 1.4);
  EXPECT_DOUBLE_EQ(plane.lower_bound({7.0, 1.0, 4.0}), 1.4);
  EXPECT_EQ(plane.sample({7.0, 1.0, 4.0}).dn_dx, Matrix3d::Zero());
}

TEST(SurfaceDistance, OfACylinderCountsItsEndFacesUnlessToldNotTo) {
  const Vector3d x(0.3, 0.4, 0.9);
  const auto closed = surface_of(OwnShape{}, Cylinder{}, {1.0, 2.0, kNan});
  EXPECT_DOUBLE_EQ(closed.sample(x).d, -0.1);
  EXPECT_EQ(closed.sample(x).n, Vector3d::UnitZ());
  const auto open = surface_of(OwnShape{.caps = false}, Cylinder{}, {1.0, 2.0, kNan});
  EXPECT_DOUBLE_EQ(open.sample(x).d, -0.5);
  EXPECT_LT(relative_gap(open.sample(x).n, Vector3d(0.6, 0.8, 0.0)), 1e-15);
  EXPECT_DOUBLE_EQ(open.lower_bound(x), -0.5);
  // It ends where the cylinder does.
  EXPECT_GT(open.lower_bound({0.3, 0.4, 1.1}), 0.0);
}

TEST(SurfaceDistance, NormalisesTheGradientOfAField) {
  const CubicField field;
  const auto surface =
      surface_of(std::shared_ptr<const DistanceField>(&field, [](const auto*) {}), NoShape{}, {});
  const Vector3d x(0.3, -0.2, 0.4);
  EXPECT_EQ(surface.sample(x).d, field.sample(x).distance);
  EXPECT_EQ(surface.sample(x).gradient, field.sample(x).gradient);
  EXPECT_LT(relative_gap(surface.sample(x).n, field.sample(x).gradient.normalized()), 1e-15);
  EXPECT_EQ(field.sample(Vector3d::Zero()).gradient, Vector3d::Zero());
  EXPECT_EQ(surface.sample(Vector3d::Zero()).n.norm(), 1.0);
}

TEST(SurfaceDistance, RefusesABodyWithoutAShape) {
  EXPECT_EQ(testing::message_of<InvalidInput>(
                [] { static_cast<void>(surface_of(OwnShape{}, NoShape{}, {})); }),
            "contact: the other body has no shape of its own");
}

}  // namespace
}  // namespace hbar
