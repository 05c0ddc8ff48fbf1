#include "hbar/solvers/nlp/ipopt_run.h"

#include <IpIpoptApplication.hpp>
#include <IpJournalist.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "hbar/solvers/linear/mutual_exclusion.h"
#include "hbar/solvers/nlp/ipopt_iterate.h"
#include "hbar/solvers/nlp/scaled_nlp.h"

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

using Input = Eigen::Map<const Eigen::VectorXd>;
using Output = Eigen::Map<Eigen::VectorXd>;

/// An Nlp as Ipopt sees it: scaled, in C arrays, false for failure.
class Adapter final : public Ipopt::TNLP {
 public:
  /// @param mumps  held by this thread; given back during the callbacks
  Adapter(Nlp& nlp, const IpoptOptions& options, std::unique_lock<std::mutex>& mumps)
      : nlp_(nlp),
        options_(options),
        mumps_(mumps),
        program_(nlp, options.constraint_tolerance, options.objective_scale, options.hessian) {
    PrimalDualPoint start;
    start.x = nlp.variables().start;
    start_ = program_.scaled(options.warm_start.value_or(start));
    last_ = start_;
  }

  bool get_nlp_info(Index& count, Index& constraint_count, Index& jacobian_count,
                    Index& hessian_count, IndexStyleEnum& style) override {
    count = static_cast<Index>(n());
    constraint_count = static_cast<Index>(m());
    jacobian_count = static_cast<Index>(program_.jacobian_pattern().rows.size());
    hessian_count = static_cast<Index>(program_.hessian_pattern().rows.size());
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index, Number* x_l, Number* x_u, Index, Number* g_l, Number* g_u) override {
    // Ipopt's infinity.
    const auto bounded = [](const Eigen::VectorXd& v) { return v.cwiseMax(-1e20).cwiseMin(1e20); };
    Output(x_l, n()) = bounded(program_.scaled_lower());
    Output(x_u, n()) = bounded(program_.scaled_upper());
    if (m() == 0) {
      return true;
    }
    Output(g_l, m()) = bounded(program_.scaled_constraint_lower());
    Output(g_u, m()) = bounded(program_.scaled_constraint_upper());
    return true;
  }

  bool get_starting_point(Index, bool init_x, Number* x, bool init_z, Number* z_L, Number* z_U,
                          Index, bool init_lambda, Number* lambda) override {
    if (init_x) {
      Output(x, n()) = start_.x;
    }
    if (init_z) {
      Output(z_L, n()) = start_.lower_multipliers;
    }
    if (init_z) {
      Output(z_U, n()) = start_.upper_multipliers;
    }
    if (init_lambda && m() > 0) {
      Output(lambda, m()) = start_.constraint_multipliers;
    }
    return true;
  }

  bool eval_f(Index, const Number* x, bool, Number& value) override {
    const Unlocked callback(mumps_);
    return !must_stop() && program_.scaled_objective(Input(x, n()), value);
  }

  bool eval_grad_f(Index, const Number* x, bool, Number* gradient) override {
    const Unlocked callback(mumps_);
    return !must_stop() && program_.scaled_gradient(Input(x, n()), Output(gradient, n()));
  }

  bool eval_g(Index, const Number* x, bool, Index, Number* values) override {
    const Unlocked callback(mumps_);
    return !must_stop() && program_.scaled_constraints(Input(x, n()), Output(values, m()));
  }

  bool eval_jac_g(Index, const Number* x, bool, Index, Index entries, Index* rows, Index* columns,
                  Number* values) override {
    if (values == nullptr) {
      return copy_pattern(program_.jacobian_pattern(), rows, columns);
    }
    const Unlocked callback(mumps_);
    return !must_stop() && program_.scaled_jacobian(Input(x, n()), Output(values, entries));
  }

  bool eval_h(Index, const Number* x, bool, Number sigma, Index, const Number* lambda, bool,
              Index entries, Index* rows, Index* columns, Number* values) override {
    if (options_.hessian == HessianKind::kLimitedMemory) {
      return false;
    }
    if (values == nullptr) {
      return copy_pattern(program_.hessian_pattern(), rows, columns);
    }
    const Unlocked callback(mumps_);
    return !must_stop() && program_.scaled_hessian(Input(x, n()), sigma, Input(lambda, m()),
                                                   Output(values, entries));
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number objective,
                             Number inf_pr, Number inf_du, Number mu, Number d_norm,
                             Number regularization, Number, Number alpha_primal, Index trials,
                             const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* computed) override {
    if (options_.on_checkpoint) {
      static_cast<void>(read_ipopt_iterate(*this, data, computed, last_));  // or the one before
    }
    const Unlocked callback(mumps_);
    iterations_ = iteration;
    mu_ = mu;
    if (must_stop()) {
      return false;
    }
    if (!options_.on_iteration) {
      return true;
    }
    try {
      const bool restoring = mode == Ipopt::RestorationPhaseMode;
      const bool go_on = options_.on_iteration(
          {iteration, restoring, objective * program_.objective_scale(), inf_pr, inf_du, mu, d_norm,
           alpha_primal, regularization, trials, elapsed()});
      if (!go_on) {
        stopped_ = IpoptStatus::kStopped;
      }
    } catch (...) {
      exception_ = std::current_exception();
    }
    return !must_stop();
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number* z_L,
                         const Number* z_U, Index, const Number*, const Number* lambda, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    last_.x = Input(x, n());
    last_.lower_multipliers = Input(z_L, n());
    last_.upper_multipliers = Input(z_U, n());
    if (m() > 0) {
      last_.constraint_multipliers = Input(lambda, m());
    }
    finished_ = true;
  }

  /// The exception of the program or of the callback, if there was one.
  [[nodiscard]] std::exception_ptr exception() const {
    return exception_ != nullptr ? exception_ : program_.evaluator().exception();
  }

  /// The result, given how Ipopt says it ended.
  [[nodiscard]] IpoptResult result(IpoptStatus status);

 private:
  [[nodiscard]] Eigen::Index n() const { return program_.variable_count(); }
  [[nodiscard]] Eigen::Index m() const { return program_.constraint_count(); }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(Clock::now() - begin_).count();
  }
  static bool copy_pattern(const SparsityPattern& pattern, Index* rows, Index* columns) {
    std::copy(pattern.rows.begin(), pattern.rows.end(), rows);
    std::copy(pattern.columns.begin(), pattern.columns.end(), columns);
    return true;
  }

  /// Whether the run is over; also asked between evaluations, since one may take long.
  bool must_stop() {
    if (exception() != nullptr) {
      return true;
    }
    save_if_due();
    if (exception() != nullptr) {
      return true;
    }
    if (stopped_ || !program_.evaluator().best().found) {
      return stopped_.has_value();
    }
    if (options_.stop != nullptr && options_.stop->load()) {
      stopped_ = IpoptStatus::kInterrupted;
    } else if (elapsed() > options_.max_wall_time) {
      stopped_ = IpoptStatus::kTimeLimit;
    }
    return stopped_.has_value();
  }

  /// Hands out a checkpoint if it is time for one.
  void save_if_due() {
    if (!options_.on_checkpoint || !program_.evaluator().best().found ||
        (saved_at_ && elapsed() - *saved_at_ < options_.checkpoint_every)) {
      return;
    }
    saved_at_ = elapsed();
    try {
      options_.on_checkpoint(result(IpoptStatus::kInterrupted));
    } catch (...) {
      exception_ = std::current_exception();
    }
  }

  Nlp& nlp_;
  const IpoptOptions& options_;
  std::unique_lock<std::mutex>& mumps_;
  ScaledNlp program_;
  PrimalDualPoint start_;  // scaled
  PrimalDualPoint last_;   // scaled
  bool finished_ = false;  // last_ is Ipopt's
  Clock::time_point begin_ = Clock::now();
  std::optional<IpoptStatus> stopped_;
  std::exception_ptr exception_;
  std::optional<double> saved_at_;  // elapsed() at the last checkpoint
  int iterations_ = 0;
  double mu_ = 0.0;
};

IpoptResult Adapter::result(IpoptStatus status) {
  IpoptResult r;
  r.iterations = iterations_;
  r.mu = mu_;
  r.status = stopped_.value_or(status);
  NlpEvaluator& evaluator = program_.evaluator();
  const PrimalDualPoint last = program_.unscaled(last_);
  r.constraint_multipliers = last.constraint_multipliers;
  r.lower_multipliers = last.lower_multipliers;
  r.upper_multipliers = last.upper_multipliers;
  const BestPoint& best = evaluator.best();
  const bool use_last = (r.converged() || r.status == IpoptStatus::kFeasible) && finished_;
  const double* f = use_last ? evaluator.objective(last.x) : nullptr;
  const Eigen::VectorXd* c = use_last ? evaluator.constraints(last.x) : nullptr;
  if (f != nullptr && c != nullptr) {
    r.x = last.x;
    r.c = *c;
    r.objective = *f;
  } else if (best.found) {
    r.x = best.x;
    r.c = best.c;
    r.objective = best.objective;
  } else {
    r.x = program_.unscaled(start_).x;
    r.c.setConstant(m(), std::numeric_limits<double>::quiet_NaN());
    r.objective = std::numeric_limits<double>::quiet_NaN();
  }
  r.violation = largest_violation(nlp_, r.x, r.c);
  r.feasible = best.found && r.violation.relative <= options_.constraint_tolerance;
  r.evaluations = evaluator.counts();
  r.elapsed = elapsed();
  r.message = concat("ipopt: ", to_string(r.status), " after ", r.iterations, " iterations: ");
  if (best.found) {
    r.message += concat(r.feasible ? "feasible" : "infeasible", ", objective ", r.objective,
                        ", largest violation ", r.violation.amount);
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
  return r;
}

/// A reference-counted object, as Ipopt requires.
template <typename T, typename... Args>
Ipopt::SmartPtr<T> make_counted(Args&&... args) {
  return new T(std::forward<Args>(args)...);  // NOLINT(hbar-naked-new): the SmartPtr owns it
}

}  // namespace

IpoptResult run_ipopt(Nlp& nlp, const IpoptOptions& options, std::ostream* journal) {
  validate(nlp);
  validate_hessian(nlp, options.hessian);
  if (!(options.max_wall_time > 0.0)) {
    throw InvalidInput(concat("ipopt: max_wall_time is ", options.max_wall_time,
                              "; expected a positive number of seconds"));
  }
  if (!(options.constraint_tolerance > 0.0)) {
    throw InvalidInput(concat("ipopt: constraint_tolerance is ", options.constraint_tolerance,
                              "; expected a positive number"));
  }
  if (!(options.checkpoint_every >= 0.0)) {
    throw InvalidInput(concat("ipopt: checkpoint_every is ", options.checkpoint_every,
                              "; expected a number of seconds, at least 0"));
  }
  const ExclusiveRun run;
  std::unique_lock<std::mutex> mumps(mumps_mutex());
  // Without a console Ipopt prints nothing, whatever happens.
  const auto application = make_counted<Ipopt::IpoptApplication>(options.print_level > 0);
  if (journal != nullptr) {
    const auto stream = make_counted<Ipopt::StreamJournal>("hbar", Ipopt::J_WARNING);
    stream->SetOutputStream(journal);
    application->Jnlst()->AddJournal(Ipopt::SmartPtr<Ipopt::Journal>(Ipopt::GetRawPtr(stream)));
  }
  set_ipopt_options(*application, options);
  // The empty name stands for "read no file of options".
  const std::string no_file;
  Ipopt::ApplicationReturnStatus status = application->Initialize(no_file);
  if (status != Ipopt::Solve_Succeeded) {
    throw InvalidInput(concat("ipopt: Ipopt refused its options (", static_cast<int>(status), ")"));
  }
  Ipopt::SmartPtr<Adapter> adapter;
  {
    const Unlocked callback(mumps);
    adapter = make_counted<Adapter>(nlp, options, mumps);
  }
  status = application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(adapter)));
  if (adapter->exception() != nullptr) {
    std::rethrow_exception(adapter->exception());
  }
  const Unlocked callback(mumps);
  IpoptResult result = adapter->result(status_of(status));
  if (adapter->exception() != nullptr) {  // the final point is evaluated once more
    std::rethrow_exception(adapter->exception());
  }
  return result;
}

IpoptResult solve_with_ipopt(Nlp& nlp, const IpoptOptions& options) {
  return run_ipopt(nlp, options, nullptr);
}

}  // namespace hbar::solvers
