#include "hbar/adjoint/terms/objective.h"

#include <gtest/gtest.h>

#include <limits>

#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"
#include "tests/support/random_values.h"

namespace hbar {
namespace {

using testing::message_of;

TEST(TrajectoryPartials, StartAtZeroInTheShapeOfTheValues) {
  const TrajectoryValues values = testing::random_values(1);
  const TrajectoryPartials partials(values);
  EXPECT_EQ(partials.q, Eigen::MatrixXd::Zero(4, 6));
  EXPECT_EQ(partials.qdot, Eigen::MatrixXd::Zero(4, 6));
  EXPECT_EQ(partials.v(), Eigen::MatrixXd::Zero(6, 6));
  EXPECT_EQ(partials.u, Eigen::MatrixXd::Zero(2, 5));
  EXPECT_EQ(partials.p, Eigen::VectorXd::Zero(3));
}

TEST(Objective, WithoutTermsIsZero) {
  const TrajectoryValues values = testing::random_values(2);
  EXPECT_EQ(Objective().value(values), 0.0);
  EXPECT_EQ(testing::flatten_values(Objective().partials(values)).norm(), 0.0);
}

TEST(Objective, IsTheSumOfItsTerms) {
  const TrajectoryValues values = testing::random_values(3);
  const TermPointer first = squared_variables(2.0);
  const TermPointer second = effort(3.0);
  Objective sum(first);
  sum.add(second);
  EXPECT_EQ(sum.terms().size(), 2U);
  EXPECT_DOUBLE_EQ(sum.value(values), first->value(values) + second->value(values));
  const Eigen::VectorXd parts = testing::flatten_values(Objective(first).partials(values)) +
                                testing::flatten_values(Objective(second).partials(values));
  EXPECT_EQ(testing::flatten_values(sum.partials(values)), parts);
}

TEST(Objective, ListsTheSecondPartialsOfItsTermsOneAfterTheOther) {
  const TrajectoryValues values = testing::random_values(3);
  Objective sum(squared_final_position(2.0));
  sum.add(final_number(ValueField::kQ, 0)).add(effort(3.0));
  const std::vector<SecondPlace> places = sum.second_places(values);
  ASSERT_EQ(places.size(), 4U + 10U);
  EXPECT_EQ(places[1].a, (ValuePlace{ValueField::kQ, 5, 1}));
  EXPECT_EQ(places[4].b, (ValuePlace{ValueField::kU, 0, 0}));
  const Eigen::VectorXd second = sum.second_partials(values);
  EXPECT_EQ(second.head(4), Eigen::VectorXd::Constant(4, 2.0));
  EXPECT_EQ(second.tail(10), Eigen::VectorXd::Constant(10, 3.0 * values.h));
  EXPECT_EQ(Objective().second_partials(values).size(), 0);
}

TEST(Objective, NamesTheTermWhoseSecondPartialsAreNotFinite) {
  const TrajectoryValues values = testing::random_values(4);
  const ValuePlace place{ValueField::kP, 0, 0};
  const Objective objective(user_term(
      "mine", [](const TrajectoryValues&) { return 1.0; },
      [](const TrajectoryValues&, TrajectoryPartials&) {},
      {[place](const TrajectoryValues&) {
         return std::vector<SecondPlace>{{0, place, place}};
       },
       [](const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd> second) {
         second[0] = std::numeric_limits<double>::infinity();
       }}));
  EXPECT_EQ(
      message_of<NumericalFailure>([&] { static_cast<void>(objective.second_partials(values)); }),
      "objective term 'mine' gave a second partial that is not finite");
}

TEST(Objective, NamesTheTermWhoseValueIsNotFinite) {
  const TrajectoryValues values = testing::random_values(4);
  Objective objective(squared_variables());
  objective.add(user_term(
      "mine", [](const TrajectoryValues&) { return std::numeric_limits<double>::infinity(); },
      [](const TrajectoryValues&, TrajectoryPartials&) {}));
  EXPECT_EQ(message_of<NumericalFailure>([&] { static_cast<void>(objective.value(values)); }),
            "objective term 'mine' is inf");
}

TEST(Objective, NamesTheTermWhosePartialsAreNotFinite) {
  const TrajectoryValues values = testing::random_values(5);
  for (int part = 0; part < 5; ++part) {
    Objective objective(squared_variables());
    objective.add(user_term(
        "mine", [](const TrajectoryValues&) { return 1.0; },
        [part](const TrajectoryValues&, TrajectoryPartials& partials) {
          const double bad = std::numeric_limits<double>::quiet_NaN();
          Eigen::MatrixXd* const parts[] = {&partials.q, &partials.qdot, &partials.measured,
                                            &partials.u};
          (part < 4 ? (*parts[part])(0, 0) : partials.p[0]) = bad;
        }));
    EXPECT_EQ(message_of<NumericalFailure>([&] { static_cast<void>(objective.partials(values)); }),
              "objective term 'mine' gave a partial that is not finite")
        << part;
  }
}

TEST(Objective, LetsAUsersExceptionPass) {
  const TrajectoryValues values = testing::random_values(6);
  const Objective objective(user_term(
      "mine", [](const TrajectoryValues&) -> double { throw std::runtime_error("my own"); },
      [](const TrajectoryValues&, TrajectoryPartials&) {}));
  EXPECT_EQ(message_of<std::runtime_error>([&] { static_cast<void>(objective.value(values)); }),
            "my own");
}

}  // namespace
}  // namespace hbar
