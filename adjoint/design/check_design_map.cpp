#include "hbar/adjoint/design/check_design_map.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// Norms of a Jacobian's rows, in units of the scale; 1 where a row is zero.
Eigen::VectorXd row_norms(const Eigen::MatrixXd& scaled_jacobian) {
  return scaled_jacobian.rowwise().norm().unaryExpr([](double x) { return x > 0.0 ? x : 1.0; });
}

/// A direction that changes every variable, each differently.
Eigen::VectorXd uneven_direction(Eigen::Index size) {
  Eigen::VectorXd direction(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    direction[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
  }
  return direction;
}

/// A function of the variables in units of their scale, counted from d.
using OfStep = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// Order in ε of f(ε δ) − f(0) − ε J δ.
double remainder_slope(const OfStep& f, const Eigen::MatrixXd& J) {
  const Eigen::VectorXd direction = uneven_direction(J.cols());
  const Eigen::VectorXd f_0 = f(Eigen::VectorXd::Zero(J.cols()));
  const Eigen::VectorXd along = J * direction;
  const auto remainder = [&](double step) {
    return (f(step * direction) - f_0 - step * along).norm();
  };
  const double rounding = 1e-13 * (1.0 + f_0.norm());
  const double coarse = remainder(1e-2);
  const double fine = remainder(1e-3);
  if (fine <= rounding) {
    return std::numeric_limits<double>::infinity();
  }
  return std::log10(coarse / fine);
}

/// ∂f/∂(variable i) by central differences, extrapolated once.
Eigen::VectorXd column_of_differences(const OfStep& f, Eigen::Index i, Eigen::Index size) {
  const auto central = [&](double step) {
    const Eigen::VectorXd e = step * Eigen::VectorXd::Unit(size, i);
    return Eigen::VectorXd((f(e) - f(-e)) / (2.0 * step));
  };
  return (4.0 * central(5e-3) - central(1e-2)) / 3.0;
}

/// The part of check_design_map for the Hessian.
void check_map_hessian(const DesignMap& map, const Eigen::VectorXd& d, const Eigen::VectorXd& norms,
                       DesignMapCheck& out) {
  const DesignVariables& variables = map.variables();
  const Eigen::Index size = d.size();
  const Eigen::VectorXd y = uneven_direction(map.parameter_count()).cwiseQuotient(norms);
  Eigen::MatrixXd H;
  try {
    H = map.hessian(d, y);
  } catch (const InvalidInput&) {
    return;  // the map says that it has none
  }
  if (H.rows() != size || H.cols() != size) {
    throw InvalidInput(concat("check_design_map: the Hessian is ", H.rows(), " x ", H.cols(),
                              "; the map has ", size, " variables"));
  }
  out.has_hessian = true;
  const auto scale = variables.scale.asDiagonal();
  const Eigen::MatrixXd scaled = scale * H * scale;
  const OfStep weighed = [&](const Eigen::VectorXd& step) {
    return Eigen::VectorXd(scale * (map.jacobian(d + scale * step).transpose() * y));
  };
  const double norm = std::max(1.0, scaled.norm());
  for (Eigen::Index j = 0; j < size; ++j) {
    Eigen::Index worst = 0;
    const double gap = (column_of_differences(weighed, j, size) - scaled.col(j))
                           .cwiseAbs()
                           .maxCoeff<Eigen::PropagateNaN>(&worst) /
                       norm;
    if (!std::isnan(out.hessian_gap) && !(gap <= out.hessian_gap)) {  // a gap of NaN stays
      out.hessian_gap = gap;
      out.hessian_gap_name = concat(variables.names[static_cast<std::size_t>(worst)], " and ",
                                    variables.names[static_cast<std::size_t>(j)]);
    }
  }
  out.hessian_slope = remainder_slope(weighed, scaled);
}

}  // namespace

DesignMapCheck check_design_map(const DesignMap& map, const Eigen::VectorXd& d) {
  const DesignVariables& variables = map.variables();
  const Eigen::MatrixXd J = d.size() == variables.size() ? map.jacobian(d) : Eigen::MatrixXd();
  if (d.size() != variables.size() || J.cols() != d.size() || J.rows() != map.parameter_count() ||
      map.parameters(d).size() != map.parameter_count()) {
    throw InvalidInput(concat("check_design_map: d has ", d.size(), " entries and the Jacobian is ",
                              J.rows(), " x ", J.cols(), "; the map has ", variables.size(),
                              " variables and ", map.parameter_count(), " parameters"));
  }
  const Eigen::MatrixXd scaled = J * variables.scale.asDiagonal();
  const Eigen::VectorXd norms = row_norms(scaled);
  const OfStep values = [&](const Eigen::VectorXd& step) {
    return Eigen::VectorXd(
        map.parameters(d + variables.scale.cwiseProduct(step)).cwiseQuotient(norms));
  };
  DesignMapCheck out;
  for (Eigen::Index i = 0; i < d.size() && map.parameter_count() > 0; ++i) {
    Eigen::Index worst = 0;
    const double gap =
        (column_of_differences(values, i, d.size()) - scaled.col(i).cwiseQuotient(norms))
            .cwiseAbs()
            .maxCoeff<Eigen::PropagateNaN>(&worst);
    if (!std::isnan(out.gap) && !(gap <= out.gap)) {  // a gap of NaN stays
      out.gap = gap;
      out.gap_name =
          concat("parameter ", worst, " by ", variables.names[static_cast<std::size_t>(i)]);
    }
  }
  out.slope = remainder_slope(values, norms.cwiseInverse().asDiagonal() * scaled);
  check_map_hessian(map, d, norms, out);
  return out;
}

}  // namespace hbar
