#include "hbar/adjoint/stage/parameter_derivatives.h"

#include "hbar/contact/contact_parameters.h"
#include "hbar/core/model/drives.h"
#include "hbar/core/parameters/frame_gradient.h"

namespace hbar {
namespace {

/// Wrenches ∂F/∂m and ∂F/∂(principal moments) of a link's body, world.
template <Scalar S>
struct InertiaWrenches {
  Vector6<S> by_mass;
  std::array<Vector6<S>, 3> by_moment;
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
    const Vector3<S> torque = e * e.dot(w_dot) + w.cross(e) * e.dot(w);
    out.by_moment[static_cast<std::size_t>(k)] = spatial<S>(torque, Vector3<S>::Zero());
  }
  return out;
}

/// ∂F of a link's body by one inertial parameter: mass and moments at nominal sizes, or a size.
template <Scalar S>
Vector6<S> inertial_wrench(const Model& model, const Mechanism<S>& mechanism,
                           const InertiaWrenches<S>& wrenches, const ParameterBlock& block, int k,
                           const S& value) {
  const int link = block.owner;
  if (block.kind == ParameterKind::kMass) {
    // The mechanism's mass is the parameter's times what sizes make of it; so are the moments.
    return (mechanism.mass[link] / value) * wrenches.by_mass;
  }
  if (block.kind == ParameterKind::kInertia) {
    return (mechanism.moments(k, link) / value) * wrenches.by_moment[static_cast<std::size_t>(k)];
  }
  const Shape& shape = model.link(link).body.shape;
  const Vector3<S> sizes = mechanism.sizes.col(link);
  const UnitSolid<S> solid = unit_solid<S>(shape, sizes);
  const UnitSolid<S> rate = unit_solid_rate<S>(shape, sizes, k);
  Vector6<S> out = (mechanism.mass[link] * rate.mass / solid.mass) * wrenches.by_mass;
  for (int i = 0; i < 3; ++i) {
    out += (mechanism.moments(i, link) * rate.moments[i] / solid.moments[i]) *
           wrenches.by_moment[static_cast<std::size_t>(i)];
  }
  return out;
}

}  // namespace

template <Scalar S>
void add_parameter_gradient(const Mechanism<S>& mechanism, const ParameterSet& set,
                            const VectorView<S>& p, const StageResidual<S>& stage,
                            const StagePoint<S>& point, const VectorView<S>& z, double factor,
                            Eigen::Ref<VectorX<S>> grad) {
  const Model& model = stage.model();
  const Motion<S>& motion = stage.motion();
  const Pullback<S>& pullback = stage.pullback();
  const JointForces<S>& forces = stage.joint_forces();
  const double scale = factor * point.c();
  for (const ParameterBlock& block : set.blocks()) {
    switch (block.kind) {
      case ParameterKind::kJointTransform: {
        const Vector6<S> G = scale * pullback.joint_frame(first_node_of_link(model, block.owner));
        add_frame_gradient<S>(model, mechanism, motion, set, block, p, G, grad);
        break;
      }
      case ParameterKind::kBodyTransform: {
        const Vector6<S> G = scale * stage.body_frame(block.owner);
        add_frame_gradient<S>(model, mechanism, motion, set, block, p, G, grad);
        break;
      }
      case ParameterKind::kMass:
      case ParameterKind::kInertia:
      case ParameterKind::kSize: {
        const auto wrenches = inertia_wrenches<S>(model, mechanism, motion, block.owner);
        const Vector6<S>& W = pullback.twist(model.node_of_link(block.owner));
        for (int i = block.first; i < block.first + block.size; ++i) {
          grad[i] += scale * W.dot(inertial_wrench<S>(model, mechanism, wrenches, block,
                                                      set[i].component, p[i]));
        }
        break;
      }
      case ParameterKind::kContactPoint:
      case ParameterKind::kContactScale:
      case ParameterKind::kContactCoefficient:
        break;  // by for_each_contact_change, below
      case ParameterKind::kStiffness:
      case ParameterKind::kDamping: {
        const VectorX<S>& by =
            block.kind == ParameterKind::kStiffness ? forces.by_stiffness : forces.by_damping;
        const CoordinateRange range = model.coordinates_of_link(block.owner);
        for (int c = range.begin; c < range.end; ++c) {
          grad[block.first] -= scale * z[c] * by[c];
        }
        break;
      }
      case ParameterKind::kMotorP:
      case ParameterKind::kMotorD: {
        const VectorX<S>& by = block.kind == ParameterKind::kMotorP ? forces.by_P : forces.by_D;
        for_each_drive(model, block.owner,
                       [&](int c, int i) { grad[block.first] -= scale * z[c] * by[i]; });
        break;
      }
      case ParameterKind::kGravity:
        for (int i = block.first; i < block.first + block.size; ++i) {
          grad[i] += scale * pullback.by_gravity()[set[i].component];
        }
        break;
    }
  }
  for_each_contact_change(
      stage.contacts(), mechanism, set, [&](int i, int contact, const PairWrenches<S>& change) {
        grad[i] += scale * stage.contacts().weigh(pullback.twists(), contact, change);
      });
}

namespace {

/// Column of a joint transformation: everything from `first` on moves by D.
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

/// Columns of one block, but for what contact parameters do to wrenches.
template <Scalar S>
void block_columns(const Mechanism<S>& mechanism, const ParameterSet& set, const VectorView<S>& p,
                   const StageResidual<S>& stage, const ParameterBlock& block, double c,
                   Eigen::Ref<MatrixX<S>> columns) {
  const Model& model = stage.model();
  const Motion<S>& motion = stage.motion();
  const JointForces<S>& forces = stage.joint_forces();
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
  switch (block.kind) {
    case ParameterKind::kJointTransform: {
      const auto twists = frame_twists<S>(model, mechanism, motion, set, block, p);
      const int first = first_node_of_link(model, block.owner);
      each([&](int i, auto& column) {
        joint_frame_column<S>(stage, first, twists(set[i].component), rows, column);
      });
      break;
    }
    case ParameterKind::kBodyTransform: {
      const auto twists = frame_twists<S>(model, mechanism, motion, set, block, p);
      each([&](int i, auto& column) {
        body_frame_column<S>(stage, block.owner, twists(set[i].component), rows, column);
      });
      break;
    }
    case ParameterKind::kMass:
    case ParameterKind::kInertia:
    case ParameterKind::kSize: {
      const auto wrenches = inertia_wrenches<S>(model, mechanism, motion, block.owner);
      each([&](int i, auto& column) {
        const Vector6<S> wrench =
            inertial_wrench<S>(model, mechanism, wrenches, block, set[i].component, p[i]);
        path_column<S>(stage, block.owner, wrench, rows, column);
      });
      break;
    }
    case ParameterKind::kContactPoint:
    case ParameterKind::kContactScale:
    case ParameterKind::kContactCoefficient:
      each([&](int, auto& column) { column(rows).setZero(); });
      break;
    case ParameterKind::kStiffness:
    case ParameterKind::kDamping: {
      const VectorX<S>& by =
          block.kind == ParameterKind::kStiffness ? forces.by_stiffness : forces.by_damping;
      each([&](int, auto& column) {
        for (const int l : rows) {
          column[l] = -by[l];
        }
      });
      break;
    }
    case ParameterKind::kMotorP:
    case ParameterKind::kMotorD: {
      const VectorX<S>& by = block.kind == ParameterKind::kMotorP ? forces.by_P : forces.by_D;
      each([&](int, auto& column) {
        for_each_drive(model, block.owner, [&](int k, int i) { column[k] = -by[i]; });
      });
      break;
    }
    case ParameterKind::kGravity:
      each([&](int i, auto& column) {
        for (const int l : rows) {
          column[l] = -stage.dynamics().IJ(3 + set[i].component, l);
        }
      });
      break;
  }
}

}  // namespace

template <Scalar S>
void parameter_columns(const Mechanism<S>& mechanism, const ParameterSet& set,
                       const VectorView<S>& p, const StageResidual<S>& stage,
                       const StagePoint<S>& point, Eigen::Ref<MatrixX<S>> columns) {
  const double c = point.c();
  for (const ParameterBlock& block : set.blocks()) {
    block_columns<S>(mechanism, set, p, stage, block, c, columns);
  }
  for_each_contact_change(
      stage.contacts(), mechanism, set, [&](int i, int contact, const PairWrenches<S>& change) {
        stage.contacts().add_change(stage.motion(), contact, {c * change.on_a, c * change.on_b},
                                    columns.col(i));
      });
}

template void add_parameter_gradient(const Mechanism<double>&, const ParameterSet&,
                                     const VectorView<double>&, const StageResidual<double>&,
                                     const StagePoint<double>&, const VectorView<double>&, double,
                                     Eigen::Ref<VectorX<double>>);
template void add_parameter_gradient(const Mechanism<Dual>&, const ParameterSet&,
                                     const VectorView<Dual>&, const StageResidual<Dual>&,
                                     const StagePoint<Dual>&, const VectorView<Dual>&, double,
                                     Eigen::Ref<VectorX<Dual>>);
template void parameter_columns(const Mechanism<double>&, const ParameterSet&,
                                const VectorView<double>&, const StageResidual<double>&,
                                const StagePoint<double>&, Eigen::Ref<MatrixX<double>>);

}  // namespace hbar
