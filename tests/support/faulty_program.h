#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/programs.h"

namespace hbar::solvers::testing {

/// What a function of a program may do wrong.
enum class Fault {
  kNan,
  kInfinite,
  kEvaluationError,
  kException,
  kBadAlloc,
  kNoException,
  kResize,
  kLogicError
};

inline constexpr Fault kFaults[] = {Fault::kNan,       Fault::kInfinite,  Fault::kEvaluationError,
                                    Fault::kException, Fault::kBadAlloc,  Fault::kNoException,
                                    Fault::kResize,    Fault::kLogicError};

/// Hs071, one of whose calls goes wrong: the k-th of a function, or all from the k-th on.
class FaultyHs071 final : public Hs071 {
 public:
  enum class Function { kObjective, kGradient, kConstraints, kJacobian, kHessian, kNone };

  FaultyHs071(Function function, Fault fault, int place, bool onwards)
      : function_(function), fault_(fault), place_(place), onwards_(onwards) {}

  double objective(const Eigen::VectorXd& x) override {
    Eigen::VectorXd f = Eigen::VectorXd::Constant(1, Hs071::objective(x));
    spoil(Function::kObjective, f);
    return f[0];
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    Hs071::objective_gradient(x, g);
    spoil(Function::kGradient, g);
  }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override {
    Hs071::constraints(x, c);
    spoil(Function::kConstraints, c);
  }
  void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) override {
    Hs071::constraint_jacobian(x, values);
    spoil(Function::kJacobian, values);
  }
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd& lambda,
                          HessianKind kind, Eigen::VectorXd& values) override {
    Hs071::lagrangian_hessian(x, sigma, lambda, kind, values);
    spoil(Function::kHessian, values);
  }

  int happened = 0;  ///< how often it went wrong

 private:
  void spoil(Function function, Eigen::VectorXd& values) {
    if (function != function_) {
      return;
    }
    ++calls_;
    if (calls_ != place_ && !(onwards_ && calls_ > place_)) {
      return;
    }
    ++happened;
    switch (fault_) {
      case Fault::kNan:
        values[values.size() - 1] = std::numeric_limits<double>::quiet_NaN();
        return;
      case Fault::kInfinite:
        values[0] = std::numeric_limits<double>::infinity();
        return;
      case Fault::kEvaluationError:
        throw EvaluationError("deliberate");
      case Fault::kException:
        throw std::runtime_error("thrown by the program");
      case Fault::kBadAlloc:
        throw std::bad_alloc();
      case Fault::kNoException:
        throw 42;  // NOLINT: a program may
      case Fault::kResize:
        if (function != Function::kObjective) {
          values.resize(values.size() + 1);
        }
        return;
      case Fault::kLogicError:
        throw InvalidInput("refused by the program");
    }
  }

  Function function_;
  Fault fault_;
  int place_ = 0;
  bool onwards_ = false;
  int calls_ = 0;
};

/// How a call ended: "returned", or what it threw.
template <typename Call>
std::string ending_of(const Call& call) {
  try {
    call();
    return "returned";
  } catch (const InvalidInput& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    return "bad_alloc";
  } catch (const std::exception& error) {
    return error.what();
  } catch (int number) {
    return std::to_string(number);
  }
}

/// How a run must end in which a function went wrong that way.
inline std::string expected_ending(Fault fault, FaultyHs071::Function function,
                                   const std::string& found) {
  switch (fault) {
    case Fault::kNan:
    case Fault::kInfinite:
    case Fault::kEvaluationError:
      return "returned";
    case Fault::kException:
      return "thrown by the program";
    case Fault::kBadAlloc:
      return "bad_alloc";
    case Fault::kNoException:
      return "42";
    case Fault::kLogicError:
      return "refused by the program";
    case Fault::kResize:
      if (function == FaultyHs071::Function::kObjective) {
        return "returned";
      }
      return found.find(" was resized to ") != std::string::npos ? found : "a refusal of the size";
  }
  return "";
}

/// Lets each function go wrong in every way at every call that a run makes, once and from there on.
///
/// @param solve   runs a program and returns the result
/// @param expect  checks the result of a run that went wrong and returned one
template <typename Solve, typename Expect>
void expect_every_fault(const std::vector<FaultyHs071::Function>& functions, const Solve& solve,
                        const Expect& expect) {
  for (const FaultyHs071::Function function : functions) {
    for (const Fault fault : kFaults) {
      for (const bool onwards : {false, true}) {
        int happened = 1;
        for (int place = 1; happened > 0 && place < 40; ++place) {
          FaultyHs071 program(function, fault, place, onwards);
          decltype(solve(program)) result;
          const std::string found = ending_of([&] { result = solve(program); });
          happened = program.happened;
          SCOPED_TRACE(concat("function ", static_cast<int>(function), ", fault ",
                              static_cast<int>(fault), ", call ", place, onwards ? " on" : ""));
          if (happened == 0) {
            EXPECT_EQ(found, "returned");
            EXPECT_TRUE(result.converged());
            continue;
          }
          ASSERT_EQ(found, expected_ending(fault, function, found));
          if (found == "returned") {
            expect(result);
          }
        }
        EXPECT_EQ(happened, 0);  // every call had its turn
      }
    }
  }
}

}  // namespace hbar::solvers::testing
