#include "hbar/adjoint/design_map.h"

#include <algorithm>
#include <cmath>

#include "hbar/core/error.h"

namespace hbar {
namespace {

DesignVariables identity_variables(const ParameterSet& set) {
  DesignVariables out;
  for (const Parameter& parameter : set.parameters()) {
    out.names.push_back(parameter.name);
    out.units.push_back(parameter.unit);
  }
  out.start = set.nominal();
  out.lower = set.lower();
  out.upper = set.upper();
  out.scale = out.start.unaryExpr([](double x) { return x != 0.0 ? std::abs(x) : 1.0; });
  return out;
}

/// I = kMoments s.
Eigen::Matrix3d moments_of_second_moments() {
  return Eigen::Matrix3d::Ones() - Eigen::Matrix3d::Identity();
}

/// Norms of a Jacobian's rows, in units of the scale; 1 where a row is zero.
Eigen::VectorXd row_norms(const Eigen::MatrixXd& scaled_jacobian) {
  return scaled_jacobian.rowwise().norm().unaryExpr([](double x) { return x > 0.0 ? x : 1.0; });
}

double taylor_slope(const DesignMap& map, const Eigen::VectorXd& d, const Eigen::MatrixXd& scaled,
                    const Eigen::VectorXd& norms) {
  const Eigen::VectorXd p = map.parameters(d);
  Eigen::VectorXd direction(d.size());
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    direction[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
  }
  const Eigen::VectorXd along = scaled * direction;
  const auto remainder = [&](double step) {
    const Eigen::VectorXd moved =
        map.parameters(d + step * map.variables().scale.cwiseProduct(direction));
    return (moved - p - step * along).cwiseQuotient(norms).norm();
  };
  const double rounding = 1e-13 * (1.0 + p.cwiseQuotient(norms).norm());
  const double coarse = remainder(1e-2);
  const double fine = remainder(1e-3);
  if (fine <= rounding) {
    return std::numeric_limits<double>::infinity();
  }
  return std::log10(coarse / fine);
}

}  // namespace

Eigen::MatrixXd DesignMap::hessian(const Eigen::VectorXd&, const Eigen::VectorXd&) const {
  throw InvalidInput(
      "design map: it has no second derivatives; implement hessian(), or use the limited-memory "
      "Hessian");
}

IdentityDesignMap::IdentityDesignMap(const ParameterSet& set)
    : variables_(identity_variables(set)) {}

Eigen::MatrixXd IdentityDesignMap::jacobian(const Eigen::VectorXd& d) const {
  return Eigen::MatrixXd::Identity(d.size(), d.size());
}

InertiaChart::InertiaChart(const ParameterSet& set, double least_share)
    : variables_(identity_variables(set)) {
  if (!(least_share > 0.0) || !(least_share < 0.5)) {
    throw InvalidInput(
        concat("InertiaChart: least_share is ", least_share, "; it must be in (0, 0.5)"));
  }
  for (const ParameterBlock& block : set.blocks()) {
    if (block.kind != ParameterKind::kInertia) {
      continue;
    }
    if (block.size != 3) {
      throw InvalidInput(concat("InertiaChart: '", set[block.first].name,
                                "' is in the set without the body's other moments; name all three "
                                "or none"));
    }
    first_moments_.push_back(block.first);
    const Eigen::Vector3d I = variables_.start.segment<3>(block.first);
    const double least = least_share * I.maxCoeff();
    for (int k = 0; k < 3; ++k) {
      std::string& name = variables_.names[static_cast<std::size_t>(block.first + k)];
      name.replace(name.rfind("inertia"), 7, "second_moment");
    }
    variables_.start.segment<3>(block.first) = (0.5 * I.sum() - I.array()).cwiseMax(least).matrix();
    variables_.lower.segment<3>(block.first).setConstant(least);
    variables_.scale.segment<3>(block.first).setConstant(0.5 * I.maxCoeff());
  }
}

Eigen::VectorXd InertiaChart::parameters(const Eigen::VectorXd& d) const {
  Eigen::VectorXd p = d;
  for (const Eigen::Index first : first_moments_) {
    p.segment<3>(first) = moments_of_second_moments() * d.segment<3>(first);
  }
  return p;
}

Eigen::MatrixXd InertiaChart::jacobian(const Eigen::VectorXd& d) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Identity(d.size(), d.size());
  for (const Eigen::Index first : first_moments_) {
    J.block<3, 3>(first, first) = moments_of_second_moments();
  }
  return J;
}

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
  DesignMapCheck out;
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    const auto difference = [&](double step) {
      Eigen::VectorXd a = d;
      Eigen::VectorXd b = d;
      a[i] += step * variables.scale[i];
      b[i] -= step * variables.scale[i];
      return Eigen::VectorXd((map.parameters(a) - map.parameters(b)) / (2.0 * step));
    };
    const Eigen::VectorXd expected = (4.0 * difference(5e-3) - difference(1e-2)) / 3.0;
    Eigen::Index worst = 0;
    const double gap =
        map.parameter_count() > 0
            ? (expected - scaled.col(i)).cwiseQuotient(norms).cwiseAbs().maxCoeff(&worst)
            : 0.0;
    if (gap > out.gap) {
      out.gap = gap;
      out.gap_name =
          concat("parameter ", worst, " by ", variables.names[static_cast<std::size_t>(i)]);
    }
  }
  out.slope = taylor_slope(map, d, scaled, norms);
  return out;
}

}  // namespace hbar
