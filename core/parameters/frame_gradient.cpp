#include "hbar/core/parameters/frame_gradient.h"

#include "hbar/core/base/rotation.h"

namespace hbar {

template <Scalar S>
FrameTwists<S> frame_twists(const Model& model, const Applied<S>& applied, const Motion<S>& motion,
                            const ParameterBlock& block) {
  Vector3<S> w = Vector3<S>::Zero();
  const std::vector<Parameter>& parameters = applied.set.parameters();
  for (int i = block.first; i < block.first + block.size; ++i) {
    const int k = parameters[static_cast<std::size_t>(i)].component;
    if (k < 3) {
      w[k] = applied.p[i];
    }
  }
  Matrix3<S> J_w;
  if (std::same_as<S, double> && w.isZero(0.0)) {
    J_w.setIdentity();  // the usual case: the frame is where the scene put it
  } else {
    J_w = right_jacobian(w);
  }
  if (block.kind == ParameterKind::kJointTransform) {
    const Node& node = model.tree().node(first_node_of_link(model, block.owner));
    return {rest_frame(model, applied.mechanism, motion, block.owner), motion.parent_of(node).R,
            J_w};
  }
  const NodeMotion<S>& joint = motion.at(model.node_of_link(block.owner));
  return {RigidTransform<S>{joint.R, joint.p} *
              applied.mechanism.X_JB[static_cast<std::size_t>(block.owner)],
          joint.R, J_w};
}

template <Scalar S>
void add_frame_gradient(const Model& model, const Applied<S>& applied, const Motion<S>& motion,
                        const ParameterBlock& block, const Vector6<S>& covector,
                        Eigen::Ref<VectorX<S>> grad) {
  const FrameTwists<S> twists = frame_twists<S>(model, applied, motion, block);
  // The covector as torque about the frame's origin, on the axes that w is
  // measured in, and force.
  const Vector3<S> force = covector.template tail<3>();
  const Vector3<S> torque = covector.template head<3>() - twists.frame.p.cross(force);
  const Vector3<S> by_w = twists.J_w.transpose() * (twists.frame.R.transpose() * torque);
  const Vector3<S> by_t = twists.R_parent.transpose() * force;
  const std::vector<Parameter>& parameters = applied.set.parameters();
  for (int i = block.first; i < block.first + block.size; ++i) {
    const int k = parameters[static_cast<std::size_t>(i)].component;
    grad[i] += k < 3 ? by_w[k] : by_t[k - 3];
  }
}

template FrameTwists<double> frame_twists(const Model&, const Applied<double>&,
                                          const Motion<double>&, const ParameterBlock&);
template FrameTwists<Dual> frame_twists(const Model&, const Applied<Dual>&, const Motion<Dual>&,
                                        const ParameterBlock&);
template void add_frame_gradient(const Model&, const Applied<double>&, const Motion<double>&,
                                 const ParameterBlock&, const Vector6<double>&,
                                 Eigen::Ref<VectorX<double>>);
template void add_frame_gradient(const Model&, const Applied<Dual>&, const Motion<Dual>&,
                                 const ParameterBlock&, const Vector6<Dual>&,
                                 Eigen::Ref<VectorX<Dual>>);

}  // namespace hbar
