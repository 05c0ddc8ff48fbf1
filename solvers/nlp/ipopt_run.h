#pragma once

#include <iosfwd>

#include "hbar/solvers/nlp/ipopt.h"

namespace Ipopt {
class IpoptApplication;
}  // namespace Ipopt

namespace hbar::solvers {

/// Passes options to Ipopt after checking each, so that Ipopt has nothing to print.
///
/// @throws InvalidInput if an option is unknown (naming the nearest one), of another type, out of
///   its range, or reserved for IpoptOptions
void set_ipopt_options(Ipopt::IpoptApplication& application, const IpoptOptions& options);

/// How an optimisation ended, by what Ipopt returned.
///
/// @param returned  an Ipopt::ApplicationReturnStatus
[[nodiscard]] IpoptStatus status_of(int returned);

/// Like solve_with_ipopt, with Ipopt's warnings and summaries written to a stream.
///
/// @param journal  may be null
[[nodiscard]] IpoptResult run_ipopt(Nlp& nlp, const IpoptOptions& options, std::ostream* journal);

}  // namespace hbar::solvers
