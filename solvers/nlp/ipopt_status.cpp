#include <IpIpoptApplication.hpp>
#include <string_view>

#include "hbar/solvers/nlp/ipopt_run.h"

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

// Ipopt's numbers changed between versions, its names did not.
IpoptStatus status_of(int returned) {
  switch (returned) {
    case Ipopt::Solve_Succeeded:
      return IpoptStatus::kOptimal;
    case Ipopt::Solved_To_Acceptable_Level:
      return IpoptStatus::kAcceptable;
    case Ipopt::Infeasible_Problem_Detected:
      return IpoptStatus::kInfeasible;
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return IpoptStatus::kStepTooSmall;
    case Ipopt::Diverging_Iterates:
      return IpoptStatus::kDiverging;
    case Ipopt::User_Requested_Stop:
      return IpoptStatus::kStopped;
    case Ipopt::Feasible_Point_Found:
      return IpoptStatus::kFeasible;
    case Ipopt::Maximum_Iterations_Exceeded:
      return IpoptStatus::kIterationLimit;
    case Ipopt::Restoration_Failed:
      return IpoptStatus::kRestorationFailed;
    case Ipopt::Error_In_Step_Computation:
      return IpoptStatus::kStepFailed;
    case Ipopt::Maximum_CpuTime_Exceeded:
      return IpoptStatus::kTimeLimit;
#if defined(IPOPT_VERSION_MINOR) && \
    (IPOPT_VERSION_MAJOR > 3 || (IPOPT_VERSION_MAJOR == 3 && IPOPT_VERSION_MINOR >= 14))
    case Ipopt::Maximum_WallTime_Exceeded:
      return IpoptStatus::kTimeLimit;
#endif
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return IpoptStatus::kTooFewVariables;
    case Ipopt::Invalid_Number_Detected:
      return IpoptStatus::kEvaluationFailed;
    case Ipopt::Insufficient_Memory:
      return IpoptStatus::kOutOfMemory;
    default:
      return IpoptStatus::kInternalError;
  }
}

}  // namespace hbar::solvers
