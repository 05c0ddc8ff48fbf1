#include "hbar/solvers/linear/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hbar::solvers {
namespace {

/// hi + lo of twice a double's digits, |lo| at most half a unit in the last place of hi.
struct Twofold {
  double hi = 0.0;
  double lo = 0.0;
};

/// a + b without rounding (Knuth).
Twofold sum(double a, double b) {
  const double s = a + b;
  const double t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}

Twofold& operator+=(Twofold& a, const Twofold& b) {
  const Twofold s = sum(a.hi, b.hi);
  a = sum(s.hi, s.lo + (a.lo + b.lo));
  return a;
}

Twofold product(double a, const Twofold& b) {
  const double p = a * b.hi;
  return sum(p, std::fma(a, b.hi, -p) + a * b.lo);
}

void refuse_shapes(const char* where, const SparseMatrix& A, Eigen::Index x, Eigen::Index b) {
  if (A.rows() == A.cols() && x == A.rows() && b == A.rows()) {
    return;
  }
  throw InvalidInput(concat(where, ": the matrix is ", A.rows(), " x ", A.cols(), ", x has ", x,
                            " and b ", b, " rows; expected a square matrix and as many rows"));
}

/// Calls visit(row, column, value) for every entry of A or Aᵀ.
template <typename Visit>
void for_each_entry(const SparseMatrix& A, System system, const Visit& visit) {
  for (Eigen::Index j = 0; j < A.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      if (system == System::kPlain) {
        visit(entry.row(), entry.col(), entry.value());
      } else {
        visit(entry.col(), entry.row(), entry.value());
      }
    }
  }
}

/// b − A x and |A| |x| + |b| by rows, and ‖A‖∞.
struct Residual {
  std::vector<long double> difference;
  std::vector<long double> size;
  long double norm = 0.0L;
};

Residual residual_of(const SparseMatrix& A, System system, const VectorView<double>& x,
                     const VectorView<double>& b) {
  Residual result;
  result.difference.assign(b.data(), b.data() + b.size());
  std::vector<long double> row_sum(result.difference.size(), 0.0L);
  for (const double value : b) {
    result.size.push_back(std::abs(value));
  }
  for_each_entry(A, system, [&](Eigen::Index row, Eigen::Index column, double value) {
    const auto i = static_cast<std::size_t>(row);
    const long double product = static_cast<long double>(value) * x[column];
    result.difference[i] -= product;
    result.size[i] += std::abs(product);
    row_sum[i] += std::abs(value);
  });
  for (const long double sum_of_row : row_sum) {
    result.norm = std::max(result.norm, sum_of_row);
  }
  return result;
}

/// 0 / 0 is 0, and NaN stays visible.
double quotient(long double error, long double size) {
  return error == 0.0L ? 0.0 : static_cast<double>(error / size);
}

/// ‖A⁻¹‖₁ is at least this: Higham's further vector, for matrices at which the ascent stays low.
double alternating_bound(LinearSolver& solver, Eigen::Index n) {
  Eigen::VectorXd x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double size =
        1.0 + static_cast<double>(i) / static_cast<double>(std::max<Eigen::Index>(n - 1, 1));
    x[i] = i % 2 == 0 ? size : -size;
  }
  solver.solve(x, x);
  return 2.0 * x.lpNorm<1>() / (3.0 * static_cast<double>(n));
}

}  // namespace

double normwise_backward_error(const SparseMatrix& A, System system, const VectorView<double>& x,
                               const VectorView<double>& b) {
  refuse_shapes("normwise_backward_error", A, x.size(), b.size());
  if (!x.allFinite()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Residual residual = residual_of(A, system, x, b);
  long double error = 0.0L;
  for (const long double entry : residual.difference) {
    error = std::max(error, std::abs(entry));
  }
  const long double size = residual.norm * x.lpNorm<Eigen::Infinity>();
  return quotient(error, size + b.lpNorm<Eigen::Infinity>());
}

double componentwise_backward_error(const SparseMatrix& A, System system,
                                    const VectorView<double>& x, const VectorView<double>& b) {
  refuse_shapes("componentwise_backward_error", A, x.size(), b.size());
  if (!x.allFinite()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const Residual residual = residual_of(A, system, x, b);
  double worst = 0.0;
  for (std::size_t i = 0; i < residual.size.size(); ++i) {
    worst = std::max(worst, quotient(std::abs(residual.difference[i]), residual.size[i]));
  }
  return worst;
}

Eigen::VectorXd refined_solution(LinearSolver& solver, const SparseMatrix& A,
                                 const VectorView<double>& b) {
  refuse_shapes("refined_solution", A, solver.size(), b.size());
  std::vector<Twofold> x(static_cast<std::size_t>(b.size()));
  std::vector<Twofold> residual(x.size());
  Eigen::VectorXd step(b.size());
  double last_step = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  // A step of 1e-30 is beyond the digits that x has; if x is exact, steps shrink forever.
  while (last_step > 1e-30 * largest) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      residual[i] = {b[static_cast<Eigen::Index>(i)], 0.0};
    }
    for_each_entry(A, System::kPlain, [&](Eigen::Index row, Eigen::Index column, double value) {
      residual[static_cast<std::size_t>(row)] +=
          product(-value, x[static_cast<std::size_t>(column)]);
    });
    for (std::size_t i = 0; i < x.size(); ++i) {
      step[static_cast<Eigen::Index>(i)] = residual[i].hi;
    }
    solver.solve(step, step);
    // Steps shrink by the same factor each time, down to the rounding of twofold numbers.
    const double size = step.lpNorm<Eigen::Infinity>();
    if (!(size < 0.5 * last_step)) {
      break;
    }
    last_step = size;
    largest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += {step[static_cast<Eigen::Index>(i)], 0.0};
      largest = std::max(largest, std::abs(x[i].hi));
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    step[static_cast<Eigen::Index>(i)] = x[i].hi;
  }
  return step;
}

double estimate_condition(LinearSolver& solver, const SparseMatrix& A) {
  const Eigen::Index n = solver.size();
  refuse_shapes("estimate_condition", A, n, n);
  double norm = 0.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    norm = std::max(norm, A.col(j).cwiseAbs().sum());
  }

  // Ascent on the convex function ‖A⁻¹ x‖₁ over ‖x‖₁ ≤ 1, whose maximum is at a unit vector.
  Eigen::VectorXd x = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  Eigen::VectorXd y(n);
  Eigen::VectorXd slope(n);
  double inverse_norm = 0.0;
  for (int iteration = 0; iteration < 5; ++iteration) {
    solver.solve(x, y);
    const double reached = y.lpNorm<1>();
    if (iteration > 0 && reached <= inverse_norm) {
      break;
    }
    inverse_norm = reached;
    slope = y.unaryExpr([](double value) { return value < 0.0 ? -1.0 : 1.0; });
    solver.solve_transposed(slope, slope);
    Eigen::Index steepest = 0;
    if (slope.cwiseAbs().maxCoeff(&steepest) <= slope.dot(x)) {
      break;
    }
    x.setZero();
    x[steepest] = 1.0;
  }
  return norm * std::max(inverse_norm, alternating_bound(solver, n));
}

}  // namespace hbar::solvers
