#include "hbar/adjoint/stage/parameter_derivatives.h"

#include "hbar/contact/contact_parameters.h"
#include "hbar/core/model/drives.h"
#include "hbar/core/parameters/frame_gradient.h"
#include "hbar/core/parameters/parameter_kinds.h"

namespace hbar {
namespace {

/// ∂F/∂m, and the torques of ∂F/∂(principal moments), which have no force, of a link's body, world.
template <Scalar S>
struct InertiaWrenches {
  Vector6<S> by_mass;
  Matrix3<S> torque_by_moment;  // a column each
};

template <Scalar S>
InertiaWrenches<S> inertia_wrenches(const Model& model, const Mechanism<S>& mechanism,
                                    const Motion<S>& motion, int link) {
  const NodeMotion<S>& joint = motion.at(model.node_of_link(link));
  const RigidTransform<S> body =
      RigidTransform<S>{joint.R, joint.p} * mechanism.X_JB[static_cast<std::size_t>(link)];
  const Vector3<S> w = joint.V.template head<3>();
  const Vector3<S> u = joint.V.template tail<3>();
  const Vector3<S> w_dot = joint.A.template head<3>();
  const Vector3<S> velocity = u + w.cross(body.p);
  // Acceleration of the centre of mass, gravity included.
  const Vector3<S> acceleration =
      joint.A.template tail<3>() + w_dot.cross(body.p) + w.cross(velocity);
  InertiaWrenches<S> out;
  out.by_mass = spatial<S>(body.p.cross(acceleration), acceleration);
  for (int k = 0; k < 3; ++k) {
    // Torque of a unit moment about body axis k: e (e·ω̇) + ω × e (e·ω).
    const Vector3<S> e = body.R.col(k);
    out.torque_by_moment.col(k) = e * e.dot(w_dot) + w.cross(e) * e.dot(w);
  }
  return out;
}

}  // namespace

template <Scalar S>
void add_parameter_gradient(const Applied<S>& applied, const StageResidual<S>& stage,
                            const StagePoint<S>& point, const VectorView<S>& z, double factor,
                            Eigen::Ref<VectorX<S>> grad) {
  const Model& model = stage.model();
  const Motion<S>& motion = stage.motion();
  const Pullback<S>& pullback = stage.pullback();
  const double scale = factor * point.c();
  const std::vector<Parameter>& parameters = applied.set.parameters();
  const auto component = [&](int i) { return parameters[static_cast<std::size_t>(i)].component; };
  int weighed = -1;  // the link of the two below: its mass and its moments follow each other
  S by_mass(0.0);
  Vector3<S> by_moments = Vector3<S>::Zero();
  for (const ParameterBlock& block : applied.set.blocks()) {
    const ParameterKindRow& kind = row_of(block.kind);
    switch (kind.effect) {
      case ParameterEffect::kJointFrame: {
        const Vector6<S> G = scale * pullback.joint_frame(first_node_of_link(model, block.owner));
        add_frame_gradient<S>(model, applied, motion, block, G, grad);
        break;
      }
      case ParameterEffect::kBodyFrame: {
        const Vector6<S> G = scale * stage.body_frame(block.owner);
        add_frame_gradient<S>(model, applied, motion, block, G, grad);
        break;
      }
      case ParameterEffect::kInertia: {
        if (weighed != block.owner) {
          const auto wrenches = inertia_wrenches<S>(model, applied.mechanism, motion, block.owner);
          const Vector6<S>& W = pullback.twist(model.node_of_link(block.owner));
          by_mass = W.dot(wrenches.by_mass);
          by_moments = wrenches.torque_by_moment.transpose() * W.template head<3>();
          weighed = block.owner;
        }
        for (int i = block.first; i < block.first + block.size; ++i) {
          const InertiaRate<S> rate = kind.actions<S>().inertia_rate(
              model, applied.mechanism, block.owner, {component(i), applied.p[i]});
          grad[i] += scale * (by_mass * rate.mass + by_moments.dot(rate.moments));
        }
        break;
      }
      case ParameterEffect::kJointForce: {
        const VectorX<S>& by = stage.joint_forces().*(kind.actions<S>().force_by);
        const CoordinateRange range = model.coordinates_of_link(block.owner);
        for (int c = range.begin; c < range.end; ++c) {
          grad[block.first] -= scale * z[c] * by[c];
        }
        break;
      }
      case ParameterEffect::kMotorForce: {
        const VectorX<S>& by = stage.joint_forces().*(kind.actions<S>().force_by);
        for_each_drive(model, block.owner,
                       [&](int c, int i) { grad[block.first] -= scale * z[c] * by[i]; });
        break;
      }
      case ParameterEffect::kGravity:
        for (int i = block.first; i < block.first + block.size; ++i) {
          grad[i] += scale * pullback.by_gravity()[component(i)];
        }
        break;
      case ParameterEffect::kContact:
        break;
    }
  }
  for_each_contact_change(
      stage.contacts(), applied, [&](int i, int contact, const PairWrenches<S>& change) {
        grad[i] += scale * stage.contacts().weigh(pullback.twists(), contact, change);
      });
}

namespace {

/// Column of a joint transformation: everything below `first` moves by D.
template <Scalar S>
void joint_frame_column(const StageResidual<S>& stage, int first, const Vector6<S>& D,
                        const std::vector<int>& rows, Eigen::Ref<VectorX<S>> column) {
  const Tree& tree = stage.model().tree();
  const auto by_frame = frame_displacement<S>(stage.motion().parent_of(tree.node(first)), D);
  const BodyDynamics<S>& below = stage.dynamics().below(first);
  const Vector6<S> wrench =
      below.I * by_frame.psi_ddot + below.B * by_frame.psi_dot + cross_wrench<S>(D, below.F);
  for (const int l : rows) {
    const int node = tree.node_of(l);
    if (tree.is_on_path(first, node)) {
      column[l] = stage.dynamics().IJ.col(l).dot(by_frame.psi_ddot) +
                  stage.dynamics().BJ.col(l).dot(by_frame.psi_dot.template head<3>());
    } else {
      column[l] = tree.is_on_path(node, first) ? stage.motion().J.col(l).dot(wrench) : S(0.0);
    }
  }
  stage.contacts().add_displacement_below(stage.motion(), first, D, by_frame.psi_dot, column);
}

/// Wrench by which a body changes F of everything above it, projected on a
/// path.
template <Scalar S>
void path_column(const StageResidual<S>& stage, int link, const Vector6<S>& wrench,
                 const std::vector<int>& rows, Eigen::Ref<VectorX<S>> column) {
  const Tree& tree = stage.model().tree();
  const int body = stage.model().node_of_link(link);
  for (const int l : rows) {
    column[l] =
        tree.is_on_path(tree.node_of(l), body) ? stage.motion().J.col(l).dot(wrench) : S(0.0);
  }
}

/// Column of a body transformation: the body alone moves by D.
template <Scalar S>
void body_frame_column(const StageResidual<S>& stage, int link, const Vector6<S>& D,
                       const std::vector<int>& rows, Eigen::Ref<VectorX<S>> column) {
  const BodyDynamics<S>& body = stage.dynamics().of_link(link);
  const auto by_frame =
      frame_displacement<S>(stage.motion().at(stage.model().node_of_link(link)), D);
  const Vector6<S> wrench =
      body.I * by_frame.psi_ddot + body.B * by_frame.psi_dot + cross_wrench<S>(D, body.F);
  path_column<S>(stage, link, wrench, rows, column);
  stage.contacts().add_displacement(
      stage.motion(), [link](int other) { return other == link; }, D, by_frame.psi_dot, column);
}

/// Columns of one block, except for the effect of contact parameters on wrenches.
template <Scalar S>
void block_columns(const Applied<S>& applied, const StageResidual<S>& stage,
                   const ParameterBlock& block, double c, Eigen::Ref<MatrixX<S>> columns) {
  const Model& model = stage.model();
  const Motion<S>& motion = stage.motion();
  const ParameterKindRow& kind = row_of(block.kind);
  const std::vector<int> rows = parameter_rows(model, block);
  const auto each = [&](const auto& fill) {
    for (int i = block.first; i < block.first + block.size; ++i) {
      auto column = columns.col(i);
      fill(i, column);
      for (const int l : rows) {
        column[l] *= c;
      }
    }
  };
  switch (kind.effect) {
    case ParameterEffect::kJointFrame: {
      const auto twists = frame_twists<S>(model, applied, motion, block);
      const int first = first_node_of_link(model, block.owner);
      each([&](int i, auto& column) {
        joint_frame_column<S>(stage, first, twists(applied.set[i].component), rows, column);
      });
      break;
    }
    case ParameterEffect::kBodyFrame: {
      const auto twists = frame_twists<S>(model, applied, motion, block);
      each([&](int i, auto& column) {
        body_frame_column<S>(stage, block.owner, twists(applied.set[i].component), rows, column);
      });
      break;
    }
    case ParameterEffect::kInertia: {
      const auto wrenches = inertia_wrenches<S>(model, applied.mechanism, motion, block.owner);
      each([&](int i, auto& column) {
        const InertiaRate<S> rate = kind.actions<S>().inertia_rate(
            model, applied.mechanism, block.owner, {applied.set[i].component, applied.p[i]});
        Vector6<S> wrench = rate.mass * wrenches.by_mass;
        wrench.template head<3>() += wrenches.torque_by_moment * rate.moments;
        path_column<S>(stage, block.owner, wrench, rows, column);
      });
      break;
    }
    case ParameterEffect::kContact:
      each([&](int, auto& column) { column(rows).setZero(); });
      break;
    case ParameterEffect::kJointForce: {
      const VectorX<S>& by = stage.joint_forces().*(kind.actions<S>().force_by);
      each([&](int, auto& column) {
        for (const int l : rows) {
          column[l] = -by[l];
        }
      });
      break;
    }
    case ParameterEffect::kMotorForce: {
      const VectorX<S>& by = stage.joint_forces().*(kind.actions<S>().force_by);
      each([&](int, auto& column) {
        for_each_drive(model, block.owner, [&](int k, int i) { column[k] = -by[i]; });
      });
      break;
    }
    case ParameterEffect::kGravity:
      each([&](int i, auto& column) {
        for (const int l : rows) {
          column[l] = -stage.dynamics().IJ(3 + applied.set[i].component, l);
        }
      });
      break;
  }
}

}  // namespace

template <Scalar S>
void parameter_columns(const Applied<S>& applied, const StageResidual<S>& stage,
                       const StagePoint<S>& point, Eigen::Ref<MatrixX<S>> columns) {
  const double c = point.c();
  for (const ParameterBlock& block : applied.set.blocks()) {
    block_columns<S>(applied, stage, block, c, columns);
  }
  for_each_contact_change(
      stage.contacts(), applied, [&](int i, int contact, const PairWrenches<S>& change) {
        stage.contacts().add_change(stage.motion(), contact, {c * change.on_a, c * change.on_b},
                                    columns.col(i));
      });
}

template void add_parameter_gradient(const Applied<double>&, const StageResidual<double>&,
                                     const StagePoint<double>&, const VectorView<double>&, double,
                                     Eigen::Ref<VectorX<double>>);
template void add_parameter_gradient(const Applied<Dual>&, const StageResidual<Dual>&,
                                     const StagePoint<Dual>&, const VectorView<Dual>&, double,
                                     Eigen::Ref<VectorX<Dual>>);
template void parameter_columns(const Applied<double>&, const StageResidual<double>&,
                                const StagePoint<double>&, Eigen::Ref<MatrixX<double>>);

}  // namespace hbar
