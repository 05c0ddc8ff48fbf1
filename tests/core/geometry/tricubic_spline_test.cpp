#include "hbar/core/geometry/tricubic_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

const GridNodes kNodes = {{-0.3, 0.2, 1.0}, 0.25, {6, 4, 9}};

template <typename Function>
std::vector<double> values_of(const GridNodes& nodes, const Function& function) {
  std::vector<double> values;
  for (int k = 0; k < nodes.count.z(); ++k) {
    for (int j = 0; j < nodes.count.y(); ++j) {
      for (int i = 0; i < nodes.count.x(); ++i) {
        values.push_back(function(nodes.point(i, j, k)));
      }
    }
  }
  return values;
}

std::vector<double> random_values(const GridNodes& nodes, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  return values_of(nodes, [&](const Eigen::Vector3d&) { return normal(engine); });
}

/// A point from `beyond` spacings outside one end of every axis to as many outside the other.
Eigen::Vector3d random_point(std::mt19937& engine, const GridNodes& nodes, double beyond) {
  std::uniform_real_distribution<double> fraction(0.0, 1.0);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(beyond * nodes.spacing);
  const Eigen::Vector3d from = nodes.origin - margin;
  const Eigen::Vector3d to = nodes.last() + margin;
  const Eigen::Vector3d t = Eigen::Vector3d::NullaryExpr([&] { return fraction(engine); });
  return from.array() + t.array() * (to - from).array();
}

std::string refusal(const GridNodes& nodes, std::size_t values) {
  try {
    const auto spline = TricubicSpline::through(nodes, std::vector<double>(values));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TricubicSpline, PassesThroughItsValues) {
  const std::vector<double> values = random_values(kNodes, 1);
  const TricubicSpline spline = TricubicSpline::through(kNodes, values);
  auto value = values.begin();
  for (int k = 0; k < kNodes.count.z(); ++k) {
    for (int j = 0; j < kNodes.count.y(); ++j) {
      for (int i = 0; i < kNodes.count.x(); ++i) {
        EXPECT_NEAR(spline.value(kNodes.point(i, j, k)), *value++, 1e-13);
      }
    }
  }
}

TEST(TricubicSpline, IsExactForCubicPolynomials) {
  const auto cubic = [](const Eigen::Vector3d& p) {
    const double x = p.x();
    const double y = p.y();
    const double z = p.z();
    return (1.0 + x * x * x) * (y - 2.0 * y * y * y) * (z * z * z - z * z) + 3.0 * x * x * y;
  };
  const TricubicSpline spline = TricubicSpline::through(kNodes, values_of(kNodes, cubic));
  std::mt19937 engine(2);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = random_point(engine, kNodes, 0.0);
    const auto jet = spline.jet(p);
    const double x = p.x();
    const double y = p.y();
    const double z = p.z();
    EXPECT_NEAR(jet.value, cubic(p), 1e-11);
    EXPECT_NEAR(spline.value(p), jet.value, 1e-13);
    EXPECT_NEAR(jet.gradient.x(),
                3.0 * x * x * (y - 2.0 * y * y * y) * (z * z * z - z * z) + 6.0 * x * y, 1e-10);
    EXPECT_NEAR(jet.hessian(1, 2),
                (1.0 + x * x * x) * (1.0 - 6.0 * y * y) * (3.0 * z * z - 2.0 * z), 1e-9);
    EXPECT_NEAR(spline.hessian_slope(p, Eigen::Vector3d::UnitZ())(2, 2),
                6.0 * (1.0 + x * x * x) * (y - 2.0 * y * y * y), 1e-8);
  }
}

TEST(TricubicSpline, ConvergesWithOrderFourThreeTwo) {
  const auto wave = [](const Eigen::Vector3d& p) {
    return std::sin(2.0 * p.x() + 1.0) * std::cos(p.y()) * std::exp(p.z());
  };
  Eigen::Vector3d coarse;
  for (const int cells : {16, 32}) {
    const GridNodes nodes = {{0.0, 0.0, 0.0}, 1.0 / cells, Eigen::Vector3i::Constant(cells + 1)};
    const TricubicSpline spline = TricubicSpline::through(nodes, values_of(nodes, wave));
    std::mt19937 engine(3);
    Eigen::Vector3d errors = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d p = random_point(engine, nodes, 0.0);
      const auto jet = spline.jet(p);
      const Eigen::Vector3d found(wave(p), wave(p), -5.0 * wave(p));
      const Eigen::Vector3d exact(jet.value, jet.gradient.z(),
                                  jet.hessian.trace() - jet.hessian(2, 2));
      errors = errors.cwiseMax((found - exact).cwiseAbs());
    }
    if (cells == 32) {
      const Eigen::Vector3d order = (coarse.array() / errors.array()).log2();
      EXPECT_NEAR(order[0], 4.0, 0.4);
      EXPECT_NEAR(order[1], 3.0, 0.4);
      EXPECT_NEAR(order[2], 2.0, 0.4);
      EXPECT_LT(errors[0], 2e-6);
    }
    coarse = errors;
  }
}

TEST(TricubicSpline, EveryDerivativeIsThatOfTheOneBefore) {
  const TricubicSpline spline = TricubicSpline::through(kNodes, random_values(kNodes, 4));
  std::mt19937 engine(4);
  const double step = 1e-6;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d x = random_point(engine, kNodes, 3.0);  // outside, too
    const Eigen::Vector3d d = random_point(engine, {{-1.0, -1.0, -1.0}, 1.0, {3, 3, 3}}, 0.0);
    const auto after = spline.jet(x + step * d);
    const auto before = spline.jet(x - step * d);
    const auto jet = spline.jet(x);
    const auto slope = spline.hessian_slope(x, d);
    // Third derivatives are some 1e4 here: truncation 1e-8, rounding 1e-10/step; jumps of the
    // third derivative are met with a chance of step/spacing only.
    EXPECT_NEAR((after.value - before.value) / (2.0 * step), jet.gradient.dot(d), 1e-6);
    EXPECT_LT(((after.gradient - before.gradient) / (2.0 * step) - jet.hessian * d).norm(), 1e-5);
    EXPECT_LT(((after.hessian - before.hessian) / (2.0 * step) - slope).norm(),
              1e-6 * (1.0 + slope.norm() + jet.hessian.norm() / kNodes.spacing));
    EXPECT_EQ(jet.hessian, jet.hessian.transpose());
    EXPECT_EQ(slope, slope.transpose());
  }
}

TEST(TricubicSpline, IsTwiceContinuouslyDifferentiableAcrossCells) {
  const TricubicSpline spline = TricubicSpline::through(kNodes, random_values(kNodes, 5));
  std::mt19937 engine(5);
  for (int axis = 0; axis < 3; ++axis) {
    for (int node = -3; node < kNodes.count[axis] + 3; ++node) {  // ends of the levelling, too
      Eigen::Vector3d x = random_point(engine, kNodes, 1.0);
      const double border = kNodes.origin[axis] + node * kNodes.spacing;
      const double gap = 1e-12;
      x[axis] = border - gap;
      const auto before = spline.jet(x);
      x[axis] = border + gap;
      const auto after = spline.jet(x);
      // The next derivative times the gap: they are up to 1e2, 1e3 and 1e5 here.
      EXPECT_NEAR(before.value, after.value, 1e-9);
      EXPECT_LT((before.gradient - after.gradient).norm(), 1e-8);
      EXPECT_LT((before.hessian - after.hessian).norm(), 1e-6);
    }
  }
}

TEST(TricubicSpline, LevelsOffOutside) {
  const TricubicSpline spline = TricubicSpline::through(kNodes, random_values(kNodes, 6));
  const Eigen::Vector3d near(-0.3 - 2.0 * 0.25, 0.5, 1.7);
  const Eigen::Vector3d far(-1e300, 0.5, 1.7);
  EXPECT_NEAR(spline.value(near), spline.value(far), 1e-14);
  EXPECT_NEAR(spline.jet(far).gradient.x(), 0.0, 1e-13);
  const Eigen::Vector3d infinite =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isfinite(spline.value(infinite)));
  EXPECT_TRUE(std::isfinite(spline.value(-infinite)));
}

TEST(TricubicSpline, PassesOnWhatIsNotANumber) {
  const TricubicSpline spline = TricubicSpline::through(kNodes, random_values(kNodes, 7));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(spline.value({0.0, nan, 1.2})));
  EXPECT_TRUE(std::isnan(spline.jet({nan, 0.5, 1.2}).hessian(2, 2)));
}

TEST(TricubicSpline, IsMadeAgainFromItsCoefficients) {
  const TricubicSpline spline = TricubicSpline::through(kNodes, random_values(kNodes, 8));
  const TricubicSpline same(spline.nodes(), spline.coefficients());
  EXPECT_EQ(same.nodes(), kNodes);
  EXPECT_EQ(same.value({0.1, 0.4, 1.3}), spline.value({0.1, 0.4, 1.3}));
}

TEST(TricubicSpline, RefusesWithTheWholeMessage) {
  GridNodes thin = kNodes;
  thin.count.y() = 3;
  EXPECT_EQ(refusal(thin, 6 * 3 * 9),
            "tricubic spline: a grid of 6 3 9 nodes; at least 4 on each axis are needed");
  EXPECT_EQ(refusal(kNodes, 215),
            "tricubic spline: 215 numbers for a grid of 6 4 9; 216 are needed");
  EXPECT_THROW(TricubicSpline(kNodes, std::vector<double>(216)), InvalidInput);
}

}  // namespace
}  // namespace hbar
