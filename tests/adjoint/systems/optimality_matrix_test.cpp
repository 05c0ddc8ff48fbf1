#include "hbar/adjoint/systems/optimality_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "hbar/adjoint/trajectory/simulator.h"
#include "tests/support/periodic_problems.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using testing::contact_problem;
using testing::driven_pendulum;
using testing::make_problem;

struct Assembled {
  Problem problem;
  Trajectory trajectory;
  Linearizer linearizer;
  const Linearization& system;

  explicit Assembled(Problem p)
      : problem(std::move(p)),
        trajectory(simulate(problem.horizon, problem.inputs).trajectory()),
        linearizer(problem.horizon),
        system(linearizer.linearize(trajectory)) {}
};

/// H̄ with rows of largest entry 1.
Eigen::MatrixXd scaled(const Eigen::MatrixXd& H, const Eigen::MatrixXd& by) {
  return H.cwiseAbs().rowwise().maxCoeff().cwiseInverse().asDiagonal() * by;
}

/// ∂v/∂q̄ of all stages by central differences of the end effectors' positions.
Eigen::MatrixXd variables_by_q(const Horizon& horizon, const Trajectory& trajectory) {
  const Model& model = horizon.model();
  const int n = model.dof();
  const int stages = trajectory.timeline.last_stage();
  const int variables = model.variable_count();
  const Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Motion<double> motion(model.tree());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd E = Eigen::MatrixXd::Zero(stages * variables, stages * n);
  const auto positions = [&](const Eigen::VectorXd& q) {
    Eigen::VectorXd v(variables);
    compute_motion<double>(model.tree(), mechanism, q, none, none, motion);
    for (std::size_t i = 0; i < model.end_effectors().size(); ++i) {
      const EndEffector& point = model.end_effectors()[i];
      const NodeMotion<double>& node = motion.at(model.node_of_link(point.link));
      v.segment<3>(3 * static_cast<Eigen::Index>(i)) = node.p + node.R * point.position;
    }
    return v;
  };
  for (int s = 1; s <= stages; ++s) {
    for (int j = 0; j < n; ++j) {
      const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd::Unit(n, j);
      E.block((s - 1) * variables, (s - 1) * n + j, variables, 1) =
          (positions(trajectory.q.col(s) + step) - positions(trajectory.q.col(s) - step)) / 2e-5;
    }
  }
  return E;
}

constexpr SystemOptions kWeights = {
    .tracking = 2.0, .forces = 3.0, .effort = 0.5, .damping = 0.25, .slack = 0.125};

TEST(OptimalityMatrix, GaussNewtonIsSTransposedSPlusLambda) {
  Assembled a(driven_pendulum("bdf2", 6));
  AssembledSystem out;
  fill_gauss_newton(a.problem.horizon, a.trajectory, a.system, kWeights, out);
  const Eigen::MatrixXd H(a.system.H.matrix());
  const Eigen::MatrixXd E = variables_by_q(a.problem.horizon, a.trajectory);
  Eigen::MatrixXd S(E.rows() + H.rows(), H.cols());
  S << std::sqrt(2.0) * E, std::sqrt(3.0) * scaled(H, H);
  const Eigen::MatrixXd expected =
      S.transpose() * S + 0.25 * Eigen::MatrixXd::Identity(H.rows(), H.rows());
  const Eigen::MatrixXd A(out.A);
  EXPECT_LT((A - expected).norm(), 1e-8 * expected.norm());
  EXPECT_LT((A - A.transpose()).norm(), 1e-15 * A.norm());
  EXPECT_LT((out.b - 2.0 * E.transpose() * Eigen::VectorXd::Ones(E.rows())).norm(),
            1e-8 * out.b.norm());
  EXPECT_EQ(out.options.structure, solvers::Structure::kDefinite);
}

/// The KKT matrix with q̄, ū, p, μ̄ one after the other.
Eigen::MatrixXd kkt_in_groups(Assembled& a) {
  const Eigen::MatrixXd H(a.system.H.matrix());
  const Eigen::MatrixXd B = scaled(H, Eigen::MatrixXd(a.system.dg_du));
  const Eigen::MatrixXd C = scaled(H, Eigen::MatrixXd(a.system.dg_dp));
  const Eigen::MatrixXd E = variables_by_q(a.problem.horizon, a.trajectory);
  const Eigen::Index m = H.rows();
  const Eigen::Index u = B.cols();
  const Eigen::Index p = C.cols();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * m + u + p, 2 * m + u + p);
  K.topLeftCorner(m, m) = 2.0 * E.transpose() * E + 0.25 * Eigen::MatrixXd::Identity(m, m);
  K.block(m, m, u, u).diagonal().setConstant(0.75);
  K.block(m + u, m + u, p, p).diagonal().setConstant(0.25);
  K.bottomRightCorner(m, m).diagonal().setConstant(-0.125);
  K.bottomRows(m).leftCols(m + u + p) << scaled(H, H), B, C;
  K.rightCols(m).topRows(m + u + p) = K.bottomRows(m).leftCols(m + u + p).transpose();
  return K;
}

TEST(OptimalityMatrix, KktIsThatOfTheGroupsInTimeOrder) {
  for (const std::string integrator : {"bdf1", "bdf2"}) {
    Assembled a(driven_pendulum(integrator, 5));
    SystemOptions weights = kWeights;
    weights.parameters = true;
    AssembledSystem out;
    fill_kkt(a.problem.horizon, a.trajectory, a.system, weights, out);
    const Eigen::MatrixXd groups = kkt_in_groups(a);
    // The order of unknowns, from their names.
    const Eigen::Index m = a.system.H.matrix().rows();
    const Eigen::Index u = a.system.dg_du.cols();
    std::vector<Eigen::Index> next = {0, m, m + u, groups.rows() - m};
    std::vector<Eigen::Index> order;
    for (int i = 0; i < out.A.rows(); ++i) {
      const std::string name = out.name_of_unknown(i);
      const std::size_t group = name.find("multiplier") != std::string::npos  ? 3
                                : name.find("parameter") != std::string::npos ? 2
                                : name.find("control") != std::string::npos   ? 1
                                                                              : 0;
      order.push_back(next[group]++);
    }
    ASSERT_EQ(static_cast<Eigen::Index>(order.size()), groups.rows());
    const Eigen::MatrixXd A(out.A);
    EXPECT_LT((A - groups(order, order)).norm(), 1e-8 * A.norm());
    EXPECT_EQ((A - A.transpose()).norm(), 0.0);
    int rows = 0;
    for (const int size : out.options.block_sizes) {
      rows += size;
    }
    EXPECT_EQ(rows, A.rows());
    EXPECT_EQ(out.options.structure, solvers::Structure::kQuasiDefinite);
  }
}

TEST(OptimalityMatrix, KktHasAsManyNegativeEigenvaluesAsMultipliers) {
  Assembled a(make_problem(testing::contact_model(), "bdf1", 0.01, 4));
  AssembledSystem out;
  fill_kkt(a.problem.horizon, a.trajectory, a.system, {}, out);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(out.A), Eigen::EigenvaluesOnly)
          .eigenvalues();
  EXPECT_EQ((eigenvalues.array() < 0.0).count(), a.system.H.matrix().rows());
}

TEST(OptimalityMatrix, KktNamesItsUnknowns) {
  Assembled a(driven_pendulum("bdf1", 5));
  AssembledSystem out;
  SystemOptions weights;
  weights.parameters = true;
  fill_kkt(a.problem.horizon, a.trajectory, a.system, weights, out);
  EXPECT_EQ(out.name_of_unknown(0), "stage 1 (t = 0.2), coordinate shoulder");
  EXPECT_EQ(out.name_of_unknown(3), "stage 1 (t = 0.2), control 1");
  EXPECT_EQ(out.name_of_unknown(11), "stage 2 (t = 0.4), multiplier of coordinate elbow");
  EXPECT_EQ(out.name_of_unknown(30), "design parameter 0");
}

}  // namespace
}  // namespace hbar
