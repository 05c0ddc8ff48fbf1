#pragma once

#include "hbar/contact/contact_forces.h"
#include "hbar/core/parameters/link_pullback.h"

namespace hbar {

/// Readings of a model's tactile sensors, three per point in order: the contact force of (13), (14)
/// on the point along its first and its second shear direction, and −force along their cross
/// product. Points feel every body that some contact of the model has as its distance side, but
/// their own; their forces act on nothing.
///
/// Sized once, reused; readings allocate nothing.
template <Scalar S>
class TactileReadings {
 public:
  explicit TactileReadings(const Model& model);

  /// @param motion  poses and twists                                             (a is not read)
  /// @param out     readings, force                                                   [tactile]
  void readings(const Mechanism<S>& mechanism, const Motion<S>& motion,
                Eigen::Ref<VectorX<S>> out) const;

  /// Transposed derivative: weights y on the readings are added as gradients.
  ///
  /// @param y                weights                                                  [tactile]
  /// @param by_q, by_qdot    gradients by coordinates and rates                       [dof]
  /// @param p, grad_p        values of, and gradient by, the set's parameters         [set.size()]
  void pull_back(const Mechanism<S>& mechanism, const ParameterSet& set, const VectorView<S>& p,
                 const Motion<S>& motion, const VectorView<S>& y, Eigen::Ref<VectorX<S>> by_q,
                 Eigen::Ref<VectorX<S>> by_qdot, Eigen::Ref<VectorX<S>> grad_p);

 private:
  /// A sensor against one body, as the contact whose law it reads.
  struct Side {
    int sensor = 0;
    int first = 0;  // of the sensor's readings
    Contact contact;
  };

  template <typename Visit>
  void for_each_touch(const Mechanism<S>& mechanism, const Motion<S>& motion,
                      const Visit& visit) const;
  Matrix3<S> world_axes(const PairMotion<S>& pair, int sensor, int point) const;
  void add_point(const Side& side, const PairMotion<S>& pair, const TouchingPoint<S>& point,
                 const Vector3<S>& weight);

  const Model& model_;
  std::vector<Side> sides_;
  LinkPullback<S> links_;
};

}  // namespace hbar
