#pragma once

#include <cmath>

namespace hbar {

/// A hyper-dual number a + b ε₁ + c ε₂ + d ε₁ε₂ with ε₁² = ε₂² = 0: a value, its derivatives along
/// two directions, and its second derivative along both (J. Fike, J. Alonso, AIAA 2011-886).
///
/// Any formula templated on the scalar gives exact second derivatives with HyperDual. Meant for
/// small formulas; the simulation itself computes with double and Dual.
struct HyperDual {
  double value = 0.0;    ///< a
  double slope_1 = 0.0;  ///< b, along the first direction
  double slope_2 = 0.0;  ///< c, along the second direction
  double cross = 0.0;    ///< d, along both

  constexpr HyperDual() = default;
  constexpr HyperDual(double v) : value(v) {}  // NOLINT: constants must convert silently
  constexpr HyperDual(double v, double s1, double s2, double c)
      : value(v), slope_1(s1), slope_2(s2), cross(c) {}

  constexpr HyperDual& operator+=(const HyperDual& o) {
    return *this = {value + o.value, slope_1 + o.slope_1, slope_2 + o.slope_2, cross + o.cross};
  }
  constexpr HyperDual& operator-=(const HyperDual& o) { return *this += -o; }
  constexpr HyperDual& operator*=(const HyperDual& o) {
    return *this = {value * o.value, slope_1 * o.value + value * o.slope_1,
                    slope_2 * o.value + value * o.slope_2,
                    cross * o.value + slope_1 * o.slope_2 + slope_2 * o.slope_1 + value * o.cross};
  }
  constexpr HyperDual& operator/=(const HyperDual& o) {
    const double ratio = value / o.value;
    const double first = (slope_1 - ratio * o.slope_1) / o.value;
    const double second = (slope_2 - ratio * o.slope_2) / o.value;
    return *this = {ratio, first, second,
                    (cross - first * o.slope_2 - second * o.slope_1 - ratio * o.cross) / o.value};
  }
  friend constexpr HyperDual operator+(HyperDual a, const HyperDual& b) { return a += b; }
  friend constexpr HyperDual operator-(HyperDual a, const HyperDual& b) { return a -= b; }
  friend constexpr HyperDual operator*(HyperDual a, const HyperDual& b) { return a *= b; }
  friend constexpr HyperDual operator/(HyperDual a, const HyperDual& b) { return a /= b; }
  friend constexpr HyperDual operator-(const HyperDual& a) {
    return {-a.value, -a.slope_1, -a.slope_2, -a.cross};
  }
  friend constexpr HyperDual operator+(const HyperDual& a) { return a; }
  friend constexpr bool operator==(const HyperDual& a, const HyperDual& b) {
    return a.value == b.value;
  }
  friend constexpr auto operator<=>(const HyperDual& a, const HyperDual& b) {
    return a.value <=> b.value;
  }
};

/// f(a), given f, f' and f'' at a's value.
[[nodiscard]] constexpr HyperDual chain_rule(const HyperDual& a, double f, double f1, double f2) {
  return {f, f1 * a.slope_1, f1 * a.slope_2, f1 * a.cross + f2 * a.slope_1 * a.slope_2};
}

/// Elementary functions, each with its derivatives.
[[nodiscard]] inline HyperDual sqrt(const HyperDual& a) {
  const double root = std::sqrt(a.value);
  return chain_rule(a, root, 0.5 / root, -0.25 / (root * a.value));
}
[[nodiscard]] inline HyperDual sin(const HyperDual& a) {
  const double f = std::sin(a.value);
  return chain_rule(a, f, std::cos(a.value), -f);
}
[[nodiscard]] inline HyperDual cos(const HyperDual& a) {
  const double f = std::cos(a.value);
  return chain_rule(a, f, -std::sin(a.value), -f);
}
[[nodiscard]] inline HyperDual abs(const HyperDual& a) { return a.value < 0.0 ? -a : a; }
[[nodiscard]] inline HyperDual exp(const HyperDual& a) {
  const double f = std::exp(a.value);
  return chain_rule(a, f, f, f);
}
[[nodiscard]] inline HyperDual log(const HyperDual& a) {
  return chain_rule(a, std::log(a.value), 1.0 / a.value, -1.0 / (a.value * a.value));
}
[[nodiscard]] inline HyperDual pow(const HyperDual& a, double n) {
  // A vanishing factor means no derivative, at a = 0 too, where the power beside it is infinite.
  const double f1 = n == 0.0 ? 0.0 : n * std::pow(a.value, n - 1.0);
  const double f2 = n == 0.0 || n == 1.0 ? 0.0 : n * (n - 1.0) * std::pow(a.value, n - 2.0);
  return chain_rule(a, std::pow(a.value, n), f1, f2);
}
/// a > 0.
[[nodiscard]] inline HyperDual pow(const HyperDual& a, const HyperDual& b) {
  HyperDual power = exp(b * log(a));
  power.value = std::pow(a.value, b.value);  // as the rounding of doubles has it
  return power;
}
[[nodiscard]] inline HyperDual atan2(const HyperDual& y, const HyperDual& x) {
  // ∂/∂y = x / r², ∂/∂x = −y / r²; ∂²/∂y² = −2 x y / r⁴ = −∂²/∂x², ∂²/∂x∂y = (y² − x²) / r⁴
  const double r2 = x.value * x.value + y.value * y.value;
  const double by_y = x.value / r2;
  const double by_x = -y.value / r2;
  const double by_yy = 2.0 * by_x * by_y;
  const double by_xy = by_x * by_x - by_y * by_y;
  return {std::atan2(y.value, x.value), by_y * y.slope_1 + by_x * x.slope_1,
          by_y * y.slope_2 + by_x * x.slope_2,
          by_y * y.cross + by_x * x.cross +
              by_yy * (y.slope_1 * y.slope_2 - x.slope_1 * x.slope_2) +
              by_xy * (y.slope_1 * x.slope_2 + x.slope_1 * y.slope_2)};
}

/// The value of a scalar, without its derivatives.
[[nodiscard]] constexpr double value_of(const HyperDual& a) { return a.value; }

}  // namespace hbar
