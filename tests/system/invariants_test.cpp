// What the choice of frame, order, unit or chart must not change, and what physics conserves.

#include <gtest/gtest.h>

#include <numeric>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/rotation.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"
#include "tests/support/scenes.h"

namespace hbar {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::relative_gap;

Horizon make_horizon(const Model& model, const Integrator& integrator, double h, int steps) {
  SimulationOptions options;
  options.integrator = integrator.name;
  options.h = h;
  options.steps = steps;
  return {model, ParameterSet::all(model), options};
}

/// Energy of the double pendulum, whose end effectors are its centres of mass.
double energy(const Model& model, const TrajectoryValues& values, Eigen::Index k) {
  const VectorXd qdot = values.qdot.col(k);
  const auto mechanism = nominal_mechanism<double>(model);
  const Eigen::MatrixXd M =
      testing::mass_matrix_at<double>(model, mechanism, VectorXd(values.q.col(k)));
  double sum = 0.5 * qdot.dot(M * qdot);
  for (int i = 0; i < model.link_count(); ++i) {
    sum -= model.link(i).body.mass * model.gravity().dot(values.v().col(k).segment<3>(3 * i));
  }
  return sum;
}

TEST(EveryMethod, LosesEnergyWithItsOrder) {
  const Model model = testing::double_pendulum();
  for (const Integrator& integrator : integrators()) {
    const auto drift = [&](int n) {
      Horizon horizon = make_horizon(model, integrator, 1.0 / n, n);
      Inputs inputs = horizon.nominal_inputs();
      inputs.q0 << 0.8, -0.5;
      const TrajectoryValues values = read_values(horizon, simulate(horizon, inputs).trajectory());
      const double start = energy(model, values, 0);
      double largest = 0.0;
      for (Eigen::Index k = 1; k <= n; ++k) {
        largest = std::max(largest, std::abs(energy(model, values, k) - start));
      }
      return largest;
    };
    const double fine = drift(1600);
    EXPECT_GT(std::log2(drift(800) / fine), integrator.order - 0.05) << integrator.name;
    EXPECT_LT(fine, integrator.order == 1 ? 0.1 : 1e-3) << integrator.name;
  }
}

/// A free body that flies and spins.
Trajectory flight(const Horizon& horizon) {
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0 << 0.1, 0.2, 0.3, 0.2, -0.1, 0.3;
  inputs.qdot0 << 1.0, -2.0, 0.5, 1.0, 2.0, -1.5;
  return simulate(horizon, inputs).trajectory();
}

TEST(EveryMethod, ConservesTheMomentumOfAFreeBody) {
  for (const Integrator& integrator : integrators()) {
    for (const JointKind& kind : {JointKind(Free3dExpJoint{}), JointKind(Free3dEulerJoint{})}) {
      const Model model = testing::single_body(kind, Vector3d::Zero());
      Horizon horizon = make_horizon(model, integrator, 0.01, 100);
      const Trajectory trajectory = flight(horizon);
      const Vector3d velocity(1.0, -2.0, 0.5);
      for (int s = 0; s < trajectory.timeline.stage_count(); ++s) {
        EXPECT_LT((trajectory.qdot.col(s).head<3>() - velocity).norm(), 1e-12 * velocity.norm())
            << integrator.name << ' ' << joint_type(kind) << ' ' << s;
      }
    }
  }
}

TEST(EveryMethod, LosesAngularMomentumOfAFreeBodyWithItsOrder) {
  const Model model = testing::single_body(Free3dExpJoint{}, Vector3d::Zero());
  const Vector3d I = model.link(0).body.inertia;
  const auto momentum = [&](const VectorXd& q, const VectorXd& qdot) -> Vector3d {
    const Vector3d r = q.tail<3>();
    const Vector3d rate = qdot.tail<3>();
    return exp_rotation<double>(r) * I.cwiseProduct(right_jacobian<double>(r) * rate);
  };
  for (const Integrator& integrator : integrators()) {
    const auto drift = [&](int n) {
      Horizon horizon = make_horizon(model, integrator, 1.0 / n, n);
      const Trajectory trajectory = flight(horizon);
      return (momentum(trajectory.q_at_step(n), trajectory.qdot_at_step(n)) -
              momentum(trajectory.q_at_step(0), trajectory.qdot_at_step(0)))
          .norm();
    };
    const double fine = drift(1600);
    EXPECT_GT(std::log2(drift(800) / fine), integrator.order - 0.05) << integrator.name;
    EXPECT_LT(fine, integrator.order == 1 ? 0.01 : 1e-4) << integrator.name;
  }
}

/// The same mechanism with its links in another order and the world frame moved by X.
Model rebuilt(const Model& model, const std::vector<int>& order, const RigidTransform<double>& X) {
  ModelBuilder builder(model.name(), model.units());
  builder.set_gravity(X.R * model.gravity());
  std::vector<int> index(order.size());
  for (const int i : order) {
    const Link& link = model.link(i);
    Joint joint = link.joint;
    if (link.parent < 0) {
      joint.X_PJ = X * joint.X_PJ;
    }
    const int parent = link.parent < 0 ? -1 : index[static_cast<std::size_t>(link.parent)];
    index[static_cast<std::size_t>(i)] =
        builder.add_link(parent, joint, link.body, link.name, link.design_mask);
  }
  for (Motor motor : model.motors()) {
    motor.link = index[static_cast<std::size_t>(motor.link)];
    builder.add_motor(motor);
  }
  for (EndEffector end_effector : model.end_effectors()) {
    end_effector.link = index[static_cast<std::size_t>(end_effector.link)];
    builder.add_end_effector(end_effector);
  }
  return builder.build();
}

std::vector<int> in_order(const Model& model) {
  std::vector<int> order(static_cast<std::size_t>(model.link_count()));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// A simulation of 6 steps with its gradient.
struct Example {
  Example(const Model& m, const Integrator& integrator, const Objective& objective,
          const VectorXd& q0, const VectorXd& qdot0)
      : horizon(make_horizon(m, integrator, 0.01, 6)), inputs(horizon.nominal_inputs()) {
    testing::Random random(5);
    inputs.u = 0.8 * random.matrix(inputs.u.rows(), inputs.u.cols());
    inputs.q0 = q0;
    inputs.qdot0 = qdot0;
    trajectory = simulate(horizon, inputs).trajectory();
    gradient = hbar::gradient(horizon, trajectory, objective);
  }
  Horizon horizon;
  Inputs inputs;
  Trajectory trajectory;
  Gradient gradient;
};

Objective of_coordinates() {
  Objective objective(squared_final_position());
  objective.add(squared_velocity());
  return objective;
}

TEST(Motion, DoesNotDependOnTheWorldFrame) {
  const Model model = testing::random_model(51);
  testing::Random random(6);
  const RigidTransform<double> X = testing::random_pose(random);
  const Model moved = rebuilt(model, in_order(model), X);
  const VectorXd q0 = random.vector(model.dof(), 0.3);
  const VectorXd qdot0 = random.vector(model.dof(), 0.5);
  for (const Integrator& integrator : integrators()) {
    const Example here(model, integrator, of_coordinates(), q0, qdot0);
    const Example there(moved, integrator, of_coordinates(), q0, qdot0);
    EXPECT_LT(relative_gap(there.trajectory.q, here.trajectory.q), 1e-11) << integrator.name;
    EXPECT_LT(relative_gap(there.trajectory.qdot, here.trajectory.qdot), 1e-11);
    VectorXd p = there.gradient.p;
    const ParameterSet& set = here.horizon.parameters();
    for (const ParameterBlock& block : set.blocks()) {
      // What is written in the world's axes turns with them.
      const bool root =
          block.kind == ParameterKind::kJointTransform && model.link(block.owner).parent < 0;
      if (root || block.kind == ParameterKind::kGravity) {
        const int first = block.first + (root ? 3 : 0);
        p.segment<3>(first) = X.R.transpose() * p.segment<3>(first).eval();
      }
    }
    EXPECT_LT(relative_gap(p, here.gradient.p), 1e-11) << integrator.name;
    EXPECT_LT(relative_gap(there.gradient.u, here.gradient.u), 1e-11) << integrator.name;
    EXPECT_LT(relative_gap(there.gradient.q0, here.gradient.q0), 1e-11) << integrator.name;
    EXPECT_LT(relative_gap(there.gradient.qdot0, here.gradient.qdot0), 1e-11) << integrator.name;
  }
}

TEST(Motion, DoesNotDependOnTheOrderOfLinks) {
  const Model model = testing::random_model(52);
  std::vector<int> order;  // deepest last link first, parents before it
  const auto visit = [&](const auto& self, int i) -> void {
    if (i < 0 || std::find(order.begin(), order.end(), i) != order.end()) {
      return;
    }
    self(self, model.link(i).parent);
    order.push_back(i);
  };
  for (int i = model.link_count() - 1; i >= 0; --i) {
    visit(visit, i);
  }
  ASSERT_NE(order, in_order(model));
  const Model permuted = rebuilt(model, order, {});
  Eigen::PermutationMatrix<Eigen::Dynamic> coordinates(model.dof());  // from model to permuted
  for (int i = 0; i < model.link_count(); ++i) {
    const CoordinateRange from = model.coordinates_of_link(i);
    const CoordinateRange to = permuted.coordinates_of_link(permuted.find_link(model.link(i).name));
    for (int k = 0; k < from.end - from.begin; ++k) {
      coordinates.indices()[from.begin + k] = to.begin + k;
    }
  }
  testing::Random random(7);
  const VectorXd q0 = random.vector(model.dof(), 0.3);
  const VectorXd qdot0 = random.vector(model.dof(), 0.5);
  Objective objective = of_coordinates();
  objective.add(squared_variables());
  for (const Integrator& integrator : integrators()) {
    const Example one(model, integrator, objective, q0, qdot0);
    const Example two(permuted, integrator, objective, coordinates * q0, coordinates * qdot0);
    EXPECT_LT(relative_gap(two.trajectory.q, coordinates * one.trajectory.q), 1e-11)
        << integrator.name;
    EXPECT_LT(relative_gap(two.gradient.q0, coordinates * one.gradient.q0), 1e-11);
    EXPECT_LT(relative_gap(two.gradient.qdot0, coordinates * one.gradient.qdot0), 1e-11);
    EXPECT_LT(relative_gap(two.gradient.u, one.gradient.u), 1e-11) << integrator.name;
    VectorXd p(one.gradient.p.size());
    for (int i = 0; i < p.size(); ++i) {
      p[i] = two.gradient.p[two.horizon.parameters().find(one.horizon.parameters()[i].name)];
    }
    EXPECT_LT(relative_gap(p, one.gradient.p), 1e-11) << integrator.name;
  }
}

/// A chain with lengths in units of 1 / L and masses in units of 1 / M.
Model chain_in_units(Units units, double L, double M) {
  ModelBuilder builder("chain", units);
  builder.set_gravity(L * testing::kGravity);
  int parent = -1;
  for (const JointKind& kind :
       {JointKind(RevoluteJoint{{0.0, 1.0, 0.0}}), JointKind(SphericalExpJoint{}),
        JointKind(PrismaticJoint{{0.6, 0.0, 0.8}}), JointKind(UniversalJoint{})}) {
    const bool length = std::holds_alternative<PrismaticJoint>(kind);
    const double per_displacement = M * (length ? 1.0 : L * L);
    const double displacement = length ? L : 1.0;
    Joint joint{.name = concat("joint", parent + 1), .kind = kind};
    joint.X_PJ.p = L * Vector3d(0.1, 0.2, -0.4);
    joint.stiffness = 3.0 * per_displacement;
    joint.damping = 0.1 * per_displacement;
    joint.limits = JointLimits{-0.2 * displacement, 0.2 * displacement, 50.0 * per_displacement};
    parent = builder.add_link(
        parent, joint,
        testing::body_at(L * Vector3d(0.05, 0.0, -0.2), M, M * L * L * Vector3d(0.03, 0.04, 0.05),
                         concat("body", parent + 1)));
    builder.add_motor({.link = parent,
                       .kind = Motor::Kind::kPosition,
                       .P = 2.0 * per_displacement,
                       .D = 0.2 * per_displacement,
                       .implicit = length});
  }
  return builder.build();
}

TEST(Motion, DoesNotDependOnTheUnits) {
  const Model metres = chain_in_units(Units::kMetreKilogram, 1.0, 1.0);
  const Model centimetres = chain_in_units(Units::kCentimetreGram, 100.0, 1000.0);
  VectorXd unit = VectorXd::Ones(metres.dof());  // of each coordinate, in centimetres
  unit[4] = 100.0;
  ASSERT_TRUE(metres.coordinate_name(4).starts_with("joint2"));
  const VectorXd q0 = VectorXd::LinSpaced(metres.dof(), -0.3, 0.4);
  const VectorXd qdot0 = VectorXd::LinSpaced(metres.dof(), 1.0, -1.0);
  for (const Integrator& integrator : integrators()) {
    Horizon in_metres = make_horizon(metres, integrator, 0.01, 100);
    Horizon in_centimetres = make_horizon(centimetres, integrator, 0.01, 100);
    Inputs inputs = in_metres.nominal_inputs();
    inputs.u.setConstant(0.1);
    inputs.q0 = q0;
    inputs.qdot0 = qdot0;
    Inputs scaled = in_centimetres.nominal_inputs();
    scaled.u = unit.asDiagonal() * inputs.u;
    scaled.q0 = unit.asDiagonal() * q0;
    scaled.qdot0 = unit.asDiagonal() * qdot0;
    const Trajectory one = simulate(in_metres, inputs).trajectory();
    const Trajectory two = simulate(in_centimetres, scaled).trajectory();
    EXPECT_LT(relative_gap(unit.cwiseInverse().asDiagonal() * two.q, one.q), 1e-10)
        << integrator.name;
    EXPECT_LT(relative_gap(unit.cwiseInverse().asDiagonal() * two.qdot, one.qdot), 1e-10)
        << integrator.name;
  }
}

/// Gradient of a body that swings about x from the angle a, by inputs that keep it in its plane:
/// mass, inertia.x, gravity.z, q0 and q̇0 about x.
VectorXd planar_gradient(const JointKind& kind, const Integrator& integrator, double a) {
  ModelBuilder builder("swing");
  builder.set_gravity(testing::kGravity);
  builder.add_link(-1, Joint{.name = "joint", .kind = kind},
                   testing::body_at({0.0, 0.3, -0.4}, 1.5, {0.1, 0.12, 0.14}, "body"));
  builder.add_end_effector({.name = "tip", .link = 0, .position = {0.1, 0.2, -0.8}});
  Horizon horizon = make_horizon(builder.build(), integrator, 0.01, 30);
  Inputs inputs = horizon.nominal_inputs();
  inputs.q0[0] = a;
  inputs.qdot0[0] = 0.7;
  // The tip keeps its distance from the origin: only a target elsewhere has a gradient.
  const Objective objective(variable_tracking(Eigen::Vector3d(0.2, 0.1, -0.3)));
  const Gradient g = gradient(horizon, simulate(horizon, inputs).trajectory(), objective);
  const ParameterSet& set = horizon.parameters();
  VectorXd out(5);
  out << g.p[set.find("body.body.mass")], g.p[set.find("body.body.inertia.x")],
      g.p[set.find("gravity.z")], g.q0[0], g.qdot0[0];
  return out;
}

TEST(ExponentialCoordinates, AreExactAtAndNearZero) {
  for (const Integrator& integrator : integrators()) {
    for (const double a : {0.0, 1e-9, -1e-9, 1e-5, 1e-2}) {
      const VectorXd exponential = planar_gradient(SphericalExpJoint{}, integrator, a);
      const VectorXd euler = planar_gradient(SphericalEulerJoint{}, integrator, a);
      const VectorXd hinge = planar_gradient(RevoluteJoint{Vector3d::UnitX()}, integrator, a);
      EXPECT_LT(relative_gap(exponential, euler), 1e-11) << integrator.name << ' ' << a;
      EXPECT_LT(relative_gap(exponential, hinge), 1e-11) << integrator.name << ' ' << a;
    }
    EXPECT_LT(relative_gap(planar_gradient(SphericalExpJoint{}, integrator, 1e-9),
                           planar_gradient(SphericalExpJoint{}, integrator, 0.0)),
              1e-8)
        << integrator.name;
  }
}

}  // namespace
}  // namespace hbar
