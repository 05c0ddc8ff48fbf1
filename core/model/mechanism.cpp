#include "hbar/core/model/mechanism.h"

namespace hbar {
namespace {

template <Scalar S>
RigidTransform<S> cast(const RigidTransform<double>& X) {
  return {X.R.cast<S>(), X.p.cast<S>()};
}

}  // namespace

template <Scalar S>
void Mechanism<S>::update_derived(const Model& model) {
  for (std::size_t i = 0; i < inertia.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    inertia[i] = body_inertia<S>(mass[k], moments.col(k), X_JB[i]);
    const Eigen::Matrix3Xd points =
        contact_points[i].unaryExpr([](const S& entry) { return value_of(entry); });
    contact_radius[k] = points.cols() == 0 ? 0.0 : points.colwise().norm().maxCoeff();
    bound_clusters(model.point_clusters(static_cast<int>(i)), points, contact_clusters[i]);
  }
}

template <Scalar S>
Mechanism<S> nominal_mechanism(const Model& model) {
  const auto links = static_cast<Eigen::Index>(model.link_count());
  const auto motors = static_cast<Eigen::Index>(model.motors().size());
  Mechanism<S> m;
  m.mass.resize(links);
  m.moments.resize(3, links);
  m.stiffness.resize(links);
  m.damping.resize(links);
  m.sizes.setZero(3, links);
  m.contact_scale.setOnes(links);
  m.contact_radius.setZero(links);
  m.contact_coefficients.resize(4, model.contact_count());
  m.motor_P.resize(motors);
  m.motor_D.resize(motors);
  m.gravity = model.gravity().cast<S>();
  for (Eigen::Index i = 0; i < links; ++i) {
    const Link& link = model.link(static_cast<int>(i));
    m.X_PJ.push_back(cast<S>(link.joint.X_PJ));
    m.X_JB.push_back(cast<S>(link.body.X_JB));
    m.mass[i] = link.body.mass;
    m.moments.col(i) = link.body.inertia.cast<S>();
    m.stiffness[i] = link.joint.stiffness;
    m.damping[i] = link.joint.damping;
    const std::vector<double> sizes = sizes_of(link.body.shape);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      m.sizes(static_cast<Eigen::Index>(k), i) = sizes[k];
    }
    m.contact_points.push_back(link.body.contact_points.cast<S>());
    m.contact_clusters.emplace_back(4, model.point_clusters(static_cast<int>(i)).size());
  }
  for (Eigen::Index i = 0; i < motors; ++i) {
    const Motor& motor = model.motors()[static_cast<std::size_t>(i)];
    m.motor_P[i] = motor.P;
    m.motor_D[i] = motor.D;
  }
  for (int i = 0; i < model.contact_count(); ++i) {
    const ContactCoefficients& c = model.contact(i).coefficients;
    m.contact_coefficients.col(i) = Eigen::Vector4d(c.kn, c.kt, c.mu, c.damping).cast<S>();
  }
  m.inertia.resize(static_cast<std::size_t>(links));
  m.update_derived(model);
  return m;
}

template struct Mechanism<double>;
template struct Mechanism<Dual>;
template Mechanism<double> nominal_mechanism(const Model&);
template Mechanism<Dual> nominal_mechanism(const Model&);

}  // namespace hbar
