#pragma once

#include "hbar/contact/contact_forces.h"
#include "hbar/core/parameters/applied.h"
#include "hbar/core/parameters/link_pullback.h"

namespace hbar {

/// Readings of a model's tactile sensors, three per point in order: the contact force of (13), (14)
/// on the point along its first and its second shear direction, and −force along their cross
/// product. Points sense every body that is the surface side of some contact of the model, except
/// their own; their forces act on nothing.
///
/// Borrows the model. Sized once, reused: nothing is allocated while no more than a thousand points
/// touch at once. Holds its workspace and belongs to one thread at a time.
template <Scalar S>
class TactileReadings {
 public:
  explicit TactileReadings(const Model& model);

  /// Finds what touches. Call it once per instant, before the functions below.
  ///
  /// @param motion  poses and twists                                             (a is not read)
  void linearize(const Mechanism<S>& mechanism, const Motion<S>& motion);

  /// @param out  a sensor's readings, force                                 [3 x its points]
  void read(int sensor, Eigen::Ref<VectorX<S>> out) const;

  /// Transposed derivative: for weights on a sensor's readings, adds covectors on bodies, and the
  /// gradient with respect to the parameters that change contact at fixed motion.
  ///
  /// @param y       weights                                                 [3 x its points]
  /// @param grad_p  gradient with respect to the set's parameters                [set.size()]
  void pull_back(int sensor, const VectorView<S>& y, const Applied<S>& applied,
                 LinkPullback<S>& links, Eigen::Ref<VectorX<S>> grad_p) const;

 private:
  /// A sensor against one body, as the contact whose law it reads.
  struct Side {
    int sensor = 0;
    Contact contact;
    PairMotion<S> motion;  // at the last linearize
  };
  /// A point of a sensor that touches.
  struct Touch {
    std::size_t side = 0;
    TouchingPoint<S> point;  // whose index is that in the sensor
  };

  Matrix3<S> world_axes(const Side& side, int point) const;
  void add_parameters(const Side& side, const TouchingPoint<S>& point, const Vector3<S>& weight,
                      const Applied<S>& applied, Eigen::Ref<VectorX<S>>& grad_p) const;

  const Model& model_;
  std::vector<Side> sides_;
  std::vector<Touch> touches_;
};

}  // namespace hbar
