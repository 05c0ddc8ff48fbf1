#include "hbar/solvers/ipopt.h"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "hbar/solvers/ipopt_options.h"

namespace hbar::solvers {
namespace {

using Ipopt::Index;
using Ipopt::Number;
using Clock = std::chrono::steady_clock;

/// Holds Ipopt for one thread; a second run inside the first is refused instead of waiting forever.
class ExclusiveRun {
 public:
  ExclusiveRun() {
    if (running_here()) {
      throw InvalidInput("ipopt: solve_with_ipopt was called from inside an optimisation");
    }
    lock_ = std::unique_lock<std::mutex>(mutex());
    running_here() = true;
  }
  ExclusiveRun(const ExclusiveRun&) = delete;
  ExclusiveRun& operator=(const ExclusiveRun&) = delete;
  ~ExclusiveRun() { running_here() = false; }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  static bool& running_here() {
    thread_local bool running = false;
    return running;
  }
  std::unique_lock<std::mutex> lock_;
};

/// What an Nlp looks like to Ipopt: x divided by its scale, C arrays, false for failure.
class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(Nlp& nlp, const IpoptOptions& options)
      : variables_(nlp.variables()),
        constraints_(nlp.constraint_limits()),
        pattern_(nlp.jacobian_pattern()),
        options_(options),
        evaluator_(nlp, options.constraint_tolerance) {
    scale_ = variables_.scale.size() > 0 ? variables_.scale
                                         : Eigen::VectorXd(Eigen::VectorXd::Ones(n()));
    result_.constraint_multipliers.setZero(m());
    result_.lower_multipliers.setZero(n());
    result_.upper_multipliers.setZero(n());
  }

  bool get_nlp_info(Index& count, Index& constraint_count, Index& jacobian_count,
                    Index& hessian_count, IndexStyleEnum& style) override {
    count = static_cast<Index>(n());
    constraint_count = static_cast<Index>(m());
    jacobian_count = static_cast<Index>(pattern_.rows.size());
    hessian_count = 0;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_l, Number* x_u, Index, Number* g_l, Number* g_u) override {
    const auto bound = [](double value) { return std::clamp(value, -1e20, 1e20); };
    for (Index i = 0; i < n(); ++i) {
      x_l[i] = bound(variables_.lower[i] / scale_[i]);
      x_u[i] = bound(variables_.upper[i] / scale_[i]);
    }
    for (Index i = 0; i < m(); ++i) {
      g_l[i] = bound(constraints_.lower[i]);
      g_u[i] = bound(constraints_.upper[i]);
    }
    return true;
  }

  bool get_starting_point(Index, bool init_x, Number* x, bool init_z, Number*, Number*, Index,
                          bool init_lambda, Number*) override {
    if (init_z || init_lambda) return false;
    if (init_x) Eigen::Map<Eigen::VectorXd>(x, n()) = variables_.start.cwiseQuotient(scale_);
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    if (must_stop()) return false;
    const double* f = evaluator_.objective(unscaled(x));
    if (f != nullptr) value = *f;
    return f != nullptr;
  }

  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    if (must_stop()) return false;
    const Eigen::VectorXd* g = evaluator_.gradient(unscaled(x));
    if (g != nullptr) Eigen::Map<Eigen::VectorXd>(gradient, n()) = g->cwiseProduct(scale_);
    return g != nullptr;
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* values) override {
    if (must_stop()) return false;
    const Eigen::VectorXd* c = evaluator_.constraints(unscaled(x));
    if (c != nullptr) Eigen::Map<Eigen::VectorXd>(values, m()) = *c;
    return c != nullptr;
  }

  bool eval_jac_g(Index, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values == nullptr) {
      std::copy(pattern_.rows.begin(), pattern_.rows.end(), rows);
      std::copy(pattern_.columns.begin(), pattern_.columns.end(), columns);
      return true;
    }
    if (must_stop()) return false;
    const Eigen::VectorXd* jacobian = evaluator_.jacobian(unscaled(x));
    if (jacobian == nullptr) return false;
    for (std::size_t k = 0; k < pattern_.columns.size(); ++k) {
      values[k] = (*jacobian)[static_cast<Eigen::Index>(k)] * scale_[pattern_.columns[k]];
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number objective,
                             Number inf_pr, Number inf_du, Number mu, Number d_norm,
                             Number regularization, Number, Number alpha_primal, Index trials,
                             const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    result_.iterations = iteration;
    if (must_stop()) return false;
    if (!options_.on_iteration) return true;
    try {
      const bool restoring = mode == Ipopt::RestorationPhaseMode;
      const bool go_on =
          options_.on_iteration({iteration, restoring, objective, inf_pr, inf_du, mu, d_norm,
                                 alpha_primal, regularization, trials, elapsed()});
      if (!go_on) stopped_ = IpoptStatus::kStopped;
    } catch (...) {
      exception_ = std::current_exception();
    }
    return !must_stop();
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number* z_L,
                         const Number* z_U, Index, const Number*, const Number* lambda, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    using Vector = Eigen::Map<const Eigen::VectorXd>;
    last_x_ = unscaled(x).cwiseMax(variables_.lower).cwiseMin(variables_.upper);
    result_.lower_multipliers = Vector(z_L, n()).cwiseQuotient(scale_);
    result_.upper_multipliers = Vector(z_U, n()).cwiseQuotient(scale_);
    if (m() > 0) result_.constraint_multipliers = Vector(lambda, m());
  }

  /// The exception of the program or of the callback, if there was one.
  [[nodiscard]] std::exception_ptr exception() const {
    return exception_ != nullptr ? exception_ : evaluator_.exception();
  }

  /// The result, given how Ipopt says it ended.
  [[nodiscard]] IpoptResult take_result(IpoptStatus status, Nlp& nlp);

 private:
  [[nodiscard]] Eigen::Index n() const { return variables_.start.size(); }
  [[nodiscard]] Eigen::Index m() const { return constraints_.lower.size(); }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }
  [[nodiscard]] Eigen::VectorXd unscaled(const Number* x) const {
    return Eigen::Map<const Eigen::VectorXd>(x, n()).cwiseProduct(scale_);
  }

  /// Whether the run is over; also asked between evaluations, since one may take long.
  bool must_stop() {
    if (exception() != nullptr) return true;
    if (stopped_ || !evaluator_.best().found) return stopped_.has_value();
    if (options_.stop != nullptr && options_.stop->load()) {
      stopped_ = IpoptStatus::kInterrupted;
    } else if (elapsed() > options_.max_wall_time) {
      stopped_ = IpoptStatus::kTimeLimit;
    }
    return stopped_.has_value();
  }

  const NlpVariables variables_;
  const NlpConstraints constraints_;
  const SparsityPattern pattern_;
  const IpoptOptions& options_;
  NlpEvaluator evaluator_;
  Eigen::VectorXd scale_;
  Clock::time_point begin_ = Clock::now();
  Eigen::VectorXd last_x_;
  std::optional<IpoptStatus> stopped_;
  std::exception_ptr exception_;
  IpoptResult result_;
};

IpoptResult Adapter::take_result(IpoptStatus status, Nlp& nlp) {
  IpoptResult& r = result_;
  r.status = stopped_.value_or(status);
  const BestPoint& best = evaluator_.best();
  const bool use_last = (r.converged() || r.status == IpoptStatus::kFeasible) && last_x_.size() > 0;
  const double* f = use_last ? evaluator_.objective(last_x_) : nullptr;
  const Eigen::VectorXd* c = use_last ? evaluator_.constraints(last_x_) : nullptr;
  if (f != nullptr && c != nullptr) {
    r.x = last_x_;
    r.c = *c;
    r.objective = *f;
  } else if (best.found) {
    r.x = best.x;
    r.c = best.c;
    r.objective = best.objective;
  } else {
    r.x = variables_.start;
    r.c.setConstant(m(), std::numeric_limits<double>::quiet_NaN());
    r.objective = std::numeric_limits<double>::quiet_NaN();
  }
  r.violation = largest_violation(nlp, r.x, r.c);
  r.feasible = best.found && r.violation.amount <= options_.constraint_tolerance;
  r.evaluations = evaluator_.counts();
  r.elapsed = elapsed();
  r.message = concat("ipopt: ", to_string(r.status), " after ", r.iterations, " iterations: ");
  if (best.found) {
    r.message += concat(r.feasible ? "feasible" : "infeasible", ", objective ", r.objective,
                        ", largest violation ", r.violation.amount);
    if (r.violation.amount > 0.0) r.message += concat(" (", r.violation.name, ")");
  } else {
    r.message += "no point could be evaluated";
  }
  if (!r.converged() && r.evaluations.failures > 0) {
    r.message += concat("; ", r.evaluations.failures,
                        " evaluations failed, the last with: ", evaluator_.last_failure());
  }
  if (!advice(r.status).empty()) r.message += concat("; ", advice(r.status));
  return r;
}

// Ipopt's numbers changed between versions, its names did not.
IpoptStatus translate(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
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

/// An object that counts its references, as Ipopt wants them.
template <typename T, typename... Args>
Ipopt::SmartPtr<T> make_counted(Args&&... args) {
  return new T(std::forward<Args>(args)...);  // NOLINT(hbar-naked-new): the SmartPtr owns it
}

}  // namespace

IpoptResult solve_with_ipopt(Nlp& nlp, const IpoptOptions& options) {
  validate(nlp);
  if (!(options.max_wall_time > 0.0)) {
    throw InvalidInput(concat("ipopt: max_wall_time is ", options.max_wall_time,
                              "; expected a positive number of seconds"));
  }
  if (!(options.constraint_tolerance > 0.0)) {
    throw InvalidInput(concat("ipopt: constraint_tolerance is ", options.constraint_tolerance,
                              "; expected a positive number"));
  }
  const ExclusiveRun run;
  // Without a console Ipopt prints nothing, whatever happens.
  const auto application = make_counted<Ipopt::IpoptApplication>(options.print_level > 0);
  set_ipopt_options(*application, options);
  // The empty name stands for "read no file of options".
  const std::string no_file;
  Ipopt::ApplicationReturnStatus status = application->Initialize(no_file);
  if (status != Ipopt::Solve_Succeeded) {
    throw InvalidInput(concat("ipopt: Ipopt refused its options (", static_cast<int>(status), ")"));
  }
  const auto adapter = make_counted<Adapter>(nlp, options);
  status = application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(adapter)));
  if (adapter->exception() != nullptr) std::rethrow_exception(adapter->exception());
  return adapter->take_result(translate(status), nlp);
}

}  // namespace hbar::solvers
