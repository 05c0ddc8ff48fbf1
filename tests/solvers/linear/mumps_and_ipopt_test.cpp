// Ipopt in one thread and the solver MUMPS in another: they share one library with global
// variables.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <utility>

#include "hbar/core/base/error.h"
#include "hbar/solvers/linear/mumps.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/random.h"

namespace hbar::solvers {
namespace {

/// Rosenbrock's function in n dimensions. Each evaluation may solve a system on its own.
class Rosenbrock final : public Nlp {
 public:
  explicit Rosenbrock(int n, std::function<void()> on_evaluation = {})
      : on_evaluation_(std::move(on_evaluation)) {
    const double infinity = std::numeric_limits<double>::infinity();
    variables_.lower = Eigen::VectorXd::Constant(n, -infinity);
    variables_.upper = Eigen::VectorXd::Constant(n, infinity);
    variables_.start = Eigen::VectorXd::Constant(n, -1.2);
    for (int i = 0; i < n; ++i) {
      variables_.names.push_back(concat("x", i));
    }
    constraints_.lower = constraints_.upper = Eigen::VectorXd(0);
  }
  const NlpVariables& variables() const override { return variables_; }
  const NlpConstraints& constraint_limits() const override { return constraints_; }
  const SparsityPattern& jacobian_pattern() const override { return pattern_; }
  double objective(const Eigen::VectorXd& x) override {
    if (on_evaluation_) {
      on_evaluation_();
    }
    double f = 0.0;
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      f += 100.0 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1.0 - x[i], 2);
    }
    return f;
  }
  void objective_gradient(const Eigen::VectorXd& x, Eigen::VectorXd& g) override {
    g.setZero();
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      const double a = x[i + 1] - x[i] * x[i];
      g[i] += -400.0 * x[i] * a - 2.0 * (1.0 - x[i]);
      g[i + 1] += 200.0 * a;
    }
  }
  void constraints(const Eigen::VectorXd&, Eigen::VectorXd&) override {}
  void constraint_jacobian(const Eigen::VectorXd&, Eigen::VectorXd&) override {}

 private:
  std::function<void()> on_evaluation_;
  NlpVariables variables_;
  NlpConstraints constraints_;
  SparsityPattern pattern_;
};

/// Residual of a random system of 60 equations, solved by MUMPS.
double residual(unsigned seed) {
  constexpr int n = 60;
  hbar::testing::Random random(seed);
  SparseMatrix A(n, n);
  for (int i = 0; i < n; ++i) {
    A.insert(i, i) = 10.0 + random.vector(1)[0];
    A.insert(i, (i + 7) % n) = random.vector(1)[0];
    A.insert(i, (i + 31) % n) = random.vector(1)[0];
  }
  A.makeCompressed();
  const auto solver = make_mumps({});
  solver->analyze(A);
  solver->factorize(A);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Ones(n, 1);
  Eigen::MatrixXd X = B;
  solver->solve(B, X);
  return (A * X - B).norm();
}

TEST(MumpsAndIpopt, WorkInTwoThreads) {
  Rosenbrock alone(20);
  const IpoptResult expected = solve_with_ipopt(alone);
  std::atomic<bool> done = false;
  std::thread other([&] {
    for (unsigned seed = 1; !done; ++seed) {
      EXPECT_LT(residual(seed), 1e-9);
    }
  });
  for (int k = 0; k < 20; ++k) {
    Rosenbrock program(20);
    const IpoptResult result = solve_with_ipopt(program);
    EXPECT_EQ(result.iterations, expected.iterations);
    EXPECT_EQ(result.objective, expected.objective);
  }
  done = true;
  other.join();
}

TEST(MumpsAndIpopt, WorkInsideEachOther) {
  // In the thread of Ipopt, and in one that its callback waits for.
  Rosenbrock program(10, [] {
    EXPECT_LT(residual(1), 1e-9);
    std::thread([] { EXPECT_LT(residual(2), 1e-9); }).join();
  });
  EXPECT_TRUE(solve_with_ipopt(program).converged());
}

}  // namespace
}  // namespace hbar::solvers
