#include "hbar/solvers/nlp/ipopt_iterate.h"

#include <gtest/gtest.h>

#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/programs.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;

/// Hs071 in units that make Ipopt scale it: the objective by 10⁶, a constraint by 10⁴.
struct Uneven final : Hs071 {
  double objective(const Eigen::VectorXd& x) override { return 1e6 * Hs071::objective(x); }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    Hs071::objective_gradient(x, g);
    g *= 1e6;
  }
  Uneven() { limits_.scale = Eigen::Vector2d(1.0, 1e-4); }
};

/// The multipliers of every entry, one below the other.
Eigen::VectorXd multipliers(const IpoptResult& result) {
  Eigen::VectorXd out(result.lower_multipliers.size() * 2 + result.constraint_multipliers.size());
  out << result.lower_multipliers, result.upper_multipliers, result.constraint_multipliers;
  return out;
}

/// A run that ends at its limit gives the iterate of the last callback: what Ipopt hands out then
/// is what was read before.
template <typename Program>
void expect_what_ipopt_hands_out(bool fix_one) {
  for (int limit = 0; limit < 8; ++limit) {
    Program program;
    if (fix_one) {
      program.variables_.lower[3] = program.variables_.upper[3] = program.variables_.start[3];
    }
    IpoptResult last;
    IpoptOptions options;
    options.max_iterations = limit;
    options.checkpoint_every = 0.0;
    options.string_options["fixed_variable_treatment"] = "relax_bounds";
    options.on_checkpoint = [&last](const IpoptResult& result) { last = result; };
    const IpoptResult result = solve_with_ipopt(program, options);
    ASSERT_EQ(result.status, IpoptStatus::kIterationLimit) << result.message;
    const Eigen::VectorXd expected = multipliers(result);
    ASSERT_GT(expected.norm(), 1e-3);
    EXPECT_LE((multipliers(last) - expected).norm(), 1e-14 * expected.norm()) << limit;
    EXPECT_EQ(last.mu, result.mu);
    EXPECT_EQ(last.x, result.x);
    EXPECT_EQ(last.iterations, result.iterations);
    EXPECT_EQ(last.status, IpoptStatus::kInterrupted);
  }
}

TEST(IpoptIterate, IsWhatIpoptHandsOutAtTheEnd) { expect_what_ipopt_hands_out<Hs071>(false); }

TEST(IpoptIterate, IsInTheProgramsUnits) { expect_what_ipopt_hands_out<Uneven>(false); }

TEST(IpoptIterate, HasEveryVariable) { expect_what_ipopt_hands_out<Hs071>(true); }

TEST(IpoptIterate, ACheckpointThatThrowsEndsTheRun) {
  Hs071 program;
  IpoptOptions options;
  options.checkpoint_every = 0.0;
  int calls = 0;
  options.on_checkpoint = [&calls](const IpoptResult&) {
    if (++calls == 4) {
      throw std::runtime_error("no more");
    }
  };
  EXPECT_EQ(hbar::testing::message_of<std::runtime_error>(
                [&] { (void)solve_with_ipopt(program, options); }),
            "no more");
  EXPECT_EQ(calls, 4);
}

TEST(IpoptIterate, CheckpointsComeAtIntervals) {
  Hs071 program;
  IpoptOptions options;
  int calls = 0;
  options.on_checkpoint = [&calls](const IpoptResult&) { ++calls; };
  options.checkpoint_every = 1e6;
  EXPECT_TRUE(solve_with_ipopt(program, options).converged());
  EXPECT_EQ(calls, 1);  // as soon as there is a point
  options.checkpoint_every = -1.0;
  EXPECT_EQ(
      hbar::testing::message_of<InvalidInput>([&] { (void)solve_with_ipopt(program, options); }),
      "ipopt: checkpoint_every is -1; expected a number of seconds, at least 0");
}

}  // namespace
}  // namespace hbar::solvers
