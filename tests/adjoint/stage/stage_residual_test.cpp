#include "hbar/adjoint/stage/stage_residual.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/contact/tactile.h"
#include "tests/support/count_allocations.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

constexpr int kPoints = 20;

class EveryModelsResidual : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Jacobian of g where (q, q̇, a) follow x by the weights, by dual numbers.
  MatrixXd by_duals(const StagePoint<double>& point, double q, double v, double a) const {
    const auto constants = nominal_mechanism<Dual>(model);
    StageResidual<Dual> stage(model);
    return testing::dual_jacobian(
        [&](const VectorX<Dual>& x) -> VectorX<Dual> {
          StagePoint<Dual> moved = testing::as_dual(model, point);
          moved.q += q * x;
          moved.qdot += v * x;
          moved.a += a * x;
          VectorX<Dual> out = VectorX<Dual>::Zero(model.dof());
          stage.residual(constants, moved, out);
          return out;
        },
        VectorXd::Zero(model.dof()));
  }
  MatrixXd weighted(StageResidual<double>& stage, double q, double v, double a) const {
    MatrixXd out = MatrixXd::Zero(model.dof(), model.dof());
    stage.jacobian({q, v, a}, out);
    return out;
  }

  const Model model = testing::random_model(GetParam(), GetParam() % 2 == 0);
  const Mechanism<double> mechanism = nominal_mechanism<double>(model);
  Random random{GetParam()};
  VectorXd g = VectorXd::Zero(model.dof());
};

TEST_P(EveryModelsResidual, IsInverseDynamicsLessJointForcesTimesC) {
  const StagePoint<double> point = testing::random_point(model, random);
  StageResidual<double> stage(model);
  stage.residual(mechanism, point, g);
  JointForces<double> forces(model);
  compute_joint_forces<double>(model, mechanism, point.q, point.qdot, point.u, point.start, forces);
  const VectorXd id =
      testing::inverse_dynamics_at<double>(model, mechanism, point.q, point.qdot, point.a);
  EXPECT_DOUBLE_EQ(point.c(), 1.0 / 400.0);
  EXPECT_LT(relative_gap(g, (id - forces.tau) / 400.0), 1e-14);
  VectorXd again = VectorXd::Zero(model.dof());
  stage.linearize(mechanism, point, again);
  EXPECT_LT(relative_gap(again, g), 1e-14);
  EXPECT_EQ(stage.c(), point.c());
  EXPECT_EQ(stage.rate(), point.rate);
}

TEST_P(EveryModelsResidual, HasTheJacobiansThatDualsGive) {
  StageResidual<double> stage(model);
  for (int k = 0; k < kPoints; ++k) {
    const StagePoint<double> point = testing::random_point(model, random);
    stage.linearize(mechanism, point, g);
    EXPECT_LT(relative_gap(weighted(stage, 1.0, 0.0, 0.0), by_duals(point, 1.0, 0.0, 0.0)), 1e-12);
    EXPECT_LT(relative_gap(weighted(stage, 0.0, 1.0, 0.0), by_duals(point, 0.0, 1.0, 0.0)), 1e-12);
    EXPECT_LT(relative_gap(weighted(stage, 0.0, 0.0, 1.0), by_duals(point, 0.0, 0.0, 1.0)), 1e-12);
    EXPECT_LT(relative_gap(weighted(stage, -2.0, 3.0, 0.5), by_duals(point, -2.0, 3.0, 0.5)),
              1e-12);
    MatrixXd newton = MatrixXd::Zero(model.dof(), model.dof());
    stage.newton_matrix(newton);
    EXPECT_LT(relative_gap(newton, by_duals(point, 1.0, point.rate, point.rate * point.rate)),
              1e-12);
  }
}

TEST_P(EveryModelsResidual, HasARemainderOfSecondOrderInItsNewtonMatrix) {
  const StagePoint<double> point = testing::random_point(model, random);
  const VectorXd d = random.vector(model.dof(), 0.05);
  const VectorXd z = random.vector(model.dof());
  StageResidual<double> stage(model);
  stage.linearize(mechanism, point, g);
  MatrixXd newton = MatrixXd::Zero(model.dof(), model.dof());
  stage.newton_matrix(newton);
  const auto along = [&](double e) {
    StagePoint<double> moved = point;
    moved.q += e * d;
    moved.qdot += e * point.rate * d;
    moved.a += e * point.rate * point.rate * d;
    stage.residual(mechanism, moved, g);
    return z.dot(g);
  };
  EXPECT_NEAR(testing::taylor_slope(along, z.dot(newton * d), 1e-2), 2.0, 0.05);
}

TEST_P(EveryModelsResidual, PullsBackByTheTransposes) {
  StageResidual<double> stage(model);
  for (int k = 0; k < kPoints; ++k) {
    stage.linearize(mechanism, testing::random_point(model, random), g);
    const VectorXd z = random.vector(model.dof());
    stage.pull_back(z);
    EXPECT_LT(relative_gap(stage.by_q(), weighted(stage, 1.0, 0.0, 0.0).transpose() * z), 1e-13);
    EXPECT_LT(relative_gap(stage.by_qdot(), weighted(stage, 0.0, 1.0, 0.0).transpose() * z), 1e-13);
    EXPECT_LT(relative_gap(stage.by_a(), weighted(stage, 0.0, 0.0, 1.0).transpose() * z), 1e-13);
  }
}

TEST_P(EveryModelsResidual, KeepsNothingOfEarlierPoints) {
  const StagePoint<double> point = testing::random_point(model, random);
  StageResidual<double> used(model);
  used.linearize(mechanism, testing::random_point(model, random), g);
  used.pull_back(random.vector(model.dof()));
  used.linearize(mechanism, point, g);
  StageResidual<double> fresh(model);
  fresh.linearize(mechanism, point, g);
  EXPECT_EQ(weighted(used, 1.0, 2.0, 3.0), weighted(fresh, 1.0, 2.0, 3.0));
  const VectorXd z = random.vector(model.dof());
  used.pull_back(z);
  fresh.pull_back(z);
  EXPECT_EQ(used.by_q(), fresh.by_q());
}

TEST_P(EveryModelsResidual, AllocatesNothingAfterSetUp) {
  const StagePoint<double> point = testing::random_point(model, random);
  const VectorXd z = random.vector(model.dof());
  const ParameterSet set = ParameterSet::all(model);
  const VectorXd p = set.nominal();
  StageResidual<double> stage(model);
  MatrixXd out = MatrixXd::Zero(model.dof(), model.dof());
  VectorXd grad = VectorXd::Zero(set.size());
  EXPECT_GT(testing::allocations_of([] { const std::vector<int> some(100); }), 0U);
  if (HBAR_COUNTS_MALLOC != 0) {
    EXPECT_GT(testing::allocations_of([&] { const VectorXd copy = z; }), 0U);
  }
  EXPECT_EQ(testing::allocations_of([&] { stage.residual(mechanism, point, g); }), 0U);
  EXPECT_EQ(testing::allocations_of([&] { stage.linearize(mechanism, point, g); }), 0U);
  EXPECT_EQ(testing::allocations_of([&] { stage.jacobian({1.0, 2.0, 3.0}, out); }), 0U);
  EXPECT_EQ(testing::allocations_of([&] { stage.newton_matrix(out); }), 0U);
  EXPECT_EQ(testing::allocations_of([&] { stage.pull_back(z); }), 0U);
  EXPECT_EQ(testing::allocations_of([&] {
              add_parameter_gradient<double>({mechanism, set, p}, stage, point, z, 1.0, grad);
            }),
            0U);
  ContactForces<double> contacts(model);
  EXPECT_EQ(testing::allocations_of([&] { contacts.evaluate(mechanism, stage.motion()); }), 0U);
  EXPECT_EQ(testing::allocations_of([&] { contacts.linearize(mechanism, stage.motion()); }), 0U);
}

/// Here because allocations are counted in one file of the program.
TEST_P(EveryModelsResidual, IsReadByMeasurementsThatAllocateNothingAfterSetUp) {
  const ParameterSet set = ParameterSet::all(model);
  const VectorXd p = set.nominal();
  const StagePoint<double> point = testing::random_point(model, random);
  std::vector<Measurement> all = model_measurements(model);
  all.insert(all.end(), {PointVelocity{"speed", 13}, ContactForce{"push", 0},
                         MotorPower{"power", 0}, CentreOfMass{"centre"}});
  Measurements<double> measurements(model, all);
  InstantMotion<double> instants(model, true);
  const Applied<double> applied{mechanism, set, p};
  VectorXd out = VectorXd::Zero(measurements.size());
  VectorXd by_q = VectorXd::Zero(model.dof());
  VectorXd by_qdot = by_q;
  VectorXd by_u = VectorXd::Zero(model.control_count());
  VectorXd by_p = VectorXd::Zero(set.size());
  InstantGradient<double> by{by_q, by_qdot, by_u, by_p};
  EXPECT_EQ(testing::allocations_of([&] {
              const Instant<double> at = instants.at(applied, point.q, point.qdot, point.u);
              measurements.linearize(at);
              measurements.read(at, out);
              measurements.pull_back(at, out, by);
            }),
            0U);
  EXPECT_GT(out.norm(), 0.0);
  EXPECT_GT(by_p.norm(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsResidual, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
