#include "hbar/core/base/unit_vector.h"

#include <gtest/gtest.h>

#include <limits>

namespace hbar {
namespace {

TEST(UnitVector, HasLengthOneWhateverTheLengthWas) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1.0, -2.0, 3.0) / std::sqrt(14.0);
  for (const double length : {1e-300, 1e-200, 1e-20, 0.3, 1.0, 1e20, 1e200, 4e307}) {
    const Eigen::Vector3d unit = unit_vector(length * Eigen::Vector3d(1.0, -2.0, 3.0));
    EXPECT_LT((unit - direction).norm(), 1e-15) << length;
  }
  const double largest = std::numeric_limits<double>::max();
  EXPECT_LT(
      (unit_vector({largest, largest, -largest}) - Eigen::Vector3d(1.0, 1.0, -1.0) / std::sqrt(3.0))
          .norm(),
      1e-15);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(unit_vector({0.0, least, 0.0}), Eigen::Vector3d(0.0, 1.0, 0.0));
}

TEST(UnitVector, LeavesAUnitVectorAndZeroAlone) {
  const Eigen::Vector3d once = unit_vector({0.3, -0.7, 0.2});
  EXPECT_EQ(unit_vector(once), once);
  EXPECT_EQ(unit_vector(Eigen::Vector3d::Zero()), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace hbar
