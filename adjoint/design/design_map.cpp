#include "hbar/adjoint/design/design_map.h"

#include <algorithm>
#include <cmath>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

void check(const DesignVariable& v, const std::vector<std::string>& taken) {
  const auto refuse = [&](const auto&... what) {
    throw InvalidInput(concat("design variable '", v.name, "': ", what...));
  };
  if (v.name.empty()) {
    throw InvalidInput(concat("design variable ", taken.size(), " has no name"));
  }
  if (std::find(taken.begin(), taken.end(), v.name) != taken.end()) {
    refuse("another one has its name");
  }
  if (!std::isfinite(v.start) || !(v.lower <= v.start) || !(v.start <= v.upper)) {
    refuse("start is ", v.start, "; it must be within its bounds, ", v.lower, " to ", v.upper);
  }
  if (!(v.scale >= 0.0) || !std::isfinite(v.scale)) {
    refuse("scale is ", v.scale, "; it must be positive, or 0 to be chosen");
  }
}

double scale_of(const DesignVariable& v) {
  if (v.scale > 0.0) {
    return v.scale;
  }
  const double room = v.upper - v.lower;
  if (room > 0.0 && std::isfinite(room)) {
    return 0.25 * room;
  }
  return v.start != 0.0 ? std::abs(v.start) : 1.0;
}

}  // namespace

DesignVariables design_variables(const std::vector<DesignVariable>& variables) {
  const auto count = static_cast<Eigen::Index>(variables.size());
  DesignVariables out{{},
                      {},
                      Eigen::VectorXd(count),
                      Eigen::VectorXd(count),
                      Eigen::VectorXd(count),
                      Eigen::VectorXd(count)};
  for (const DesignVariable& v : variables) {
    check(v, out.names);
    const auto i = static_cast<Eigen::Index>(out.names.size());
    out.names.push_back(v.name);
    out.units.push_back(v.unit);
    out.start[i] = v.start;
    out.lower[i] = v.lower;
    out.upper[i] = v.upper;
    out.scale[i] = scale_of(v);
  }
  return out;
}

Eigen::MatrixXd DesignMap::hessian(const Eigen::VectorXd&, const Eigen::VectorXd&) const {
  throw InvalidInput(
      "design map: it has no second derivatives; implement hessian(), or use the limited-memory "
      "Hessian");
}

}  // namespace hbar
