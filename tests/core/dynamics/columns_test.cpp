#include "hbar/core/dynamics/columns.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::kStates;
using testing::Random;
using testing::relative_gap;
using testing::State;

/// Combinations of ∂ID/∂q, ∂ID/∂q̇ and M at a state.
class Derivatives {
 public:
  Derivatives(const Model& model, const State& state)
      : model_(model), motion_(model.tree()), dynamics_(model), columns_(model.tree()) {
    VectorXd tau = VectorXd::Zero(model.dof());
    const auto mechanism = nominal_mechanism<double>(model);
    compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion_);
    subtree_dynamics<double>(model, mechanism, motion_, dynamics_, tau);
  }

  MatrixXd operator()(double q, double v, double a) {
    MatrixXd out = MatrixXd::Constant(model_.dof(), model_.dof(), std::nan(""));
    columns_.combine(model_.tree(), motion_, dynamics_, {q, v, a}, out);
    return out;
  }
  const Motion<double>& motion() const { return motion_; }
  const Dynamics<double>& dynamics() const { return dynamics_; }

 private:
  const Model& model_;
  Motion<double> motion_;
  Dynamics<double> dynamics_;
  Columns<double> columns_;
};

/// ∂ID by one of its three arguments, by dual numbers.
enum class By { kQ, kQdot, kA };
MatrixXd by_duals(const Model& model, const State& state, By by) {
  const auto mechanism = nominal_mechanism<Dual>(model);
  const VectorX<Dual> q = state.q.cast<Dual>();
  const VectorX<Dual> qdot = state.qdot.cast<Dual>();
  const VectorX<Dual> a = state.a.cast<Dual>();
  return testing::dual_jacobian(
      [&](const VectorX<Dual>& x) {
        return testing::inverse_dynamics_at<Dual>(model, mechanism, by == By::kQ ? x : q,
                                                  by == By::kQdot ? x : qdot, by == By::kA ? x : a);
      },
      by == By::kQ ? state.q : (by == By::kQdot ? state.qdot : state.a));
}

class EveryModelsColumns : public ::testing::TestWithParam<unsigned> {
 protected:
  const Model model = testing::random_model(GetParam());
  Random random{GetParam()};
};

TEST_P(EveryModelsColumns, HasTheDerivativesOfInverseDynamicsThatDualsGive) {
  for (int k = 0; k < kStates; ++k) {
    State state = testing::random_state(model, random);
    if (k == 0) {
      state.q.setZero();
    }
    Derivatives derivatives(model, state);
    EXPECT_LT(relative_gap(derivatives(1.0, 0.0, 0.0), by_duals(model, state, By::kQ)), 1e-12);
    EXPECT_LT(relative_gap(derivatives(0.0, 1.0, 0.0), by_duals(model, state, By::kQdot)), 1e-12);
    EXPECT_LT(relative_gap(derivatives(0.0, 0.0, 1.0), by_duals(model, state, By::kA)), 1e-12);
  }
}

TEST_P(EveryModelsColumns, HasTheDerivativesOfInverseDynamicsThatDifferencesGive) {
  const State state = testing::random_state(model, random);
  const auto mechanism = nominal_mechanism<double>(model);
  Derivatives derivatives(model, state);
  const MatrixXd by_q = testing::differences(
      [&](const VectorXd& q) {
        return testing::inverse_dynamics_at<double>(model, mechanism, q, state.qdot, state.a);
      },
      state.q);
  EXPECT_LT(relative_gap(derivatives(1.0, 0.0, 0.0), by_q), 1e-9);
}

TEST_P(EveryModelsColumns, CombinesThemLinearly) {
  const State state = testing::random_state(model, random);
  Derivatives derivatives(model, state);
  const MatrixXd expected = 2.0 * derivatives(1.0, 0.0, 0.0) - 3.0 * derivatives(0.0, 1.0, 0.0) +
                            0.5 * derivatives(0.0, 0.0, 1.0);
  EXPECT_LT(relative_gap(derivatives(2.0, -3.0, 0.5), expected), 1e-13);
}

TEST_P(EveryModelsColumns, HasTheMassMatrixAsItsLastTerm) {
  const State state = testing::random_state(model, random);
  Derivatives derivatives(model, state);
  MatrixXd M = MatrixXd::Zero(model.dof(), model.dof());
  mass_matrix<double>(model, derivatives.motion(), derivatives.dynamics(), M);
  EXPECT_LT(relative_gap(derivatives(0.0, 0.0, 1.0), M), 1e-14);
}

TEST_P(EveryModelsColumns, DoesNotCoupleUnrelatedBranches) {
  Derivatives derivatives(model, testing::random_state(model, random));
  const MatrixXd all = derivatives(1.0, 1.0, 1.0);
  const Tree& tree = model.tree();
  int zeros = 0;
  for (int l = 0; l < model.dof(); ++l) {
    for (int c = 0; c < model.dof(); ++c) {
      const int i = tree.node_of(l);
      const int j = tree.node_of(c);
      if (!tree.is_on_path(i, j) && !tree.is_on_path(j, i)) {
        EXPECT_EQ(all(l, c), 0.0) << l << ' ' << c;
        ++zeros;
      }
    }
  }
  EXPECT_GT(zeros, model.dof());
}

TEST_P(EveryModelsColumns, HasDerivativesThatAreThemselvesDifferentiable) {
  // On duals, the matrix of the combination has the slope that differences of the matrix give.
  const State state = testing::random_state(model, random);
  const VectorXd d = random.vector(model.dof());
  const auto mechanism = nominal_mechanism<Dual>(model);
  Motion<Dual> motion(model.tree());
  Dynamics<Dual> dynamics(model);
  Columns<Dual> columns(model.tree());
  VectorX<Dual> tau = VectorX<Dual>::Zero(model.dof());
  MatrixX<Dual> out = MatrixX<Dual>::Zero(model.dof(), model.dof());
  const VectorX<Dual> a = state.a.cast<Dual>();
  compute_motion<Dual>(model.tree(), mechanism, testing::with_slope(state.q, d),
                       testing::with_slope(state.qdot, d), a, motion);
  subtree_dynamics<Dual>(model, mechanism, motion, dynamics, tau);
  columns.combine(model.tree(), motion, dynamics, {Dual(1.0), Dual(2.0), Dual(3.0)}, out);
  const MatrixXd slope = testing::differences(
      [&](const VectorXd& t) -> VectorXd {
        const State moved = {state.q + t[0] * d, state.qdot + t[0] * d, state.a};
        return Derivatives(model, moved)(1.0, 2.0, 3.0).reshaped();
      },
      VectorXd::Zero(1));
  EXPECT_LT(relative_gap(testing::slopes(out).reshaped(), slope), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsColumns, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
