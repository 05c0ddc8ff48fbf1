#include <string_view>

#include "hbar/solvers/nlp/nlopt.h"

namespace hbar::solvers {

std::string_view to_string(NloptStatus status) {
  switch (status) {
    case NloptStatus::kOptimal:
      return "optimal";
    case NloptStatus::kStalled:
      return "stalled";
    case NloptStatus::kRounding:
      return "limited by rounding";
    case NloptStatus::kInterrupted:
      return "interrupted";
    case NloptStatus::kStopped:
      return "stopped by the callback";
    case NloptStatus::kEvaluationLimit:
      return "evaluation limit";
    case NloptStatus::kTimeLimit:
      return "time limit";
    case NloptStatus::kEvaluationFailed:
      return "evaluation failed";
    case NloptStatus::kOutOfMemory:
      return "out of memory";
    case NloptStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

std::string_view advice(NloptStatus status) {
  switch (status) {
    case NloptStatus::kOptimal:
      return "";
    case NloptStatus::kStalled:
    case NloptStatus::kRounding:
    case NloptStatus::kFailed:
      return "check the gradients (check_gradients), scale the variables, or start elsewhere";
    case NloptStatus::kInterrupted:
    case NloptStatus::kStopped:
      return "start again from this point to go on";
    case NloptStatus::kEvaluationLimit:
      return "raise max_evaluations, start from this point, or scale the variables";
    case NloptStatus::kTimeLimit:
      return "raise max_wall_time or start from this point";
    case NloptStatus::kEvaluationFailed:
      return "start where the program can be evaluated";
    case NloptStatus::kOutOfMemory:
      return "make the problem smaller, or take L-BFGS";
  }
  return "";
}

}  // namespace hbar::solvers
