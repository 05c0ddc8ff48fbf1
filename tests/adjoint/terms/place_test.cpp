#include "hbar/adjoint/terms/place.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::message_of;
using testing::small_problem;

/// The number at a place.
double at(const TrajectoryValues& values, const ValuePlace& place) {
  switch (place.field) {
    case ValueField::kQ:
      return values.q(place.index, place.step);
    case ValueField::kQdot:
      return values.qdot(place.index, place.step);
    case ValueField::kMeasured:
      return values.measured(place.index, place.step);
    case ValueField::kU:
      return values.u(place.index, place.step);
    case ValueField::kP:
      return values.p[place.index];
  }
  return 0.0;
}

TEST(Place, IsWhereThatNumberStands) {
  const Problem problem = small_problem("bdf2");
  const Horizon& horizon = problem.horizon;
  const Model& model = horizon.model();
  const Trajectory trajectory = simulate(horizon, problem.inputs).trajectory();
  const TrajectoryValues values = read_values(horizon, trajectory);
  for (int i = 0; i < model.dof(); ++i) {
    const std::string name = model.coordinate_name(i);
    EXPECT_EQ(at(values, place::coordinate(model, name, 4)), trajectory.q_at_step(4)[i]) << name;
    EXPECT_EQ(at(values, place::rate(model, name, 6)), trajectory.qdot_at_step(6)[i]) << name;
  }
  for (int i = 0; i < model.control_count(); ++i) {
    EXPECT_EQ(at(values, place::control(model, model.control_name(i), 3)), problem.inputs.u(i, 3));
  }
  const ParameterSet& set = horizon.parameters();
  for (int i = 0; i < set.size(); ++i) {
    EXPECT_EQ(at(values, place::parameter(set, set[i].name)), problem.inputs.p[i]);
  }
  for (std::size_t e = 0; e < model.end_effectors().size(); ++e) {
    for (const Axis axis : {kX, kY, kZ}) {
      const ValuePlace place = place::end_effector(model, model.end_effectors()[e].name, axis, 5);
      EXPECT_EQ(at(values, place), values.v()(3 * static_cast<int>(e) + axis, 5));
      EXPECT_EQ(place,
                place::measured(horizon, model.end_effectors()[e].name + "." + "xyz"[axis], 5));
    }
  }
}

TEST(Place, NamesTheNearestWhereThereIsNone) {
  const Problem problem = small_problem("bdf1");
  const Model& model = problem.horizon.model();
  const auto refusal = [](const auto& call) {
    return message_of<InvalidInput>([&] { static_cast<void>(call()); });
  };
  const std::string tip = model.end_effectors()[0].name;
  EXPECT_EQ(refusal([&] { return place::end_effector(model, tip + "p", kX, 1); }),
            "the model has no end effector '" + tip + "p'; did you mean '" + tip + "'?");
  const std::string joint = model.coordinate_name(0);
  EXPECT_EQ(refusal([&] { return place::coordinate(model, joint + "s", 1); }),
            "the model has no coordinate '" + joint + "s'; did you mean '" + joint + "'?");
  EXPECT_NE(refusal([&] { return place::rate(model, joint + "s", 1); }), "");
  const std::string control = model.control_name(0);
  EXPECT_EQ(refusal([&] { return place::control(model, control + "s", 1); }),
            "the model has no control '" + control + "s'; did you mean '" + control + "'?");
  EXPECT_NE(refusal([&] {
              return place::parameter(problem.horizon.parameters(), "body.nobody.mass");
            }).find("body.nobody.mass"),
            std::string::npos);
  EXPECT_NE(refusal([&] { return place::measured(problem.horizon, "nothing", 1); }).find("nothing"),
            std::string::npos);
  EXPECT_EQ(refusal([&] { return place::control(model, control, -1); }),
            "place: step is -1; it must be ≥ 0");
}

}  // namespace
}  // namespace hbar
