#include "hbar/core/parameters/link_pullback.h"

#include "hbar/core/parameters/frame_gradient.h"

namespace hbar {
namespace {

/// Covector on a frame's displacement D when the twists carried by D also change by V × D.
template <Scalar S>
Vector6<S> frame_covector(const Vector6<S>& by_displacement, const Vector6<S>& by_twist,
                          const Vector6<S>& V) {
  return sum<S>(by_displacement, cross_wrench<S>(-V, by_twist));
}

}  // namespace

template <Scalar S>
LinkPullback<S>::LinkPullback(const Model& model)
    : model_(model),
      bodies_(model.link_count()),
      by_displacement_(static_cast<std::size_t>(model.tree().node_count())),
      by_twist_(by_displacement_.size()) {
  clear();
}

template <Scalar S>
void LinkPullback<S>::clear() {
  for (auto* covectors :
       {&bodies_.by_displacement, &bodies_.by_twist, &by_displacement_, &by_twist_}) {
    for (Vector6<S>& covector : *covectors) {
      covector.setZero();
    }
  }
}

template <Scalar S>
void LinkPullback<S>::add_to_body(int link, const Vector6<S>& by_displacement,
                                  const Vector6<S>& by_twist) {
  const auto body = static_cast<std::size_t>(link);
  bodies_.by_displacement[body] += by_displacement;
  bodies_.by_twist[body] += by_twist;
  const auto node = static_cast<std::size_t>(model_.node_of_link(link));
  by_displacement_[node] += by_displacement;
  by_twist_[node] += by_twist;
}

template <Scalar S>
void LinkPullback<S>::add_to_joint(int link, const Vector6<S>& by_displacement) {
  by_displacement_[static_cast<std::size_t>(model_.node_of_link(link))] += by_displacement;
}

template <Scalar S>
void LinkPullback<S>::sum() {
  const Tree& tree = model_.tree();
  for (int i = tree.node_count(); i-- > 0;) {
    if (tree.node(i).parent >= 0) {
      const auto k = static_cast<std::size_t>(i);
      const auto above = static_cast<std::size_t>(tree.node(i).parent);
      by_displacement_[above] += by_displacement_[k];
      by_twist_[above] += by_twist_[k];
    }
  }
}

template <Scalar S>
void LinkPullback<S>::add_coordinates(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_q) const {
  const Tree& tree = model_.tree();
  for (int i = 0; i < tree.node_count(); ++i) {
    const Node& node = tree.node(i);
    const auto k = static_cast<std::size_t>(i);
    const Vector6<S> G =
        frame_covector<S>(by_displacement_[k], by_twist_[k], motion.parent_of(node).V);
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      by_q[c] += power<S>(G, motion.J.col(c));
      if (node.motion == MotionKind::kExponential) {
        const auto e = static_cast<std::size_t>(c - node.coordinates.begin);
        by_q[c] += power<S>(by_twist_[k], motion.exponential(i).W[e]);
      }
    }
  }
}

template <Scalar S>
void LinkPullback<S>::add_rates(const Motion<S>& motion, Eigen::Ref<VectorX<S>> by_qdot) const {
  const Tree& tree = model_.tree();
  for (int c = 0; c < tree.dof(); ++c) {
    by_qdot[c] += power<S>(by_twist_[static_cast<std::size_t>(tree.node_of(c))], motion.J.col(c));
  }
}

template <Scalar S>
void LinkPullback<S>::add_frames(const Applied<S>& applied, const Motion<S>& motion,
                                 Eigen::Ref<VectorX<S>> grad_p) const {
  for (const ParameterBlock& block : applied.set.blocks()) {
    if (block.kind == ParameterKind::kJointTransform) {
      const int first = first_node_of_link(model_, block.owner);
      const auto k = static_cast<std::size_t>(first);
      add_frame_gradient<S>(model_, applied, motion, block,
                            frame_covector<S>(by_displacement_[k], by_twist_[k],
                                              motion.parent_of(model_.tree().node(first)).V),
                            grad_p);
    } else if (block.kind == ParameterKind::kBodyTransform) {
      const auto k = static_cast<std::size_t>(block.owner);
      add_frame_gradient<S>(model_, applied, motion, block,
                            frame_covector<S>(bodies_.by_displacement[k], bodies_.by_twist[k],
                                              motion.at(model_.node_of_link(block.owner)).V),
                            grad_p);
    }
  }
}

template class LinkPullback<double>;
template class LinkPullback<Dual>;

}  // namespace hbar
