#include "hbar/adjoint/derivatives/stage_hessian.h"

#include <gtest/gtest.h>

#include "hbar/adjoint/stage/parameter_derivatives.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "tests/support/duals.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;

constexpr int kBentSteps = 3;
constexpr Eigen::Index kBentDesigns = 3;

/// A made-up trajectory of a random model with contacts, sensors and measurements of every sort of
/// dependence, whose parameters of some kinds move along three design variables.
class EveryStagesHessian : public ::testing::TestWithParam<unsigned> {
 protected:
  EveryStagesHessian() {
    hessian.set_parameters(p, map_jacobian);
    trajectory.timeline = even_timeline(find_integrator("bdf2"), 0.05, kBentSteps);
    const Eigen::Index stages = trajectory.timeline.stage_count();
    trajectory.q = 1.5 * random.matrix(n, stages);
    trajectory.qdot = 2.0 * random.matrix(n, stages);
    trajectory.inputs = {p, 0.9 * random.matrix(controls, kBentSteps), trajectory.q.col(0),
                         trajectory.qdot.col(0)};
    trajectory.mechanism = horizon.mechanism(p);
  }

  static SimulationOptions options_of_model(const Model& model) {
    SimulationOptions out;
    out.integrator = "bdf2";
    out.h = 0.05;
    out.steps = kBentSteps;
    out.measurements = {PointVelocity{"speed", 13, {0.1, -0.2, 0.3}}, ContactForce{"push", 0},
                        CentreOfMass{"centre"}};
    for (int m = 0; m < static_cast<int>(model.motors().size()); ++m) {
      out.measurements.emplace_back(MotorPower{concat("power", m), m});
    }
    return out;
  }
  [[nodiscard]] VectorXd random_rows() { return random.vector(horizon.measured_count()); }

  // Where each part stands in x = (q, q̇, a, start q, start q̇, u, d).
  [[nodiscard]] Eigen::Index place(int part) const { return part * n; }
  [[nodiscard]] Eigen::Index size() const { return 5 * n + controls + kBentDesigns; }

  /// Gradient of z·g + y·outputs by x at a stage's point moved by `moved`.      [x]
  VectorX<Dual> gradient_at(const StagePoint<double>& at, const VectorX<Dual>& moved,
                            const VectorXd& z, const VectorXd* y) {
    StagePoint<Dual> point = testing::as_dual(model, at);
    point.q += moved.segment(place(0), n);
    point.qdot += moved.segment(place(1), n);
    point.a += moved.segment(place(2), n);
    point.start.q += moved.segment(place(3), n);
    point.start.qdot += moved.segment(place(4), n);
    point.u += moved.segment(place(5), controls);
    const VectorX<Dual> values =
        p.cast<Dual>() + map_jacobian.cast<Dual>() * moved.tail(kBentDesigns);
    auto mechanism = nominal_mechanism<Dual>(model);
    apply_parameters<Dual>(model, set, values, mechanism);
    VectorX<Dual> by_q = VectorX<Dual>::Constant(n, Dual(0.0));
    VectorX<Dual> by_qdot = by_q;
    VectorX<Dual> by_u = VectorX<Dual>::Constant(controls, Dual(0.0));
    VectorX<Dual> by_p = VectorX<Dual>::Constant(set.size(), Dual(0.0));
    VectorX<Dual> out = VectorX<Dual>::Constant(size(), Dual(0.0));
    if (z.size() > 0) {
      const VectorX<Dual> weights = z.cast<Dual>();
      StageResidual<Dual> stage(model);
      VectorX<Dual> g(n);
      stage.linearize(mechanism, point, g);
      stage.pull_back(weights);
      by_q = stage.by_q();
      by_qdot = stage.by_qdot();
      out.segment(place(2), n) = stage.by_a();
      const JointForces<Dual>& forces = stage.joint_forces();
      out.segment(place(3), n) = Dual(-point.c()) * weights.cwiseProduct(forces.by_start_q);
      out.segment(place(4), n) = Dual(-point.c()) * weights.cwiseProduct(forces.by_start_qdot);
      for (int m = 0; m < static_cast<int>(model.motors().size()); ++m) {
        const CoordinateRange range =
            model.coordinates_of_link(model.motors()[static_cast<std::size_t>(m)].link);
        for (int c = range.begin; c < range.end; ++c) {
          const int control = model.first_control(m) + c - range.begin;
          by_u[control] = Dual(-point.c()) * weights[c] * forces.by_u[control];
        }
      }
      add_parameter_gradient<Dual>({mechanism, set, values}, stage, point, weights, 1.0, by_p);
    }
    if (y != nullptr) {
      Measurements<Dual> measurements(model, horizon.measurements());
      InstantMotion<Dual> instants(model, true);
      const Applied<Dual> applied{mechanism, set, values};
      const Instant<Dual> instant = instants.at(applied, point.q, point.qdot, point.u);
      InstantGradient<Dual> by{by_q, by_qdot, by_u, by_p};
      measurements.linearize(instant);
      measurements.pull_back(instant, y->cast<Dual>(), by);
    }
    out.segment(place(0), n) = by_q;
    out.segment(place(1), n) = by_qdot;
    out.segment(place(5), controls) = by_u;
    out.tail(kBentDesigns) = map_jacobian.transpose().cast<Dual>() * by_p;
    return out;
  }

  /// The blocks in their places, zero where the header says that there is nothing.   [x x x]
  [[nodiscard]] MatrixXd assembled(const StageCurvature& h) const {
    MatrixXd out = MatrixXd::Zero(size(), size());
    const auto put = [&](Eigen::Index row, Eigen::Index column, const MatrixXd& block) {
      out.block(row, column, block.rows(), block.cols()) = block;
      out.block(column, row, block.cols(), block.rows()) = block.transpose();
    };
    const Eigen::Index u = place(5);
    const Eigen::Index d = u + controls;
    put(place(0), place(0), h.qq);
    put(place(0), place(1), h.qv);
    put(place(0), place(2), h.qa);
    put(place(1), place(1), h.vv);
    put(u, place(0), h.uq);
    put(u, place(1), h.uv);
    put(d, place(0), h.dq);
    put(d, place(1), h.dv);
    put(d, place(2), h.da);
    put(d, place(3), h.dsq);
    put(d, place(4), h.dsv);
    put(d, u, h.du);
    put(d, d, h.dd);
    return out;
  }
  /// The blocks against gradients that move, along directions of every part alone and of all.
  void expect_exact(const StageCurvature& h, const StagePoint<double>& at, const VectorXd& z,
                    const VectorXd* y) {
    const MatrixXd H = assembled(h);
    EXPECT_LT(testing::relative_gap(H, H.transpose()), 1e-12);
    for (int part = 0; part <= 7; ++part) {
      VectorXd d = random.vector(size());
      const Eigen::Index begin = part <= 5 ? place(part) : part == 6 ? size() - kBentDesigns : 0;
      const Eigen::Index end = part < 5    ? place(part + 1)
                               : part == 5 ? size() - kBentDesigns
                                           : size();
      d.head(begin).setZero();
      d.tail(size() - end).setZero();
      const VectorX<Dual> moved = testing::with_slope(VectorXd(VectorXd::Zero(size())), d);
      const VectorXd expected = testing::slopes(gradient_at(at, moved, z, y));
      const VectorXd found = H * d;
      EXPECT_LE(testing::largest((found - expected).eval()), 1e-12 * testing::largest(H))
          << "part " << part;
    }
  }

  const Model model = testing::random_contact_model(GetParam());
  const ParameterSet set = ParameterSet::named(
      model, {"joint.j3", "joint.j6", "body.b4", "body.b9", "motor", "contact"});
  Random random{GetParam()};
  Horizon horizon{model, set, options_of_model(model)};
  const Eigen::Index n = model.dof();
  const Eigen::Index controls = model.control_count();
  const VectorXd p = testing::random_parameters(set, random);
  const MatrixXd map_jacobian = 0.1 * random.matrix(set.size(), kBentDesigns);
  StageHessian hessian{horizon, kBentDesigns};
  Trajectory trajectory;
};

/// By a, start and u there are no second derivatives but those with q, q̇ and d that are listed:
/// full dual gradients find no other.
TEST_P(EveryStagesHessian, IsThatOfDualGradientsAndNothingIsLeftOut) {
  const int stage = trajectory.timeline.step_end(2);
  StagePoint<double> point(model);
  History(model).set_point(trajectory, stage, point);
  const VectorXd z = random.vector(n);
  const VectorXd y = random_rows();
  const StageCurvature& h = hessian.evaluate(trajectory, stage, z, &y);
  expect_exact(h, point, z, &y);
  EXPECT_GT(testing::largest(h.qa), 0.0);
  EXPECT_GT(testing::largest(h.uv), 0.0);
  EXPECT_GT(testing::largest(h.du), 0.0);
  EXPECT_GT(testing::largest(h.dsq), 0.0);
  EXPECT_GT(testing::largest(h.dsv), 0.0);
  const VectorXd by_d = map_jacobian.transpose() * h.by_p;
  const VectorX<Dual> still = VectorX<Dual>::Constant(size(), Dual(0.0));
  const VectorXd expected = testing::values(gradient_at(point, still, z, &y)).tail(kBentDesigns);
  EXPECT_LT(testing::relative_gap(by_d, expected), 1e-12);
}

TEST_P(EveryStagesHessian, ReadsNoOutputsWithinAStep) {
  const int stage = 1;
  StagePoint<double> point(model);
  History(model).set_point(trajectory, stage, point);
  const VectorXd z = random.vector(n);
  const StageCurvature& h = hessian.evaluate(trajectory, stage, z, nullptr);
  expect_exact(h, point, z, nullptr);
  EXPECT_EQ(testing::largest(h.uq), 0.0);
  EXPECT_EQ(testing::largest(h.uv), 0.0);
}

TEST_P(EveryStagesHessian, OfTheStartIsOfOutputsAlone) {
  StagePoint<double> point(model);
  point.q = trajectory.q.col(0);
  point.qdot = trajectory.qdot.col(0);
  point.u = trajectory.inputs.u.col(0);
  const VectorXd y = random_rows();
  hessian.evaluate(trajectory, 1, random.vector(n), &y);  // leaves nothing behind
  const StageCurvature& h = hessian.evaluate_start(trajectory, y);
  expect_exact(h, point, VectorXd(), &y);
  EXPECT_EQ(testing::largest(h.qa), 0.0);
  EXPECT_EQ(testing::largest(h.da), 0.0);
  EXPECT_EQ(testing::largest(h.dsq), 0.0);
  EXPECT_GT(testing::largest(h.qq), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryStagesHessian, ::testing::Values(1U, 2U));

}  // namespace
}  // namespace hbar
