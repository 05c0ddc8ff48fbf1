#include "hbar/adjoint/trajectory/integrator.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <map>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar {
namespace {

TEST(EveryIntegrator, HasRowsThatSumToZeroAndEndsItsStep) {
  for (const Integrator& method : integrators()) {
    for (std::size_t s = 0; s < method.stages.size(); ++s) {
      const IntegratorStage& stage = method.stages[s];
      double sum = stage.own;
      for (const double weight : stage.earlier) {
        sum += weight;
      }
      for (const double weight : stage.step_ends) {
        sum += weight;
      }
      EXPECT_NEAR(sum, 0.0, 1e-15) << method.name;
      EXPECT_LE(stage.earlier.size(), s) << method.name;
      EXPECT_LE(stage.step_ends.size(), static_cast<std::size_t>(method.history)) << method.name;
    }
    EXPECT_EQ(method.stages.back().time, 1.0) << method.name;
    EXPECT_EQ(find_integrator(method.starter).history, 1) << method.name;
  }
}

TEST(EveryIntegrator, DifferentiatesALineExactlyAtEachStage) {
  for (const Integrator& method : integrators()) {
    for (const IntegratorStage& stage : method.stages) {
      double slope = stage.own * stage.time;
      for (std::size_t j = 0; j < stage.earlier.size(); ++j) {
        slope += stage.earlier[j] * method.stages[j].time;
      }
      for (std::size_t j = 0; j < stage.step_ends.size(); ++j) {
        slope -= stage.step_ends[j] * static_cast<double>(j);
      }
      EXPECT_NEAR(slope, 1.0, 1e-15) << method.name;
    }
  }
}

/// Δ of a stage over the states it names, with β: Δ = c q̈ and c = β h².
struct Residual {
  double beta;
  std::map<std::string, double> delta;
};

/// Δ at h = 1 of a stage of a method, from the table: h q̈ = Σ C_j q̇_j, the stage's own q̇ replaced
/// by h q̇ = Σ C_j q_j.
Residual residual_of(const Integrator& method, std::size_t s) {
  const IntegratorStage& stage = method.stages[s];
  Residual out{1.0 / (stage.own * stage.own), {{"own", 1.0}}};
  const auto name = [](const char* what, std::size_t j) { return what + std::to_string(j); };
  for (std::size_t j = 0; j < stage.earlier.size(); ++j) {
    out.delta[name("q stage ", j)] += out.beta * stage.own * stage.earlier[j];
    // q̇ of an earlier stage of a one-step method, by its own row.
    const IntegratorStage& row = method.stages[j];
    out.delta[name("q stage ", j)] += out.beta * stage.earlier[j] * row.own;
    out.delta[name("q start ", 0)] += out.beta * stage.earlier[j] * row.step_ends[0];
  }
  for (std::size_t j = 0; j < stage.step_ends.size(); ++j) {
    out.delta[name("q start ", j)] += out.beta * stage.own * stage.step_ends[j];
    out.delta[name("qdot start ", j)] += out.beta * stage.step_ends[j];
  }
  return out;
}

TEST(EveryIntegrator, HasTheResidualOfTheDocument) {
  const double a = 0.5 * (2.0 - std::sqrt(2.0));
  struct Equation {
    std::string method;
    std::size_t stage;
    Residual expected;
  };
  const std::vector<Equation> equations = {
      {"bdf1", 0, {1.0, {{"own", 1.0}, {"q start 0", -1.0}, {"qdot start 0", -1.0}}}},    // (22)
      {"sdirk2", 0, {a * a, {{"own", 1.0}, {"q start 0", -1.0}, {"qdot start 0", -a}}}},  // (24)
      {"sdirk2",
       1,
       {a * a,
        {{"own", 1.0},
         {"q start 0", -1.0 + 2.0 * (1.0 - a) / a},
         {"qdot start 0", -(2.0 * a - 1.0)},
         {"q stage 0", -2.0 * (1.0 - a) / a}}}},  // (25)
      {"bdf2",
       0,
       {4.0 / 9.0,
        {{"own", 1.0},
         {"q start 0", -4.0 / 3.0},
         {"q start 1", 1.0 / 3.0},
         {"qdot start 0", -8.0 / 9.0},
         {"qdot start 1", 2.0 / 9.0}}}},  // (28)
  };
  for (const Equation& equation : equations) {
    const Residual found = residual_of(find_integrator(equation.method), equation.stage);
    EXPECT_NEAR(found.beta, equation.expected.beta, 1e-15) << equation.method;
    ASSERT_EQ(found.delta.size(), equation.expected.delta.size()) << equation.method;
    for (const auto& [state, weight] : equation.expected.delta) {
      ASSERT_TRUE(found.delta.contains(state)) << equation.method << ' ' << state;
      EXPECT_NEAR(found.delta.at(state), weight, 2e-15) << equation.method << ' ' << state;
    }
  }
}

using StateMatrix = Eigen::Vector2d;  // q, q̇

/// One step of q̈ = −q from the step starts (newest first).
StateMatrix step(const Integrator& method, double h, const std::vector<StateMatrix>& starts) {
  std::vector<StateMatrix> stages;
  for (const IntegratorStage& stage : method.stages) {
    StateMatrix known = StateMatrix::Zero();
    for (std::size_t j = 0; j < stage.earlier.size(); ++j) {
      known += stage.earlier[j] * stages[j];
    }
    for (std::size_t j = 0; j < stage.step_ends.size(); ++j) {
      known += stage.step_ends[j] * starts[j];
    }
    // own q + known_q = h q̇ and own q̇ + known_v = −h q.
    const double v = (h * known[0] / stage.own - known[1]) / (stage.own + h * h / stage.own);
    stages.push_back({(h * v - known[0]) / stage.own, v});
  }
  return stages.back();
}

double error_at_one(const Integrator& method, int steps) {
  const double h = 1.0 / steps;
  std::vector<StateMatrix> starts = {{1.0, 0.3}};
  for (int k = 0; k < steps; ++k) {
    const bool ready = static_cast<int>(starts.size()) >= method.history;
    starts.insert(starts.begin(),
                  step(ready ? method : find_integrator(method.starter), h, starts));
  }
  const StateMatrix exact(std::cos(1.0) + 0.3 * std::sin(1.0),
                          -std::sin(1.0) + 0.3 * std::cos(1.0));
  return (starts.front() - exact).norm();
}

TEST(EveryIntegrator, ConvergesWithItsOrder) {
  for (const Integrator& method : integrators()) {
    const double order = std::log2(error_at_one(method, 400) / error_at_one(method, 800));
    EXPECT_NEAR(order, method.order, 0.05) << method.name;
  }
}

TEST(FindIntegrator, TakesEitherCaseAndRefusesUnknownNames) {
  EXPECT_EQ(find_integrator("BDF2").name, "bdf2");
  EXPECT_EQ(find_integrator("sDirk2").name, "sdirk2");
  EXPECT_EQ(testing::message_of<InvalidInput>([] { static_cast<void>(find_integrator("bdf7")); }),
            "there is no integrator 'bdf7'; known: bdf1, sdirk2, bdf2");
}

}  // namespace
}  // namespace hbar
