#include "measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>

#include "hbar/core/base/error.h"
#include "hbar/solvers/linear/accuracy.h"
#include "hbar/solvers/linear/klu.h"
#include "hbar/suite.h"

namespace hbar::solver_benchmark {
namespace {

using solvers::LinearSolver;
using solvers::System;

double now(Clock clock) {
  if (clock == Clock::kCpu) {
    std::timespec time = {};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Seconds that a call takes.
template <typename Work>
double seconds(Clock clock, const Work& work) {
  const double start = now(clock);
  work();
  return now(clock) - start;
}

/// The fastest of several calls.
///
/// @param round  does the work once, and tells each part's time to the minima it keeps; returns
///               how long it took
template <typename Round>
void repeat(const MeasureOptions& options, const Round& round) {
  constexpr int kMost = 1000;
  double spent = 0.0;
  for (int i = 0; i < kMost && (i < options.repeat || spent < options.least_time); ++i) {
    spent += round();
  }
}

template <typename Work>
double fastest(const MeasureOptions& options, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  repeat(options, [&] {
    const double time = seconds(options.clock, work);
    best = std::min(best, time);
    return time;
  });
  return best;
}

/// Right-hand sides that no structure of a matrix can favour, the same on every machine.
Eigen::MatrixXd many_sides(Eigen::Index rows, int count) {
  Eigen::MatrixXd B(rows, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      B(i, j) = 1.0 + static_cast<double>((i * 7 + j * 13) % 17) / 16.0;
    }
  }
  return B;
}

/// Makes, analyses and factorises, several times; returns the last.
std::unique_ptr<LinearSolver> prepare(const BenchmarkMatrix& matrix, const std::string& name,
                                      const solvers::SolverOptions& solver_options,
                                      const MeasureOptions& options, Measurement& out) {
  std::unique_ptr<LinearSolver> solver;
  out.analyse = std::numeric_limits<double>::infinity();
  out.factorise = std::numeric_limits<double>::infinity();
  repeat(options, [&] {
    solver.reset();
    const double analyse = seconds(options.clock, [&] {
      solver = solvers::make_solver(name, solver_options, matrix.A);
      solver->analyze(matrix.A);
    });
    if (matrix.name_of_unknown) {
      solver->name_unknowns(matrix.name_of_unknown);
    }
    const double factorise = seconds(options.clock, [&] { solver->factorize(matrix.A); });
    out.analyse = std::min(out.analyse, analyse);
    out.factorise = std::min(out.factorise, factorise);
    return analyse + factorise;
  });
  return solver;
}

void measure_solver(const BenchmarkMatrix& matrix, const Reference& reference,
                    const solvers::SolverOptions& solver_options, const MeasureOptions& options,
                    Measurement& out) {
  if (out.solver == "auto") {
    const solvers::SolverChoice choice = solvers::choose_solver(solver_options, matrix.A);
    out.chosen = choice.name;
    if (choice.ordering != solvers::Ordering::kDefault) {
      out.chosen += concat('+', name_of(choice.ordering));
    }
  }
  const auto solver = prepare(matrix, out.solver, solver_options, options, out);
  out.refactorise = fastest(options, [&] { solver->factorize(matrix.A); });
  const solvers::FactorInfo info = solver->factor_info();
  out.entries = info.entries;
  out.fill = info.entries / std::max<double>(1.0, static_cast<double>(matrix.A.nonZeros()));
  out.bytes = info.bytes;
  out.flops = info.flops;

  const Eigen::Index rows = matrix.A.rows();
  Eigen::MatrixXd x(rows, 1);
  out.solve_transposed = fastest(options, [&] { solver->solve_transposed(matrix.b, x); });
  out.transposed_error =
      solvers::normwise_backward_error(matrix.A, System::kTransposed, x.col(0), matrix.b);
  out.solve = fastest(options, [&] { solver->solve(matrix.b, x); });
  out.backward_error =
      solvers::normwise_backward_error(matrix.A, System::kPlain, x.col(0), matrix.b);
  out.componentwise_error =
      solvers::componentwise_backward_error(matrix.A, System::kPlain, x.col(0), matrix.b);
  if (reference.x.size() == rows) {
    const double size = reference.x.cwiseAbs().maxCoeff();
    out.forward_error = (x - reference.x).cwiseAbs().maxCoeff() / (size > 0.0 ? size : 1.0);
  }
  const Eigen::MatrixXd B = many_sides(rows, options.rhs);
  Eigen::MatrixXd X(rows, options.rhs);
  out.solve_many = fastest(options, [&] { solver->solve(B, X); });
}

}  // namespace

Reference find_reference(const BenchmarkMatrix& matrix) {
  Reference out;
  out.condition = matrix.condition;
  try {
    const auto solver = solvers::make_klu();
    solver->analyze(matrix.A);
    solver->factorize(matrix.A);
    out.x = matrix.x ? *matrix.x : solvers::refined_solution(*solver, matrix.A, matrix.b);
    if (!out.condition) {
      out.condition = solvers::estimate_condition(*solver, matrix.A);
    }
  } catch (const Error& error) {
    out.failure = error.what();
  } catch (const std::bad_alloc& error) {
    out.failure = error.what();
    out.out_of_memory = true;
  }
  return out;
}

Measurement measure(const BenchmarkMatrix& matrix, const Reference& reference,
                    const std::string& solver, solvers::Ordering ordering,
                    const MeasureOptions& options) {
  Measurement out;
  out.solver = solver;
  out.ordering = name_of(ordering);
  solvers::SolverOptions solver_options = matrix.options;
  solver_options.ordering = ordering;
  try {
    measure_solver(matrix, reference, solver_options, options, out);
  } catch (const Error& error) {
    out.failure = error.what();
  } catch (const std::bad_alloc& error) {
    out.failure = error.what();
  }
  return out;
}

}  // namespace hbar::solver_benchmark
