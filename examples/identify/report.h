#pragma once

#include <string>
#include <vector>

#include "estimate.h"

namespace hbar::identify {

/// A line per unknown: the truth (if it is known), start, estimate, standard deviation, interval
/// and whether it covers the truth; then the correlations and χ². If the data leave a direction
/// undetermined, says so in words instead.
///
/// @param truth  of the unknowns; empty: not known                                        [d]
[[nodiscard]] std::string estimate_table(const study::Information& known,
                                         const DesignVariables& unknowns,
                                         const Eigen::VectorXd& truth);

/// A line per way of fitting; differences from the first in units of the standard deviations.
///
/// @param deviations  standard deviations of the unknowns                                 [d]
[[nodiscard]] std::string ways_table(const std::vector<Way>& ways,
                                     const Eigen::VectorXd& deviations);

/// A line per unknown: bias, scatter, predicted standard deviation, coverage.
[[nodiscard]] std::string coverage_table(const Coverage& coverage,
                                         const std::vector<std::string>& names);

}  // namespace hbar::identify
