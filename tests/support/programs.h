#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "hbar/solvers/nlp/nlp.h"

namespace hbar::solvers::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A program whose description is public data, and that records where it was evaluated.
class Program : public Nlp {
 public:
  Program(Eigen::VectorXd start, int constraint_count) {
    const Eigen::Index n = start.size();
    variables_.lower.setConstant(n, -kInfinity);
    variables_.upper.setConstant(n, kInfinity);
    variables_.start = std::move(start);
    for (Eigen::Index i = 0; i < n; ++i) {
      variables_.names.push_back(concat("x", i));
    }
    limits_.lower.setConstant(constraint_count, -kInfinity);
    limits_.upper.setConstant(constraint_count, kInfinity);
    for (int i = 0; i < constraint_count; ++i) {
      limits_.names.push_back(concat("c", i));
    }
    for (int i = 0; i < constraint_count; ++i) {
      for (int j = 0; j < n; ++j) {
        pattern_.rows.push_back(i);
        pattern_.columns.push_back(j);
      }
    }
  }

  [[nodiscard]] const NlpVariables& variables() const override { return variables_; }
  [[nodiscard]] const NlpConstraints& constraint_limits() const override { return limits_; }
  [[nodiscard]] const SparsityPattern& jacobian_pattern() const override { return pattern_; }

  NlpVariables variables_;
  NlpConstraints limits_;
  SparsityPattern pattern_;
};

/// Every place of a lower triangle, row by row.
inline SparsityPattern lower_triangle(int n) {
  SparsityPattern pattern;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      pattern.rows.push_back(i);
      pattern.columns.push_back(j);
    }
  }
  return pattern;
}

/// A program with a dense Hessian.
class CurvedProgram : public Program {
 public:
  CurvedProgram(const Eigen::VectorXd& start, int constraint_count)
      : Program(start, constraint_count),
        hessian_pattern_(lower_triangle(static_cast<int>(start.size()))) {}

  [[nodiscard]] const SparsityPattern& hessian_pattern(HessianKind) override {
    return hessian_pattern_;
  }

  SparsityPattern hessian_pattern_;
};

/// (1 − x₀)² + 100 (x₁ − x₀²)², least at (1, 1); hooks let a test disturb it.
class Rosenbrock : public CurvedProgram {
 public:
  Rosenbrock() : CurvedProgram(Eigen::Vector2d(-1.2, 1.0), 0) {}

  double objective(const Eigen::VectorXd& x) override {
    ++visits[{x[0], x[1]}];
    if (on_objective) {
      on_objective(x);
    }
    return std::pow(1.0 - x[0], 2) + 100.0 * std::pow(x[1] - x[0] * x[0], 2);
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    const double bend = x[1] - x[0] * x[0];
    g << -2.0 * (1.0 - x[0]) - 400.0 * x[0] * bend, gradient_factor * 200.0 * bend;
  }
  void constraints(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd&,
                          HessianKind, Eigen::VectorXd& values) override {
    values << 2.0 - 400.0 * (x[1] - 3.0 * x[0] * x[0]), -400.0 * x[0], 200.0 * hessian_factor;
    values *= sigma;
  }

  std::function<void(const Eigen::VectorXd&)> on_objective;
  double gradient_factor = 1.0;  ///< other than 1: a planted error
  double hessian_factor = 1.0;   ///< other than 1: a planted error
  std::map<std::pair<double, double>, int> visits;
};

/// Hock and Schittkowski 71: x₀x₃(x₀+x₁+x₂)+x₂, with x₀x₁x₂x₃ ≥ 25, |x|² = 40, 1 ≤ x ≤ 5.
class Hs071 : public CurvedProgram {
 public:
  Hs071() : CurvedProgram(Eigen::Vector4d(1.0, 5.0, 5.0, 1.0), 2) {
    variables_.lower.setConstant(1.0);
    variables_.upper.setConstant(5.0);
    limits_.lower << 25.0, 40.0;
    limits_.upper << kInfinity, 40.0;
    limits_.names = {"product", "sphere"};
  }

  double objective(const Eigen::VectorXd& x) override {
    return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    g << x[3] * (2.0 * x[0] + x[1] + x[2]), x[0] * x[3], x[0] * x[3] + 1.0,
        x[0] * (x[0] + x[1] + x[2]);
  }
  void constraints(const Eigen::VectorXd& x, Eigen::VectorXd& c) override {
    c << x.prod(), x.squaredNorm();
  }
  void constraint_jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& values) override {
    values << x[1] * x[2] * x[3], x[0] * x[2] * x[3], x[0] * x[1] * x[3],
        jacobian_factor * x[0] * x[1] * x[2], 2.0 * x;
  }
  void lagrangian_hessian(const Eigen::VectorXd& x, double sigma, const Eigen::VectorXd& lambda,
                          HessianKind, Eigen::VectorXd& values) override {
    const double a = sigma;
    const double p = hessian_factor * lambda[0];
    const double s = 2.0 * lambda[1];
    values << 2.0 * a * x[3] + s,                                  //
        a * x[3] + p * x[2] * x[3], s,                             //
        a * x[3] + p * x[1] * x[3], p * x[0] * x[3], s,            //
        a * (2.0 * x[0] + x[1] + x[2]) + lambda[0] * x[1] * x[2],  //
        a * x[0] + lambda[0] * x[0] * x[2], a * x[0] + lambda[0] * x[0] * x[1], s;
  }
  double jacobian_factor = 1.0;  ///< other than 1: a planted error
  double hessian_factor = 1.0;   ///< other than 1: a planted error
};

inline const Eigen::Vector4d kHs071Optimum(1.0, 4.74299963, 3.82114998, 1.37940829);
inline constexpr double kHs071Objective = 17.0140173;

}  // namespace hbar::solvers::testing
