#pragma once

#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// A mechanism, the set whose values it has, and these values: what every derivative by parameters
/// reads. Borrows all three.
template <Scalar S>
struct Applied {
  const Mechanism<S>& mechanism;
  const ParameterSet& set;
  VectorView<S> p;  ///< applied to the mechanism                                  [set.size()]
};

}  // namespace hbar
