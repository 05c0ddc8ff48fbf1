#pragma once

#include "hbar/solvers/nlp/primal_dual_point.h"

namespace Ipopt {
class TNLP;
class IpoptData;
class IpoptCalculatedQuantities;
}  // namespace Ipopt

namespace hbar::solvers {

/// The iterate that Ipopt stands at, inside TNLP::intermediate_callback: variables and multipliers
/// as TNLP::finalize_solution would get them. Ipopt has a function for it since 3.14; before, this
/// does what Ipopt does when it ends.
///
/// @param program    the program being solved
/// @param data       as passed to the callback
/// @param computed   as passed to the callback
/// @param iterate    with the program's sizes; set by this, all but mu
/// @returns whether there was one: during the restoration of feasibility there is not
[[nodiscard]] bool read_ipopt_iterate(const Ipopt::TNLP& program, const Ipopt::IpoptData* data,
                                      Ipopt::IpoptCalculatedQuantities* computed,
                                      PrimalDualPoint& iterate);

}  // namespace hbar::solvers
