#include "hbar/solvers/nlp/nlp_evaluator.h"

#include <cmath>

namespace hbar::solvers {

NlpEvaluator::NlpEvaluator(Nlp& nlp, double tolerance) : nlp_(nlp), tolerance_(tolerance) {}

void NlpEvaluator::move_to(const Eigen::VectorXd& x) {
  if (x_.size() == x.size() && x_ == x) {
    return;
  }
  x_ = x;
  f_state_ = g_state_ = c_state_ = jacobian_state_ = hessian_state_ = State::kUnknown;
  // Without constraints there is nothing to evaluate.
  if (nlp_.constraint_limits().lower.size() == 0) {
    c_.resize(0);
    c_state_ = State::kKnown;
  }
}

/// Calls once per x; `call` returns whether the value is usable.
template <typename Call>
bool NlpEvaluator::evaluate(State& state, int& count, const Call& call) {
  if (state != State::kUnknown) {
    return state == State::kKnown;
  }
  if (exception_ != nullptr) {
    return false;
  }
  state = State::kFailed;
  ++count;
  try {
    if (call()) {
      state = State::kKnown;
    }
  } catch (const EvaluationError& error) {
    last_failure_ = error.what();
  } catch (const Interrupted& error) {  // by the optimiser's own flag, which it looks at itself
    last_failure_ = error.what();
  } catch (...) {
    exception_ = std::current_exception();
    return false;
  }
  if (state == State::kFailed) {
    ++counts_.failures;
  }
  return state == State::kKnown;
}

bool NlpEvaluator::finite_or_fail(const Eigen::VectorXd& values, Eigen::Index size,
                                  const char* what) {
  if (values.size() != size) {
    throw InvalidInput(
        concat("nlp: ", what, " was resized to ", values.size(), " entries; expected ", size));
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    if (std::isfinite(values[i])) {
      continue;
    }
    last_failure_ = concat("nlp: entry ", i, " of ", what, " is ", values[i]);
    return false;
  }
  return true;
}

const double* NlpEvaluator::objective(const Eigen::VectorXd& x) {
  move_to(x);
  const bool fresh = f_state_ == State::kUnknown;
  const bool known = evaluate(f_state_, counts_.objective, [&] {
    f_ = nlp_.objective(x_);
    if (!std::isfinite(f_)) {
      last_failure_ = concat("nlp: the objective is ", f_);
    }
    return std::isfinite(f_);
  });
  if (known && fresh) {
    remember_if_best();
  }
  return known ? &f_ : nullptr;
}

const Eigen::VectorXd* NlpEvaluator::gradient(const Eigen::VectorXd& x) {
  move_to(x);
  const bool known = evaluate(g_state_, counts_.gradient, [&] {
    g_.setZero(x_.size());
    nlp_.objective_gradient(x_, g_);
    return finite_or_fail(g_, x_.size(), "the objective's gradient");
  });
  return known ? &g_ : nullptr;
}

const Eigen::VectorXd* NlpEvaluator::constraints(const Eigen::VectorXd& x) {
  move_to(x);
  const bool fresh = c_state_ == State::kUnknown;
  const bool known = evaluate(c_state_, counts_.constraints, [&] {
    const Eigen::Index m = nlp_.constraint_limits().lower.size();
    c_.setZero(m);
    nlp_.constraints(x_, c_);
    return finite_or_fail(c_, m, "the constraints");
  });
  if (known && fresh) {
    remember_if_best();
  }
  return known ? &c_ : nullptr;
}

const Eigen::VectorXd* NlpEvaluator::jacobian(const Eigen::VectorXd& x) {
  move_to(x);
  const bool known = evaluate(jacobian_state_, counts_.jacobian, [&] {
    const auto entries = static_cast<Eigen::Index>(nlp_.jacobian_pattern().rows.size());
    jacobian_.setZero(entries);
    nlp_.constraint_jacobian(x_, jacobian_);
    return finite_or_fail(jacobian_, entries, "the constraints' Jacobian");
  });
  return known ? &jacobian_ : nullptr;
}

const Eigen::VectorXd* NlpEvaluator::hessian(const Eigen::VectorXd& x, double sigma,
                                             const Eigen::VectorXd& lambda, HessianKind kind) {
  move_to(x);
  const bool same =
      sigma == sigma_ && kind == kind_ && lambda.size() == lambda_.size() && lambda == lambda_;
  if (!same) {
    sigma_ = sigma;
    kind_ = kind;
    lambda_ = lambda;
    hessian_state_ = State::kUnknown;
  }
  const bool known = evaluate(hessian_state_, counts_.hessian, [&] {
    const auto entries = static_cast<Eigen::Index>(nlp_.hessian_pattern(kind).rows.size());
    hessian_.setZero(entries);
    nlp_.lagrangian_hessian(x_, sigma, lambda, kind, hessian_);
    return finite_or_fail(hessian_, entries, "the Lagrangian's Hessian");
  });
  return known ? &hessian_ : nullptr;
}

void NlpEvaluator::remember_if_best() {
  if (f_state_ != State::kKnown || c_state_ != State::kKnown) {
    return;
  }
  const double violation = largest_violation(nlp_, x_, c_).relative;
  const bool feasible = violation <= tolerance_;
  const bool better = !best_.found || (feasible && !best_.feasible) ||
                      (feasible && best_.feasible && f_ < best_.objective) ||
                      (!feasible && !best_.feasible && violation < best_.violation);
  if (better) {
    best_ = {true, feasible, x_, c_, f_, violation};
  }
}

}  // namespace hbar::solvers
