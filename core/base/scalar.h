#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <limits>

#if EIGEN_DEFAULT_ALIGN_BYTES != 64 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16 || \
    EIGEN_MALLOC_ALREADY_ALIGNED
#error \
    "compile the whole program with -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=0, as hbar was (hbar::hbar does)"
#endif

namespace hbar {

namespace detail {

/// Links only with a library that allocates as this program does: aligned to 64 bytes, with 16 for
/// what is no allocation.
extern const char kAlignedTo64And16;
[[gnu::used]] inline const char* const kAlignedAsTheLibrary = &kAlignedTo64And16;

}  // namespace detail

/// A dual number a + b ε with ε² = 0: a value and its derivative along one direction.
///
/// Any formula templated on the scalar gives its exact directional derivative with Dual.
struct Dual {
  double value = 0.0;  ///< a
  double slope = 0.0;  ///< b

  constexpr Dual() = default;
  constexpr Dual(double v) : value(v) {}  // NOLINT: constants must convert silently
  constexpr Dual(double v, double s) : value(v), slope(s) {}

  constexpr Dual& operator+=(const Dual& o) {
    value += o.value;
    slope += o.slope;
    return *this;
  }
  constexpr Dual& operator-=(const Dual& o) {
    value -= o.value;
    slope -= o.slope;
    return *this;
  }
  constexpr Dual& operator*=(const Dual& o) {
    slope = slope * o.value + value * o.slope;
    value *= o.value;
    return *this;
  }
  constexpr Dual& operator/=(const Dual& o) {
    value /= o.value;
    slope = (slope - value * o.slope) / o.value;
    return *this;
  }
  friend constexpr Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend constexpr Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend constexpr Dual operator*(Dual a, const Dual& b) { return a *= b; }
  friend constexpr Dual operator/(Dual a, const Dual& b) { return a /= b; }
  friend constexpr Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  friend constexpr Dual operator+(const Dual& a) { return a; }
  friend constexpr bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend constexpr auto operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
};

/// Elementary functions, each with its derivative.
[[nodiscard]] inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.value);
  return {root, a.slope / (2.0 * root)};
}
[[nodiscard]] inline Dual sin(const Dual& a) {
  return {std::sin(a.value), a.slope * std::cos(a.value)};
}
[[nodiscard]] inline Dual cos(const Dual& a) {
  return {std::cos(a.value), -a.slope * std::sin(a.value)};
}
[[nodiscard]] inline Dual abs(const Dual& a) { return a.value < 0.0 ? -a : a; }
[[nodiscard]] inline Dual exp(const Dual& a) {
  const double power = std::exp(a.value);
  return {power, a.slope * power};
}
[[nodiscard]] inline Dual log(const Dual& a) { return {std::log(a.value), a.slope / a.value}; }
[[nodiscard]] inline Dual pow(const Dual& a, double n) {
  // x⁰ has no slope at x = 0 either, where 0 · x⁻¹ would not say so.
  return {std::pow(a.value, n), n == 0.0 ? 0.0 : a.slope * n * std::pow(a.value, n - 1.0)};
}
/// a > 0.
[[nodiscard]] inline Dual pow(const Dual& a, const Dual& b) {
  const double power = std::pow(a.value, b.value);
  return {power, power * (b.slope * std::log(a.value) + b.value * a.slope / a.value)};
}
[[nodiscard]] inline Dual atan2(const Dual& y, const Dual& x) {
  const double square = x.value * x.value + y.value * y.value;
  return {std::atan2(y.value, x.value), (x.value * y.slope - y.value * x.slope) / square};
}

/// The value of a scalar, without its derivative.
[[nodiscard]] constexpr double value_of(double a) { return a; }
[[nodiscard]] constexpr double value_of(const Dual& a) { return a.value; }

/// The two number types hbar computes with.
template <typename S>
concept Scalar = std::same_as<S, double> || std::same_as<S, Dual>;

template <Scalar S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <Scalar S>
using Vector6 = Eigen::Matrix<S, 6, 1>;
template <Scalar S>
using VectorX = Eigen::Matrix<S, Eigen::Dynamic, 1>;
template <Scalar S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;
template <Scalar S>
using Matrix6X = Eigen::Matrix<S, 6, Eigen::Dynamic>;
template <Scalar S>
using MatrixX = Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>;
/// A vector argument: any contiguous column of S, without a copy.
template <Scalar S>
using VectorView = Eigen::Ref<const VectorX<S>>;

}  // namespace hbar

template <>
struct Eigen::NumTraits<hbar::Dual> : Eigen::GenericNumTraits<double> {
  using Real = hbar::Dual;
  using NonInteger = hbar::Dual;
  using Nested = hbar::Dual;
  using Literal = hbar::Dual;
  static Real epsilon() { return std::numeric_limits<double>::epsilon(); }
  static Real dummy_precision() { return 1e-12; }
  static Real highest() { return std::numeric_limits<double>::max(); }
  static Real lowest() { return std::numeric_limits<double>::lowest(); }
  static int digits10() { return std::numeric_limits<double>::digits10; }
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 2,
    MulCost = 4
  };
};
template <typename BinaryOp>
struct Eigen::ScalarBinaryOpTraits<hbar::Dual, double, BinaryOp> {
  using ReturnType = hbar::Dual;
};
template <typename BinaryOp>
struct Eigen::ScalarBinaryOpTraits<double, hbar::Dual, BinaryOp> {
  using ReturnType = hbar::Dual;
};
