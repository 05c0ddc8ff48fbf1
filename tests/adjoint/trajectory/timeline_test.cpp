#include "hbar/adjoint/trajectory/timeline.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hbar {
namespace {

const double kAlpha = 1.0 - std::sqrt(0.5);

/// A timeline of whole steps of h.
Timeline steps_of(std::string_view integrator, int steps, double h) {
  Timeline timeline;
  for (int k = 0; k < steps; ++k) {
    timeline.append(find_integrator(integrator), k, h);
    timeline.end_step();
  }
  return timeline;
}

void expect_weights(const Stage& stage, const std::vector<StageWeight>& expected) {
  ASSERT_EQ(stage.history_size, static_cast<int>(expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(stage.history[i].stage, expected[i].stage);
    EXPECT_DOUBLE_EQ(stage.history[i].weight, expected[i].weight);
  }
}

/// The rate at a stage's end that its row gives to positions f(t).
template <typename F>
double rate_of(const Timeline& timeline, int s, const F& f) {
  const Stage& stage = timeline.stage(s);
  double rate = stage.rate * f(stage.time);
  for (int i = 0; i < stage.history_size; ++i) {
    const StageWeight& past = stage.history[static_cast<std::size_t>(i)];
    rate += past.weight * f(timeline.stage(past.stage).time);
  }
  return rate;
}

TEST(Timeline, StartsWithTheInitialStateAlone) {
  const Timeline timeline;
  EXPECT_EQ(timeline.stage_count(), 1);
  EXPECT_EQ(timeline.step_count(), 0);
  EXPECT_EQ(timeline.step_end(0), 0);
  EXPECT_EQ(timeline.stage(0).time, 0.0);
  EXPECT_EQ(timeline.stage(0).history_size, 0);
}

TEST(Timeline, Bdf1RowsLookBackOneStep) {
  const Timeline timeline = steps_of("bdf1", 3, 0.1);
  ASSERT_EQ(timeline.stage_count(), 4);
  for (int s = 1; s <= 3; ++s) {
    const Stage& stage = timeline.stage(s);
    EXPECT_EQ(stage.step, s - 1);
    EXPECT_EQ(stage.start, s - 1);
    EXPECT_NEAR(stage.time, 0.1 * s, 1e-15);
    EXPECT_DOUBLE_EQ(stage.rate, 10.0);
    expect_weights(stage, {{s - 1, -10.0}});
    EXPECT_EQ(timeline.step_end(s), s);
  }
}

TEST(Timeline, Sdirk2RowsAreThoseOfTheMethod) {
  const double h = 0.1;
  const Timeline timeline = steps_of("sdirk2", 2, h);
  ASSERT_EQ(timeline.stage_count(), 5);
  EXPECT_EQ(timeline.step_end(2), 4);
  const double own = 1.0 / (kAlpha * h);
  const double middle = -(1.0 - kAlpha) / (kAlpha * kAlpha * h);
  for (int k = 0; k < 2; ++k) {
    const int start = 2 * k;
    const Stage& first = timeline.stage(start + 1);
    const Stage& second = timeline.stage(start + 2);
    EXPECT_NEAR(first.time, (k + kAlpha) * h, 1e-15);
    EXPECT_NEAR(second.time, (k + 1) * h, 1e-15);
    EXPECT_EQ(first.start, start);
    EXPECT_EQ(second.start, start);
    EXPECT_EQ(second.step, k);
    EXPECT_DOUBLE_EQ(first.rate, own);
    EXPECT_DOUBLE_EQ(second.rate, own);
    expect_weights(first, {{start, -own}});
    expect_weights(second, {{start + 1, middle}, {start, -own - middle}});
  }
}

TEST(Timeline, Bdf2IsStartedBySdirk2) {
  const double h = 0.1;
  const Timeline timeline = steps_of("bdf2", 3, h);
  ASSERT_EQ(timeline.stage_count(), 5);
  EXPECT_EQ(timeline.step_end(1), 2);
  EXPECT_EQ(timeline.stage(1), steps_of("sdirk2", 1, h).stage(1));
  EXPECT_EQ(timeline.stage(2), steps_of("sdirk2", 1, h).stage(2));
  EXPECT_DOUBLE_EQ(timeline.stage(3).rate, 15.0);
  expect_weights(timeline.stage(3), {{2, -20.0}, {0, 5.0}});
  expect_weights(timeline.stage(4), {{3, -20.0}, {2, 5.0}});
}

TEST(Timeline, Bdf2IsStartedAnewWhereTheStepChanges) {
  const Integrator& bdf2 = find_integrator("bdf2");
  Timeline timeline = steps_of("bdf2", 2, 0.1);
  timeline.append(bdf2, 2, 0.05);
  timeline.append(bdf2, 2, 0.05);
  timeline.end_step();
  timeline.append(bdf2, 3, 0.1);
  timeline.end_step();
  timeline.append(bdf2, 4, 0.1);
  timeline.end_step();
  // 0 | 1 2 | 3 | 4 5, 6 | 7 8 | 9: sdirk2, bdf2, sdirk2 and bdf2 at half h, sdirk2, bdf2.
  ASSERT_EQ(timeline.stage_count(), 10);
  EXPECT_EQ(timeline.step_count(), 5);
  EXPECT_DOUBLE_EQ(timeline.stage(4).rate, 1.0 / (kAlpha * 0.05));
  EXPECT_EQ(timeline.stage(5).start, 3);
  expect_weights(timeline.stage(6), {{5, -40.0}, {3, 10.0}});
  EXPECT_EQ(timeline.stage(6).start, 5);
  EXPECT_EQ(timeline.stage(6).step, 2);
  EXPECT_EQ(timeline.step_end(3), 6);
  EXPECT_DOUBLE_EQ(timeline.stage(7).rate, 1.0 / (kAlpha * 0.1));
  expect_weights(timeline.stage(9), {{8, -20.0}, {6, 5.0}});
  EXPECT_NEAR(timeline.stage(9).time, 0.5, 1e-15);
}

TEST(Timeline, RatesOfAFreeFallAreExactToTheOrderOfTheMethod) {
  for (const Integrator& integrator : integrators()) {
    const Timeline timeline = steps_of(integrator.name, 4, 0.1);
    for (int s = 1; s < timeline.stage_count(); ++s) {
      const double of_constant = rate_of(timeline, s, [](double) { return 1.0; });
      EXPECT_NEAR(of_constant, 0.0, 1e-12) << integrator.name << ' ' << s;
      const double of_line = rate_of(timeline, s, [](double t) { return t; });
      EXPECT_NEAR(of_line, 1.0, 1e-12) << integrator.name << ' ' << s;
    }
    const double of_parabola =
        rate_of(timeline, timeline.last_stage(), [](double t) { return t * t; });
    const double gap = std::abs(of_parabola - 2.0 * 0.4);
    if (integrator.name == "bdf2") {
      EXPECT_LT(gap, 1e-12);
    } else if (integrator.name == "bdf1") {
      EXPECT_NEAR(gap, 0.1, 1e-12);
    }
  }
}

TEST(Timeline, TruncateTakesBackAnAttempt) {
  for (const Integrator& integrator : integrators()) {
    Timeline timeline = steps_of(integrator.name, 2, 0.1);
    const Timeline before = timeline;
    timeline.append(integrator, 2, 0.1);
    EXPECT_FALSE(timeline == before);
    timeline.truncate(before.stage_count());
    EXPECT_TRUE(timeline == before) << integrator.name;
    // What follows is as if the attempt had never been.
    timeline.append(integrator, 2, 0.1);
    timeline.end_step();
    EXPECT_TRUE(timeline == steps_of(integrator.name, 3, 0.1)) << integrator.name;
  }
}

TEST(Timeline, TruncateTakesBackFinishedSteps) {
  Timeline timeline = steps_of("bdf2", 5, 0.1);
  timeline.truncate(timeline.step_end(3) + 1);
  EXPECT_TRUE(timeline == steps_of("bdf2", 3, 0.1));
}

}  // namespace
}  // namespace hbar
