#include "hbar/solvers/nlp/nlopt.h"

#include <nlopt.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "hbar/solvers/nlp/active_set.h"
#include "hbar/solvers/nlp/scaled_nlp.h"

namespace hbar::solvers {
namespace {

using Clock = std::chrono::steady_clock;
using View = Eigen::Map<const Eigen::VectorXd>;
using Output = Eigen::Map<Eigen::VectorXd>;

struct Destroy {
  void operator()(nlopt_opt handle) const { nlopt_destroy(handle); }
};
using Handle = std::unique_ptr<nlopt_opt_s, Destroy>;

/// One side of a constraint in NLopt's form: sign (c − bound) ≤ 0, or = 0.
struct Side {
  Eigen::Index constraint;
  double sign;
  double bound;
};

/// One minimisation. NLopt is C: nothing may be thrown through it, so that its callbacks keep
/// exceptions and ask it to stop.
class NloptRun {
 public:
  NloptRun(Nlp& nlp, const NloptOptions& options)
      : options_(options),
        program_(nlp, options.constraint_tolerance, options.objective_scale),
        n_(program_.variable_count()) {
    PrimalDualPoint start;
    start.x = nlp.variables().start;
    start_ = program_.scaled(start).x;
    jacobian_.resize(static_cast<Eigen::Index>(program_.jacobian_pattern().rows.size()));
    c_.resize(program_.constraint_count());
  }

  [[nodiscard]] NloptResult run(Nlp& nlp);

 private:
  static double objective(unsigned, const double* x, double* gradient, void* self) {
    return static_cast<NloptRun*>(self)->evaluate(x, gradient);
  }
  static void inequalities(unsigned, double* values, unsigned, const double* x, double* jacobian,
                           void* self) {
    auto* run = static_cast<NloptRun*>(self);
    run->constrain(run->inequalities_, x, values, jacobian);
  }
  static void equations(unsigned, double* values, unsigned, const double* x, double* jacobian,
                        void* self) {
    auto* run = static_cast<NloptRun*>(self);
    run->constrain(run->equations_, x, values, jacobian);
  }

  [[nodiscard]] nlopt_result minimise();
  void declare_constraints();
  double evaluate(const double* x, double* gradient);
  void constrain(const std::vector<Side>& sides, const double* x, double* values, double* jacobian);
  [[nodiscard]] double failure();
  void report_evaluation(double f);
  [[nodiscard]] bool must_stop();
  [[nodiscard]] NloptStatus translate(nlopt_result code) const;
  void take_best(Nlp& nlp);
  void describe();

  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  const NloptOptions& options_;
  ScaledNlp program_;
  Eigen::Index n_;
  Eigen::VectorXd start_;  // scaled, as all the next
  Eigen::VectorXd c_;
  Eigen::VectorXd jacobian_;
  std::vector<Side> inequalities_;
  std::vector<Side> equations_;
  std::optional<double> worst_;  // largest objective seen
  int evaluations_ = 0;
  Clock::time_point begin_ = Clock::now();
  Handle handle_;
  std::optional<NloptStatus> stopped_;
  std::exception_ptr exception_;
  NloptResult result_;
};

/// A value above all seen: a line search takes it as "too far".
double NloptRun::failure() {
  if (program_.evaluator().exception() != nullptr) {
    exception_ = program_.evaluator().exception();
  }
  if (!worst_ && !stopped_) {
    stopped_ = NloptStatus::kEvaluationFailed;
  }
  if (must_stop()) {
    nlopt_force_stop(handle_.get());
  }
  const double worst = worst_.value_or(0.0);
  return worst + 10.0 * (1.0 + std::abs(worst));
}

double NloptRun::evaluate(const double* x, double* gradient) {
  double f = 0.0;
  const View at(x, n_);
  if (gradient != nullptr) {
    Output(gradient, n_).setZero();
  }
  if (must_stop() || !program_.scaled_objective(at, f)) {
    return failure();
  }
  if (gradient != nullptr && !program_.scaled_gradient(at, Output(gradient, n_))) {
    return failure();
  }
  worst_ = std::max(worst_.value_or(f), f);
  // The evaluator knows a point's violation only after its constraints.
  if (!program_.scaled_constraints(at, c_)) {
    return failure();
  }
  report_evaluation(f);
  return f;
}

void NloptRun::report_evaluation(double f) {
  ++evaluations_;
  if (options_.on_evaluation && !must_stop()) {
    try {
      if (!options_.on_evaluation({evaluations_, f * options_.objective_scale, elapsed()})) {
        stopped_ = NloptStatus::kStopped;
      }
    } catch (...) {
      exception_ = std::current_exception();
    }
  }
  if (must_stop()) {
    nlopt_force_stop(handle_.get());
  }
}

bool NloptRun::must_stop() {
  if (exception_ != nullptr || stopped_) {
    return true;
  }
  if (evaluations_ == 0) {
    return false;  // so that there is a point to report
  }
  if (options_.stop != nullptr && options_.stop->load()) {
    stopped_ = NloptStatus::kInterrupted;
  }
  // NLopt looks at its limit only between line searches.
  if (evaluations_ >= options_.max_evaluations) {
    stopped_ = NloptStatus::kEvaluationLimit;
  }
  if (elapsed() > options_.max_wall_time) {
    stopped_ = NloptStatus::kTimeLimit;
  }
  return stopped_.has_value();
}

void NloptRun::constrain(const std::vector<Side>& sides, const double* x, double* values,
                         double* jacobian) {
  const View at(x, n_);
  const auto count = static_cast<Eigen::Index>(sides.size());
  Output(values, count).setZero();
  if (jacobian != nullptr) {
    Output(jacobian, count * n_).setZero();
  }
  if (must_stop() || !program_.scaled_constraints(at, c_) ||
      (jacobian != nullptr && !program_.scaled_jacobian(at, jacobian_))) {
    // Far from feasible, so that the step is shortened.
    Output(values, count).setConstant(failure());
    return;
  }
  Eigen::MatrixXd dense;
  if (jacobian != nullptr) {
    dense.setZero(n_, c_.size());
    const SparsityPattern& pattern = program_.jacobian_pattern();
    for (std::size_t k = 0; k < pattern.rows.size(); ++k) {
      dense(pattern.columns[k], pattern.rows[k]) += jacobian_[static_cast<Eigen::Index>(k)];
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const Side& side = sides[static_cast<std::size_t>(k)];
    values[k] = side.sign * (c_[side.constraint] - side.bound);
    if (jacobian != nullptr) {
      Output(jacobian + k * n_, n_) = side.sign * dense.col(side.constraint);
    }
  }
}

void NloptRun::declare_constraints() {
  const Eigen::VectorXd lower = program_.scaled_constraint_lower();
  const Eigen::VectorXd upper = program_.scaled_constraint_upper();
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (lower[i] == upper[i]) {
      equations_.push_back({i, 1.0, lower[i]});
      continue;
    }
    if (std::isfinite(lower[i])) {
      inequalities_.push_back({i, -1.0, lower[i]});
    }
    if (std::isfinite(upper[i])) {
      inequalities_.push_back({i, 1.0, upper[i]});
    }
  }
  const auto count = [](const std::vector<Side>& sides) {
    return static_cast<unsigned>(sides.size());
  };
  const std::vector<double> tolerances(std::max(equations_.size(), inequalities_.size()),
                                       options_.constraint_tolerance);
  if (!equations_.empty()) {
    nlopt_add_equality_mconstraint(handle_.get(), count(equations_), &NloptRun::equations, this,
                                   tolerances.data());
  }
  if (!inequalities_.empty()) {
    nlopt_add_inequality_mconstraint(handle_.get(), count(inequalities_), &NloptRun::inequalities,
                                     this, tolerances.data());
  }
}

nlopt_result NloptRun::minimise() {
  const bool lbfgs = options_.algorithm == NloptAlgorithm::kLbfgs;
  handle_.reset(nlopt_create(lbfgs ? NLOPT_LD_LBFGS : NLOPT_LD_SLSQP, static_cast<unsigned>(n_)));
  if (handle_ == nullptr) {
    return NLOPT_OUT_OF_MEMORY;
  }
  nlopt_opt handle = handle_.get();
  nlopt_set_min_objective(handle, &NloptRun::objective, this);
  nlopt_set_lower_bounds(handle, program_.scaled_lower().data());
  nlopt_set_upper_bounds(handle, program_.scaled_upper().data());
  nlopt_set_ftol_abs(handle, options_.objective_tolerance);
  nlopt_set_xtol_abs1(handle, options_.variable_tolerance);
  if (options_.memory > 0) {
    nlopt_set_vector_storage(handle, static_cast<unsigned>(options_.memory));
  }
  declare_constraints();
  double f = 0.0;
  Eigen::VectorXd x = start_;
  return nlopt_optimize(handle, x.data(), &f);
}

NloptStatus NloptRun::translate(nlopt_result code) const {
  if (stopped_) {
    return *stopped_;
  }
  const bool optimal = result_.feasible && result_.stationarity <= options_.optimality_tolerance;
  if (optimal) {
    return NloptStatus::kOptimal;
  }
  switch (code) {
    case NLOPT_OUT_OF_MEMORY:
      return NloptStatus::kOutOfMemory;
    case NLOPT_ROUNDOFF_LIMITED:
      return NloptStatus::kRounding;
    case NLOPT_SUCCESS:
    case NLOPT_FTOL_REACHED:
    case NLOPT_XTOL_REACHED:
      return NloptStatus::kStalled;
    default:
      return NloptStatus::kFailed;
  }
}

void NloptRun::take_best(Nlp& nlp) {
  NloptResult& r = result_;
  const BestPoint& best = program_.evaluator().best();
  PrimalDualPoint point;
  point.x = best.found ? best.x : nlp.variables().start;
  point = program_.scaled(point);
  r.x = program_.unscaled(point).x;
  r.c.setConstant(program_.constraint_count(), std::numeric_limits<double>::quiet_NaN());
  r.objective = r.stationarity = std::numeric_limits<double>::quiet_NaN();
  if (best.found) {
    r.x = best.x;
    r.c = best.c;
    r.objective = best.objective;
    try {
      const MultiplierEstimate estimate =
          estimate_multipliers(program_, point.x, options_.constraint_tolerance);
      point = estimate.point;
      r.stationarity = estimate.stationarity;
    } catch (const EvaluationError&) {
      // Its gradient cannot be evaluated: the stationarity stays unknown.
    }
  }
  point = program_.unscaled(point);
  r.constraint_multipliers = point.constraint_multipliers;
  r.lower_multipliers = point.lower_multipliers;
  r.upper_multipliers = point.upper_multipliers;
  r.violation = largest_violation(nlp, r.x, r.c);
  r.feasible = best.found && r.violation.relative <= options_.constraint_tolerance;
}

void NloptRun::describe() {
  NloptResult& r = result_;
  const NlpEvaluator& evaluator = program_.evaluator();
  r.evaluations = evaluator.counts();
  r.elapsed = elapsed();
  r.message =
      concat("nlopt: ", to_string(r.status), " after ", r.evaluations.objective, " evaluations: ");
  if (evaluator.best().found) {
    r.message += concat(r.feasible ? "feasible" : "infeasible", ", objective ", r.objective,
                        ", gradient of the Lagrangian ", r.stationarity, ", largest violation ",
                        r.violation.amount);
    if (r.violation.amount > 0.0) {
      r.message += concat(" (", r.violation.name, ")");
    }
  } else {
    r.message += "no point could be evaluated";
  }
  if (!r.converged() && r.evaluations.failures > 0) {
    r.message += concat("; ", r.evaluations.failures,
                        " evaluations failed, the last with: ", evaluator.last_failure());
  }
  if (!advice(r.status).empty()) {
    r.message += concat("; ", advice(r.status));
  }
}

NloptResult NloptRun::run(Nlp& nlp) {
  const nlopt_result code = minimise();
  if (exception_ != nullptr) {
    std::rethrow_exception(exception_);
  }
  take_best(nlp);
  if (program_.evaluator().exception() != nullptr) {  // the multipliers ask for derivatives
    std::rethrow_exception(program_.evaluator().exception());
  }
  result_.status = translate(code);
  describe();
  return result_;
}

void refuse_nlopt_options(const NloptOptions& o) {
  const auto refuse = [](const char* name, double value, const char* expected) {
    throw InvalidInput(concat("nlopt: ", name, " is ", value, "; expected ", expected));
  };
  constexpr const char* kPositive = "a positive number";
  constexpr const char* kNotNegative = "a number that is not negative";
  if (!(o.optimality_tolerance > 0.0)) {
    refuse("optimality_tolerance", o.optimality_tolerance, kPositive);
  }
  if (!(o.constraint_tolerance > 0.0)) {
    refuse("constraint_tolerance", o.constraint_tolerance, kPositive);
  }
  if (!(o.objective_tolerance >= 0.0)) {
    refuse("objective_tolerance", o.objective_tolerance, kNotNegative);
  }
  if (!(o.variable_tolerance >= 0.0)) {
    refuse("variable_tolerance", o.variable_tolerance, kNotNegative);
  }
  if (o.max_evaluations < 1) {
    refuse("max_evaluations", o.max_evaluations, kPositive);
  }
  if (!(o.max_wall_time > 0.0)) {
    refuse("max_wall_time", o.max_wall_time, "a positive number of seconds");
  }
  if (o.memory < 0) {
    refuse("memory", o.memory, kNotNegative);
  }
}

}  // namespace

NloptResult minimise_with_nlopt(Nlp& nlp, const NloptOptions& options) {
  validate(nlp);
  refuse_nlopt_options(options);
  const NlpConstraints& limits = nlp.constraint_limits();
  if (options.algorithm == NloptAlgorithm::kLbfgs && limits.lower.size() > 0) {
    throw InvalidInput(concat("nlopt: L-BFGS takes bounds alone, but the program has ",
                              limits.lower.size(), " constraints (the first: ", limits.names[0],
                              "); take NloptAlgorithm::kSlsqp or Ipopt"));
  }
  return NloptRun(nlp, options).run(nlp);
}

}  // namespace hbar::solvers
