#pragma once

#include "hbar/core/parameters/parameters.h"

namespace hbar {

/// A mechanism, the parameter set applied to it, and the values applied: what every derivative with
/// respect to parameters needs. Borrows all three.
template <Scalar S>
struct Applied {
  const Mechanism<S>& mechanism;
  const ParameterSet& set;
  VectorView<S> p;  ///< applied to the mechanism                                  [set.size()]
};

}  // namespace hbar
