#pragma once

#include <string>
#include <vector>

#include "hbar/adjoint/design/design_map.h"
#include "hbar/core/parameters/parameters.h"

namespace hbar::example {

/// A capsule that reaches from its own joint to the next one.
struct Segment {
  std::string body;
  std::string next_joint;  ///< empty: none
};

/// A length that a designer may change; its segments stay equally long.
struct FreeLength {
  std::string name;
  std::vector<Segment> segments;
  double scale = 0.0;  ///< typical change; 0: see DesignVariable
};

/// The parameters that lengths determine: a length l stretches its capsules (and with them the
/// contact points, the masses and the moments), moves the bodies by half and the next joints by all
/// of the change.
[[nodiscard]] std::vector<std::string> stretched_parameters(const Model& model,
                                                            const std::vector<FreeLength>& lengths);

/// Maps lengths to the parameters of a set that contains at least stretched_parameters. Affine.
///
/// @param base   p at the scene's lengths                                       [parameters]
/// @param share  how much shorter or longer than the scene's a length may get, 0 … 1
/// @param start  where an optimisation begins, and if share is 0, stays; empty: the scene's
///               lengths                                                        [lengths]
/// @throws InvalidInput if a body is not a capsule, or the segments of a length differ
[[nodiscard]] DesignMapPointer stretch_map(const Model& model, const ParameterSet& set,
                                           const Eigen::VectorXd& base,
                                           const std::vector<FreeLength>& lengths, double share,
                                           const Eigen::VectorXd& start = {});

}  // namespace hbar::example
