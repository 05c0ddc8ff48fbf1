#pragma once

#include <vector>

#include "hbar/core/base/spatial_inertia.h"
#include "hbar/core/model/model.h"

namespace hbar {

/// The numbers of a model with parameters applied, as the recursions read them.
///
/// nominal_mechanism gives the model's own; apply_parameters (parameters.h) sets those of a
/// parameter set.
template <Scalar S>
struct Mechanism {
  std::vector<RigidTransform<S>> X_PJ;          ///< per link: joint frame at rest in the parent's
  std::vector<RigidTransform<S>> X_JB;          ///< per link: body frame in the joint frame
  VectorX<S> mass;                              ///< per link                             [links]
  Eigen::Matrix<S, 3, Eigen::Dynamic> moments;  ///< per link, principal moments      [3 x links]
  VectorX<S> stiffness;                         ///< per link                             [links]
  VectorX<S> damping;                           ///< per link                             [links]
  VectorX<S> motor_P;                           ///< per motor                            [motors]
  VectorX<S> motor_D;                           ///< per motor                            [motors]
  Eigen::Matrix<S, 3, Eigen::Dynamic> sizes;    ///< per link: sizes_of its shape     [3 x links]
  VectorX<S> contact_scale;                     ///< s per link                           [links]
  Eigen::Matrix<S, 4, Eigen::Dynamic> contact_coefficients;  ///< k_n, k_t, μ, k_d [4 x contacts]
  std::vector<Eigen::Matrix<S, 3, Eigen::Dynamic>> contact_points;  ///< per link [3 x points]
  Eigen::VectorXd contact_radius;  ///< per link: bound on |contact point|            [links]
  std::vector<Eigen::Matrix4Xd> contact_clusters;  ///< per link: balls around them [4 x clusters]
  Vector3<S> gravity;                              ///< in the world frame, length/time²     [3]
  std::vector<SpatialInertia<S>> inertia;          ///< per link: of the body, from the joint frame

  /// Recomputes inertia and the bounds on contact points after a change of the numbers they depend
  /// on.
  void update_derived(const Model& model);
};

/// The mechanism with the model's own parameters.
template <Scalar S>
[[nodiscard]] Mechanism<S> nominal_mechanism(const Model& model);

}  // namespace hbar
