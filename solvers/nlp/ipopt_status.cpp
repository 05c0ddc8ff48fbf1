#include <string_view>

#include "hbar/solvers/nlp/ipopt.h"

namespace hbar::solvers {

std::string_view to_string(IpoptStatus status) {
  switch (status) {
    case IpoptStatus::kOptimal:
      return "optimal";
    case IpoptStatus::kAcceptable:
      return "optimal to the acceptable tolerance";
    case IpoptStatus::kFeasible:
      return "feasible point of a square system";
    case IpoptStatus::kInterrupted:
      return "interrupted";
    case IpoptStatus::kStopped:
      return "stopped by the callback";
    case IpoptStatus::kIterationLimit:
      return "iteration limit";
    case IpoptStatus::kTimeLimit:
      return "time limit";
    case IpoptStatus::kInfeasible:
      return "locally infeasible";
    case IpoptStatus::kStepTooSmall:
      return "search direction too small";
    case IpoptStatus::kDiverging:
      return "diverging";
    case IpoptStatus::kRestorationFailed:
      return "restoration failed";
    case IpoptStatus::kStepFailed:
      return "step could not be computed";
    case IpoptStatus::kEvaluationFailed:
      return "evaluation failed";
    case IpoptStatus::kTooFewVariables:
      return "more equations than free variables";
    case IpoptStatus::kOutOfMemory:
      return "out of memory";
    case IpoptStatus::kInternalError:
      return "internal error";
  }
  return "unknown";
}

std::string_view advice(IpoptStatus status) {
  switch (status) {
    case IpoptStatus::kOptimal:
      return "";
    case IpoptStatus::kAcceptable:
      return "for more digits check the gradients and scale the variables";
    case IpoptStatus::kFeasible:
      return "there are as many equations as free variables, so nothing was left to optimise";
    case IpoptStatus::kInterrupted:
    case IpoptStatus::kStopped:
      return "start again from this point to go on";
    case IpoptStatus::kIterationLimit:
      return "raise max_iterations, start from this point, or scale the variables";
    case IpoptStatus::kTimeLimit:
      return "raise max_wall_time or start from this point";
    case IpoptStatus::kInfeasible:
      return "the constraints contradict each other near this point: relax the one named or "
             "start elsewhere";
    case IpoptStatus::kStepTooSmall:
    case IpoptStatus::kStepFailed:
      return "check the gradients (check_gradients) and scale variables and constraints";
    case IpoptStatus::kDiverging:
      return "the objective seems to have no minimum: add bounds";
    case IpoptStatus::kRestorationFailed:
      return "check the Jacobian (check_gradients), relax the constraint named, or start "
             "elsewhere";
    case IpoptStatus::kEvaluationFailed:
      return "start where the program can be evaluated, or tighten the bounds";
    case IpoptStatus::kTooFewVariables:
      return "remove equations or free variables";
    case IpoptStatus::kOutOfMemory:
      return "make the problem smaller";
    case IpoptStatus::kInternalError:
      return "look at Ipopt's own output with print_level = 5";
  }
  return "";
}

}  // namespace hbar::solvers
