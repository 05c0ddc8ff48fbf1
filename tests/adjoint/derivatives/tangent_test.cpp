#include "hbar/adjoint/derivatives/tangent.h"

#include <gtest/gtest.h>

#include <random>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/solvers/linear/klu.h"
#ifdef HBAR_HAVE_UMFPACK
#include "hbar/solvers/linear/umfpack.h"
#endif
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::small_problem;
using testing::spinning_problem;

Directions random_directions(const Horizon& horizon, Eigen::Index count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Directions out = Directions::zero(horizon, count);
  for (Eigen::MatrixXd* part : {&out.p, &out.u, &out.q0, &out.qdot0}) {
    *part = part->unaryExpr([&](double) { return uniform(random); });
  }
  return out;
}

Inputs moved(const Inputs& inputs, const Directions& d, Eigen::Index i, double step) {
  Inputs out = inputs;
  out.p += step * d.p.col(i);
  out.u.reshaped() += step * d.u.col(i);
  out.q0 += step * d.q0.col(i);
  out.qdot0 += step * d.qdot0.col(i);
  return out;
}

using Case = std::tuple<std::string, bool>;

class TangentOfEveryIntegrator : public ::testing::TestWithParam<Case> {
 protected:
  Problem problem_ = std::get<1>(GetParam()) ? spinning_problem(std::get<0>(GetParam()))
                                             : small_problem(std::get<0>(GetParam()));
  Trajectory trajectory_ = simulate(problem_.horizon, problem_.inputs).trajectory();
};

TEST_P(TangentOfEveryIntegrator, ChangesChartOnlyWhereItSpins) {
  EXPECT_EQ(trajectory_.chart_switches.size(), std::get<1>(GetParam()) ? 1U : 0U);
}

TEST_P(TangentOfEveryIntegrator, HasTangentsThatAreDerivatives) {
  const Horizon& horizon = problem_.horizon;
  Directions d = random_directions(horizon, 2);
  d.p *= 1e-2;  // masses and moments stay physical
  const Tangents tangents = TangentSweep(horizon).push_forward(trajectory_, d);
  for (Eigen::Index i = 0; i < d.count(); ++i) {
    const auto difference = [&](double step) {
      const TrajectoryValues a =
          read_values(horizon, simulate(horizon, moved(problem_.inputs, d, i, step)).trajectory());
      const TrajectoryValues b =
          read_values(horizon, simulate(horizon, moved(problem_.inputs, d, i, -step)).trajectory());
      Eigen::VectorXd out(a.q.size() + a.qdot.size() + a.measured.size());
      out << (a.q - b.q).reshaped(), (a.qdot - b.qdot).reshaped(),
          (a.measured - b.measured).reshaped();
      return Eigen::VectorXd(out / (2.0 * step));
    };
    const Eigen::VectorXd expected = (4.0 * difference(5e-5) - difference(1e-4)) / 3.0;
    Eigen::VectorXd ours(expected.size());
    ours << tangents.q.col(i), tangents.qdot.col(i), tangents.measured.col(i);
    EXPECT_LT((ours - expected).norm(), 1e-8 * expected.norm());
  }
}

TEST_P(TangentOfEveryIntegrator, AgreesWithTheAdjointToRounding) {
  const Horizon& horizon = problem_.horizon;
  const TrajectoryValues values = read_values(horizon, trajectory_);
  const TrajectoryPartials partials = problem_.objective.partials(values);
  AdjointSweep sweep(horizon);
  const Gradient g = sweep.pull_back(trajectory_, partials);
  const Directions d = random_directions(horizon, 5);
  TangentSweep tangent_sweep(horizon);
  const Tangents tangents = tangent_sweep.push_forward(trajectory_, d);
  for (Eigen::Index i = 0; i < d.count(); ++i) {
    const double reverse = g.p.dot(d.p.col(i)) + g.u.reshaped().dot(d.u.col(i)) +
                           g.q0.dot(d.q0.col(i)) + g.qdot0.dot(d.qdot0.col(i));
    const double scale = sweep.adjoint().norm() * tangent_sweep.right_hand_sides().col(i).norm();
    EXPECT_NEAR(directional_derivative(partials, tangents, d, i), reverse, 1e-12 * scale);
  }
}

TEST_P(TangentOfEveryIntegrator, HasTheSameTangentsFromEverySolver) {
  const Horizon& horizon = problem_.horizon;
  const Directions d = random_directions(horizon, 3);
  const Tangents by_blocks = TangentSweep(horizon).push_forward(trajectory_, d);
  const std::vector<solvers::SolverFactory> others = {
      [](const auto& options, const auto&) { return solvers::make_klu(options); },
#ifdef HBAR_HAVE_UMFPACK
      [](const auto& options, const auto&) { return solvers::make_umfpack(options); },
#endif
  };
  for (const solvers::SolverFactory& factory : others) {
    TangentSweep sweep(horizon, factory);
    const Tangents tangents = sweep.push_forward(trajectory_, d);
    const std::string name = sweep.solver().name();
    EXPECT_LT((tangents.q - by_blocks.q).norm(), 1e-11 * by_blocks.q.norm()) << name;
    EXPECT_LT((tangents.measured - by_blocks.measured).norm(), 1e-11 * by_blocks.measured.norm())
        << name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, TangentOfEveryIntegrator,
                         ::testing::Combine(::testing::Values("bdf1", "sdirk2", "bdf2"),
                                            ::testing::Bool()),
                         [](const auto& c) {
                           return std::get<0>(c.param) +
                                  (std::get<1>(c.param) ? "_spinning" : "_small");
                         });

}  // namespace
}  // namespace hbar
