#include "hbar/adjoint/outputs/measured_reads.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/outputs/measurements.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;

bool holds(const std::vector<int>& list, Eigen::Index i) {
  return std::find(list.begin(), list.end(), static_cast<int>(i)) != list.end();
}

/// Rows move with nothing but what they say, at random states of a model with everything.
TEST(MeasuredReads, HoldEverythingThatMovesARow) {
  const Model model = testing::random_contact_model(2);
  std::vector<Measurement> all = model_measurements(model);
  all.insert(all.end(), {PointVelocity{"speed", 7}, Orientation{"turn", 9},
                         BodyDistance{"gap", 3, Eigen::Vector3d::Zero(), 0.1, 2},
                         ContactForce{"push", 0}, MotorTorque{"torque", 1}, MotorPower{"power", 0},
                         CentreOfMass{"centre"}, LinearMomentum{"momentum"}});
  std::vector<MeasuredReads> reads;
  for (const Measurement& measurement : all) {
    const std::vector<MeasuredReads> rows = measured_reads(model, measurement);
    EXPECT_EQ(rows.size(), row_names(model, measurement).size());
    reads.insert(reads.end(), rows.begin(), rows.end());
  }
  Measurements<double> measurements(model, all);
  InstantMotion<double> instants(model, true);
  const ParameterSet none;
  const VectorXd no_p(0);
  const auto mechanism = nominal_mechanism<double>(model);
  const Applied<double> applied{mechanism, none, no_p};
  testing::Random random(4);
  for (int k = 0; k < 5; ++k) {
    const testing::State state = testing::random_state(model, random);
    const VectorXd u = random.vector(model.control_count(), 0.9);
    const Instant<double> at = instants.at(applied, state.q, state.qdot, u);
    measurements.linearize(at);
    for (Eigen::Index row = 0; row < measurements.size(); ++row) {
      VectorXd q = VectorXd::Zero(model.dof());
      VectorXd qdot = q;
      VectorXd by_u = VectorXd::Zero(u.size());
      VectorXd p(0);
      InstantGradient<double> by{q, qdot, by_u, p};
      measurements.pull_back(at, VectorXd::Unit(measurements.size(), row), by);
      const MeasuredReads& mine = reads[static_cast<std::size_t>(row)];
      const std::string& name = measurements.names()[static_cast<std::size_t>(row)];
      // What moves two bodies alike leaves their distance as it is, but for rounding.
      for (Eigen::Index c = 0; c < q.size(); ++c) {
        EXPECT_TRUE(std::abs(q[c]) < 1e-12 * (1.0 + testing::largest(q)) || holds(mine.q, c))
            << name << " by q " << c;
        EXPECT_TRUE(qdot[c] == 0.0 || holds(mine.qdot, c)) << name << " by qdot " << c;
      }
      for (Eigen::Index i = 0; i < by_u.size(); ++i) {
        EXPECT_TRUE(by_u[i] == 0.0 || holds(mine.controls, i)) << name << " by u " << i;
      }
    }
  }
}

}  // namespace
}  // namespace hbar
