#include "hbar/adjoint/outputs/end_effectors.h"

namespace hbar {

template <Scalar S>
EndEffectors<S>::EndEffectors(const Model& model) : model_(model), links_(model) {}

template <Scalar S>
Vector3<S> EndEffectors<S>::position(const Motion<S>& motion, std::size_t i) const {
  const EndEffector& point = model_.end_effectors()[i];
  const NodeMotion<S>& node = motion.at(model_.node_of_link(point.link));
  return node.p + node.R * point.position.cast<S>();
}

template <Scalar S>
void EndEffectors<S>::positions(const Motion<S>& motion, Eigen::Ref<VectorX<S>> v) const {
  for (std::size_t i = 0; i < model_.end_effectors().size(); ++i) {
    v.template segment<3>(3 * static_cast<Eigen::Index>(i)) = position(motion, i);
  }
}

template <Scalar S>
void EndEffectors<S>::pull_back(const Mechanism<S>& mechanism, const ParameterSet& set,
                                const VectorView<S>& p, const Motion<S>& motion,
                                const VectorView<S>& y, Eigen::Ref<VectorX<S>> by_q,
                                Eigen::Ref<VectorX<S>> grad_p) {
  links_.clear();
  for (std::size_t i = 0; i < model_.end_effectors().size(); ++i) {
    const Vector3<S> force = y.template segment<3>(3 * static_cast<Eigen::Index>(i));
    links_.add_to_joint(model_.end_effectors()[i].link,
                        spatial<S>(position(motion, i).cross(force), force));
  }
  links_.sum();
  links_.add_coordinates(motion, by_q);
  links_.add_frames(mechanism, set, p, motion, grad_p);
}

template <Scalar S>
void EndEffectors<S>::jacobian(const Motion<S>& motion, Eigen::Ref<MatrixX<S>> dv_dq) const {
  const Tree& tree = model_.tree();
  dv_dq.setZero();
  for (std::size_t i = 0; i < model_.end_effectors().size(); ++i) {
    const Vector3<S> x = position(motion, i);
    const int node = model_.node_of_link(model_.end_effectors()[i].link);
    const auto displace = [&](int c) {
      const Vector6<S> J = motion.J.col(c);
      const Vector3<S> w = J.template head<3>();
      dv_dq.template block<3, 1>(3 * static_cast<Eigen::Index>(i), c) =
          J.template tail<3>() + w.cross(x);
    };
    for (const CoordinateRange& range : tree.ancestors(node)) {
      for (int c = range.begin; c < range.end; ++c) {
        displace(c);
      }
    }
    for (int c = tree.node(node).coordinates.begin; c < tree.node(node).coordinates.end; ++c) {
      displace(c);
    }
  }
}

template class EndEffectors<double>;
template class EndEffectors<Dual>;

}  // namespace hbar
