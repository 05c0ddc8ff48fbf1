#include "hbar/adjoint/terms/value_access.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_values.h"

namespace hbar {
namespace {

TEST(ValueAccess, ListsEveryNumberOnceInTheOrderOfTheMembers) {
  TrajectoryValues values = testing::random_values(1);
  const std::vector<ValuePlace> places = all_places(values);
  const Eigen::VectorXd all = testing::flatten_values(values);
  ASSERT_EQ(static_cast<Eigen::Index>(places.size()), all.size());
  TrajectoryPartials partials(values);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double expected = all[static_cast<Eigen::Index>(i)];
    EXPECT_EQ(value_at(std::as_const(values), places[i]), expected) << place_name(places[i]);
    value_at(values, places[i]) += 1.0;
    partial_at(partials, places[i]) = expected;
  }
  EXPECT_EQ(testing::flatten_values(values), (all.array() + 1.0).matrix());
  EXPECT_EQ(testing::flatten_values(partials), all);
}

TEST(ValueAccess, KnowsTheShapesOfTheMembers) {
  const TrajectoryValues values = testing::random_values(1);
  EXPECT_EQ(field_rows(values, ValueField::kMeasured), 12);
  EXPECT_EQ(field_columns(values, ValueField::kMeasured), 6);
  EXPECT_EQ(field_columns(values, ValueField::kU), 5);
  EXPECT_EQ(field_columns(values, ValueField::kP), 1);
}

TEST(ValueAccess, NamesAndRefusesWhatIsNotThere) {
  const TrajectoryValues values = testing::random_values(1);
  EXPECT_EQ(place_name({ValueField::kP, 9, 2}), "p 2");
  EXPECT_EQ(value_at(values, {ValueField::kP, 9, 2}), values.p[2]);
  EXPECT_EQ(testing::message_of<InvalidInput>([&] {
              static_cast<void>(value_at(values, {ValueField::kQdot, 6, 1}));
            }),
            "there is no qdot 1 at step 6: qdot is 4 x 6");
  EXPECT_THROW(static_cast<void>(value_at(values, {ValueField::kU, 0, 2})), InvalidInput);
  EXPECT_THROW(static_cast<void>(value_at(values, {ValueField::kU, -1, 0})), InvalidInput);
  TrajectoryPartials partials(values);
  EXPECT_THROW(static_cast<void>(partial_at(partials, {ValueField::kP, 0, 3})), InvalidInput);
}

}  // namespace
}  // namespace hbar
