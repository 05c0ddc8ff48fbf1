#include "hbar/solvers/nlp/nlp.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/programs.h"
#include "tests/support/random_matrices.h"

namespace hbar::solvers {
namespace {

using testing::Hs071;
using testing::kInfinity;
using testing::message_of;

struct BadProgram {
  std::function<void(Hs071&)> spoil;
  std::string message;
};

const double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<BadProgram> kBadPrograms = {
    {[](Hs071& p) { p.variables_ = {}; }, "nlp: there are no variables; expected at least one"},
    {[](Hs071& p) { p.variables_.lower.resize(3); },
     "nlp: lower bounds of the variables has 3 entries; expected 4"},
    {[](Hs071& p) { p.variables_.names.pop_back(); },
     "nlp: names of the variables has 3 entries; expected 4"},
    {[](Hs071& p) { p.variables_.lower[2] = 6.0; },
     "nlp: variable 2 (x2): the lower bound 6 exceeds the upper bound 5"},
    {[](Hs071& p) { p.variables_.upper[1] = kNan; },
     "nlp: variable 1 (x1): the bounds are 1 and nan; expected numbers, infinite where there is no "
     "bound"},
    {[](Hs071& p) { p.variables_.start[0] = kNan; },
     "nlp: variable 0 (x0): the start is nan; expected a finite number"},
    {[](Hs071& p) { p.variables_.start[0] = kInfinity; },
     "nlp: variable 0 (x0): the start is inf; expected a finite number"},
    {[](Hs071& p) { p.variables_.start[3] = 0.5; },
     "nlp: variable 3 (x3): the start 0.5 is outside its bounds 1 to 5"},
    {[](Hs071& p) { p.variables_.scale = Eigen::Vector4d(1, 1, 0, 1); },
     "nlp: variable 2 (x2): the scale is 0; expected a positive number"},
    {[](Hs071& p) { p.variables_.lower = p.variables_.upper = p.variables_.start; },
     "nlp: no free variable: all 4 have equal lower and upper bounds; widen at least one"},
    {[](Hs071& p) { p.limits_.lower[1] = 41.0; },
     "nlp: constraint 1 (sphere): the lower bound 41 exceeds the upper bound 40"},
    {[](Hs071& p) { p.limits_.scale = Eigen::Vector2d(1.0, -2.0); },
     "nlp: constraint 1 (sphere): the scale is -2; expected a positive number"},
    {[](Hs071& p) { p.limits_.scale = Eigen::Vector3d(1.0, 1.0, 1.0); },
     "nlp: scale of the constraints has 3 entries; expected 2"},
    {[](Hs071& p) { p.limits_.upper.resize(1); },
     "nlp: upper bounds of the constraints has 1 entries; expected 2"},
    {[](Hs071& p) { p.pattern_.rows.pop_back(); },
     "nlp: columns of the Jacobian pattern has 8 entries; expected 7"},
    {[](Hs071& p) { p.pattern_.columns[5] = 4; },
     "nlp: entry 5 of the Jacobian pattern is at row 1, column 4; the Jacobian is 2 x 4"},
};

TEST(EveryBadProgram, IsRefusedWithItsMessage) {
  for (const BadProgram& bad : kBadPrograms) {
    Hs071 program;
    EXPECT_NO_THROW(validate(program));
    bad.spoil(program);
    EXPECT_EQ(message_of<InvalidInput>([&] { validate(program); }), bad.message);
  }
}

TEST(EveryBadHessian, IsRefusedWithItsMessage) {
  Hs071 program;
  EXPECT_NO_THROW(validate_hessian(program, HessianKind::kExact));
  program.hessian_pattern_.rows[1] = 0;
  program.hessian_pattern_.columns[1] = 1;
  const auto refusal = [&] { validate_hessian(program, HessianKind::kExact); };
  EXPECT_EQ(message_of<InvalidInput>(refusal),
            "nlp: entry 1 of the Hessian pattern is at row 0, column 1; expected the lower "
            "triangle, row >= column");
  program.hessian_pattern_.rows[1] = 4;
  EXPECT_EQ(message_of<InvalidInput>(refusal),
            "nlp: entry 1 of the Hessian pattern is at row 4, column 1; the Hessian is 4 x 4");
  EXPECT_NO_THROW(validate_hessian(program, HessianKind::kLimitedMemory)) << "nothing is asked";
}

TEST(LargestViolation, NamesTheWorstConstraintOrBound) {
  const Hs071 program;
  const Eigen::Vector4d inside(2, 2, 2, 2);
  Violation worst = largest_violation(program, inside, Eigen::Vector2d(30, 40));
  EXPECT_EQ(worst.amount, 0.0);
  EXPECT_EQ(worst.name, "");
  worst = largest_violation(program, inside, Eigen::Vector2d(20, 42));
  EXPECT_EQ(worst.amount, 5.0);
  EXPECT_EQ(worst.name, "product");
  worst = largest_violation(program, Eigen::Vector4d(2, 2, 9, 2), Eigen::Vector2d(30, 43));
  EXPECT_EQ(worst.amount, 4.0);
  EXPECT_EQ(worst.name, "x2");
}

TEST(LargestViolation, ComparesInTypicalSizes) {
  Hs071 program;
  program.limits_.scale = Eigen::Vector2d(1.0, 0.1);
  const Violation worst =
      largest_violation(program, Eigen::Vector4d(2, 2, 2, 2), Eigen::Vector2d(22, 41));
  EXPECT_EQ(worst.name, "sphere");
  EXPECT_EQ(worst.amount, 1.0);
  EXPECT_EQ(worst.relative, 10.0);
}

}  // namespace
}  // namespace hbar::solvers
