#include "hbar/core/base/stumpff.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace hbar {
namespace {

/// c_n(s) by its series, with four more digits than double.
long double series(std::size_t n, long double s) {
  long double term = 1.0L;
  for (std::size_t k = 2; k <= n; ++k) {
    term /= static_cast<long double>(k);
  }
  long double sum = 0.0L;
  for (std::size_t k = 0; k < 60; ++k) {
    sum += term;
    const auto next = static_cast<long double>(2 * k + n);
    term *= -s / ((next + 1.0L) * (next + 2.0L));
  }
  return sum;
}

std::vector<double> arguments() {
  std::vector<double> s = {0.0, 1e-300, 1e-30, 1e-16, 1e-8, 1e-4, 8.99999, 9.0, 9.00001};
  const double last = 1.95 * std::numbers::pi;
  for (int k = 1; k <= 200; ++k) {
    const double theta = last * k / 200.0;
    s.push_back(theta * theta);
  }
  return s;
}

TEST(EveryStumpffFunction, IsItsSeriesToRounding) {
  for (const double s : arguments()) {
    const std::array<double, 8> c = stumpff(s);
    for (std::size_t n = 0; n < c.size(); ++n) {
      const auto expected = static_cast<double>(series(n, s));
      // c_0 and c_1 cross zero, where only the error relative to their size at 0 can be small.
      const double scale = n < 2 ? 1.0 : std::abs(expected);
      EXPECT_LE(std::abs(c[n] - expected), 1e-14 * scale) << "c_" << n << " at s = " << s;
    }
  }
}

TEST(EveryStumpffFunction, HasTheDerivativeThatTwoOthersGive) {
  for (const double s : arguments()) {
    const std::array<Dual, 8> c = stumpff(Dual(s, 1.0));
    for (std::size_t n = 0; n < 6; ++n) {
      const auto order = static_cast<long double>(n);
      const auto expected =
          static_cast<double>(0.5L * (order * series(n + 2, s) - series(n + 1, s)));
      EXPECT_NEAR(c[n].slope, expected, 1e-14) << "c_" << n << " at s = " << s;
    }
  }
}

}  // namespace
}  // namespace hbar
