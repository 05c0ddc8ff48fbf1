#pragma once

#include <iosfwd>

#include "hbar/solvers/nlp/ipopt.h"

namespace Ipopt {
class IpoptApplication;
}  // namespace Ipopt

namespace hbar::solvers {

/// Hands options to Ipopt, each checked first, so that Ipopt has nothing to print.
///
/// @throws InvalidInput if an option is unknown (naming the nearest one), of another type, out of
///   its range, or one that IpoptOptions decides
void set_ipopt_options(Ipopt::IpoptApplication& application, const IpoptOptions& options);

/// What solve_with_ipopt does, with Ipopt's warnings and summaries written to a stream.
///
/// @param journal  may be null
[[nodiscard]] IpoptResult run_ipopt(Nlp& nlp, const IpoptOptions& options, std::ostream* journal);

}  // namespace hbar::solvers
