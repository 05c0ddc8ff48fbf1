#include "hbar/core/parameters/link_pullback.h"

#include <gtest/gtest.h>

#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

/// What a test of LinkPullback reads: the place of a point fixed in the joint frame of a link, and
/// the twist of a body about a point that it carries, all weighted.
class EveryModelsLinks : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Σ over the links of w·x of a joint's point, and of W·V at a body's point.
  template <Scalar S>
  S reading(const VectorX<S>& q, const VectorX<S>& qdot, const VectorX<S>& values) const {
    auto numbers = nominal_mechanism<S>(model);
    apply_parameters<S>(model, set, values, numbers);
    Motion<S> moving(model.tree());
    compute_motion<S>(model.tree(), numbers, q, qdot, VectorX<S>::Zero(model.dof()), moving);
    S out(0.0);
    for (int link = 0; link < model.link_count(); ++link) {
      const NodeMotion<S>& joint = moving.at(model.node_of_link(link));
      const Vector3<S> x = joint.p + joint.R * place.cast<S>();
      out += weights.col(link).template head<3>().template cast<S>().dot(x);
      const BodyMotion<S> body = body_motion<S>(model, numbers, moving, link);
      out += S(2.0 + link) * body.V.dot(body_load<S>(body));
    }
    return out;
  }
  /// A wrench that turns with the body: a force and a torque of its own axes, at its origin.
  template <Scalar S>
  Vector6<S> body_load(const BodyMotion<S>& body) const {
    const Vector3<S> force = body.X_WB.R * place.cast<S>();
    const Vector3<S> torque = body.X_WB.R * Vector3<S>(S(0.3), S(-0.2), S(0.5));
    return spatial<S>(torque + body.X_WB.p.cross(force), force);
  }

  const Model model = testing::random_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  const Eigen::Vector3d place = random.vector3();
  const Eigen::MatrixXd weights = random.matrix(3, model.link_count());
  const testing::State state = testing::random_state(model, random);
  const VectorXd p = testing::random_parameters(set, random);
};

TEST_P(EveryModelsLinks, AreDifferentiatedByTheirCovectors) {
  auto mechanism = nominal_mechanism<double>(model);
  apply_parameters<double>(model, set, p, mechanism);
  Motion<double> motion(model.tree());
  compute_motion<double>(model.tree(), mechanism, state.q, state.qdot, state.a, motion);
  LinkPullback<double> links(model);
  VectorXd by_q(model.dof());
  VectorXd by_qdot(model.dof());
  VectorXd by_p(set.size());
  for (int round = 0; round < 2; ++round) {  // the second one forgets the first
    links.clear();
    for (int link = 0; link < model.link_count(); ++link) {
      const NodeMotion<double>& joint = motion.at(model.node_of_link(link));
      const Eigen::Vector3d force = weights.col(link);
      const Eigen::Vector3d x = joint.p + joint.R * place;
      links.add_to_joint(link, spatial<double>(x.cross(force), force));
      // V·load, both carried along, does not change.
      const BodyMotion<double> body = body_motion(model, mechanism, motion, link);
      links.add_to_body(link, Vector6<double>::Zero(), (2.0 + link) * body_load(body));
    }
    links.sum();
    by_q.setOnes();
    by_qdot.setOnes();
    by_p.setOnes();
    links.add_coordinates(motion, by_q);
    links.add_rates(motion, by_qdot);
    links.add_frames({mechanism, set, p}, motion, by_p);
  }
  const auto one = [](const Dual& value) { return VectorX<Dual>::Constant(1, value).eval(); };
  const VectorX<Dual> q = state.q.cast<Dual>();
  const VectorX<Dual> qdot = state.qdot.cast<Dual>();
  const VectorX<Dual> values = p.cast<Dual>();
  const Eigen::MatrixXd exact_q = testing::dual_jacobian(
      [&](const VectorX<Dual>& x) { return one(reading<Dual>(x, qdot, values)); }, state.q);
  const Eigen::MatrixXd exact_qdot = testing::dual_jacobian(
      [&](const VectorX<Dual>& x) { return one(reading<Dual>(q, x, values)); }, state.qdot);
  const Eigen::MatrixXd exact_p = testing::dual_jacobian(
      [&](const VectorX<Dual>& x) { return one(reading<Dual>(q, qdot, x)); }, p);
  const auto ones = [](const VectorXd& x) { return VectorXd::Ones(x.size()); };
  EXPECT_LT(relative_gap(by_q - ones(by_q), exact_q.transpose()), 1e-12);
  EXPECT_LT(relative_gap(by_qdot - ones(by_qdot), exact_qdot.transpose()), 1e-12);
  EXPECT_LT(relative_gap(by_p - ones(by_p), exact_p.transpose()), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsLinks, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
