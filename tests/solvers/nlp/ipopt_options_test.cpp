#include <gtest/gtest.h>

#include <set>

#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

std::string refusal(const IpoptOptions& options) {
  testing::Rosenbrock program;
  ::testing::internal::CaptureStdout();
  std::string message =
      testing::message_of<InvalidInput>([&] { (void)solve_with_ipopt(program, options); });
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  return message;
}

TEST(IpoptOptions, RefusesUnknownNamesAndSuggestsTheNearest) {
  IpoptOptions options;
  options.number_options["mu_initt"] = 0.1;
  EXPECT_EQ(refusal(options), "ipopt: unknown option \"mu_initt\"; did you mean \"mu_init\"?");
}

TEST(IpoptOptions, RefusesAnotherType) {
  IpoptOptions options;
  options.number_options["max_iter"] = 3.0;
  EXPECT_EQ(refusal(options),
            "ipopt: option \"max_iter\" belongs into integer_options, not into number_options");
}

TEST(IpoptOptions, RefusesValuesThatIpoptDoesNotAllow) {
  IpoptOptions options;
  options.tolerance = -1.0;
  EXPECT_EQ(refusal(options).find("ipopt: option \"tol\" cannot be -1 ("), 0U);
  options = {};
  options.string_options["mu_strategy"] = "clever";
  EXPECT_EQ(refusal(options).find("ipopt: option \"mu_strategy\" cannot be clever ("), 0U);
  options = {};
  options.max_iterations = -1;
  EXPECT_EQ(refusal(options).find("ipopt: option \"max_iter\" cannot be -1 ("), 0U);
  options = {};
  options.max_wall_time = 0.0;
  EXPECT_EQ(refusal(options), "ipopt: max_wall_time is 0; expected a positive number of seconds");
  options = {};
  options.constraint_tolerance = 0.0;
  EXPECT_EQ(refusal(options), "ipopt: constraint_tolerance is 0; expected a positive number");
}

TEST(IpoptOptions, RefusesNamesThatOurOptionsDecide) {
  IpoptOptions options;
  options.string_options["hessian_approximation"] = "exact";
  EXPECT_EQ(refusal(options),
            "ipopt: option \"hessian_approximation\" is decided by IpoptOptions::hessian");
}

/// Puts an option into the map of its type.
struct PutOption {
  IpoptOptions& options;
  const std::string& name;
  void operator()(const std::string& value) const { options.string_options[name] = value; }
  void operator()(double value) const { options.number_options[name] = value; }
  void operator()(int value) const { options.integer_options[name] = value; }
};

TEST(EveryIpoptOption, IsReachableThroughTheMapOfItsType) {
  const std::vector<IpoptOptionInfo> known = known_ipopt_options();
  EXPECT_GT(known.size(), 200U);
  // Decided by IpoptOptions, and one whose default in Ipopt 3.11 is outside its own range.
  const std::set<std::string> unreachable = {"hessian_approximation", "print_level",
                                             "warm_start_init_point", "neg_curv_test_tol"};
  for (const IpoptOptionInfo& option : known) {
    IpoptOptions options;
    options.max_iterations = 0;
    std::visit(PutOption{options, option.name}, option.default_value);
    testing::Rosenbrock program;
    try {
      (void)solve_with_ipopt(program, options);
    } catch (const InvalidInput& refused) {
      EXPECT_EQ(unreachable.count(option.name), 1U) << refused.what();
    }
  }
}

TEST(IpoptOptions, PassesOptionsOnAndLetsThemWin) {
  testing::Rosenbrock program;
  IpoptOptions options;
  options.integer_options["max_iter"] = 2;
  options.string_options["mu_strategy"] = "adaptive";
  options.number_options["obj_scaling_factor"] = 0.5;
  EXPECT_EQ(solve_with_ipopt(program, options).iterations, 2);
}

}  // namespace
}  // namespace hbar::solvers
