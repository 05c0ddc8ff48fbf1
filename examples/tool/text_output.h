#pragma once

#include <string>

#include "results.h"

namespace hbar::tool {

/// The contents of a model: links, coordinates, motors, variables, contacts, sensors, and all
/// parameters, those of `selected` marked with a star.
[[nodiscard]] std::string describe(const Model& model, const ParameterSet& selected);

/// A readable report of a run: how it went, where it ended, what touched, the objective and its
/// gradient.
[[nodiscard]] std::string summarize(const LoadedProblem& loaded, const Results& results);

}  // namespace hbar::tool
