#include "hbar/solvers/nlp/ipopt_iterate.h"

#include <IpIpoptCalculatedQuantities.hpp>
#include <IpIpoptData.hpp>
#include <IpOrigIpoptNLP.hpp>
#include <IpTNLP.hpp>
#include <IpTNLPAdapter.hpp>

#if defined(IPOPT_VERSION_MINOR) && \
    (IPOPT_VERSION_MAJOR > 3 || (IPOPT_VERSION_MAJOR == 3 && IPOPT_VERSION_MINOR >= 14))
#define HBAR_IPOPT_TELLS_ITERATES
#endif

namespace hbar::solvers {

#ifdef HBAR_IPOPT_TELLS_ITERATES

bool read_ipopt_iterate(const Ipopt::TNLP& program, const Ipopt::IpoptData* data,
                        Ipopt::IpoptCalculatedQuantities* computed, PrimalDualPoint& iterate) {
  const auto n = static_cast<Ipopt::Index>(iterate.x.size());
  const auto m = static_cast<Ipopt::Index>(iterate.constraint_multipliers.size());
  return program.get_curr_iterate(
      data, computed, false, n, iterate.x.data(), iterate.lower_multipliers.data(),
      iterate.upper_multipliers.data(), m, nullptr, iterate.constraint_multipliers.data());
}

#else

namespace {

using Ipopt::SmartPtr;
using Ipopt::Vector;

/// A copy of multipliers in the units of the program.
template <typename Unscale>
SmartPtr<Vector> unscaled(const SmartPtr<const Vector>& multipliers, double objective,
                          const Unscale& unscale) {
  SmartPtr<Vector> out = unscale(multipliers);
  out->Scal(objective);
  return out;
}

}  // namespace

bool read_ipopt_iterate(const Ipopt::TNLP& /*program*/, const Ipopt::IpoptData* data,
                        Ipopt::IpoptCalculatedQuantities* computed, PrimalDualPoint& iterate) {
  if (data == nullptr || computed == nullptr || !IsValid(data->curr())) {
    return false;
  }
  auto* nlp = dynamic_cast<Ipopt::OrigIpoptNLP*>(GetRawPtr(computed->GetIpoptNLP()));
  auto* adapter =
      nlp == nullptr ? nullptr : dynamic_cast<Ipopt::TNLPAdapter*>(GetRawPtr(nlp->nlp()));
  if (adapter == nullptr) {
    return false;
  }
  const Ipopt::IteratesVector& current = *data->curr();
  const SmartPtr<Ipopt::NLPScalingObject> scaling = nlp->NLP_scaling();
  const double objective = scaling->unapply_obj_scaling(1.0);
  const SmartPtr<const Ipopt::VectorSpace> space = current.x()->OwnerSpace();
  const auto of_bounds = [&](const SmartPtr<const Ipopt::Matrix>& bounded) {
    return [&scaling, &space, bounded](const SmartPtr<const Vector>& z) {
      return scaling->apply_vector_scaling_x_LU_NonConst(*bounded, z, *space);
    };
  };
  const auto y_c = unscaled(current.y_c(), objective, [&](const SmartPtr<const Vector>& y) {
    return scaling->apply_vector_scaling_c_NonConst(y);
  });
  const auto y_d = unscaled(current.y_d(), objective, [&](const SmartPtr<const Vector>& y) {
    return scaling->apply_vector_scaling_d_NonConst(y);
  });
  const auto z_L = unscaled(current.z_L(), objective, of_bounds(nlp->Px_L()));
  const auto z_U = unscaled(current.z_U(), objective, of_bounds(nlp->Px_U()));
  adapter->ResortX(*scaling->unapply_vector_scaling_x(current.x()), iterate.x.data());
  adapter->ResortG(*y_c, *y_d, iterate.constraint_multipliers.data());
  // Entries without a bound are not written.
  iterate.lower_multipliers.setZero();
  iterate.upper_multipliers.setZero();
  adapter->ResortBnds(*z_L, iterate.lower_multipliers.data(), *z_U,
                      iterate.upper_multipliers.data());
  return true;
}

#endif

}  // namespace hbar::solvers
