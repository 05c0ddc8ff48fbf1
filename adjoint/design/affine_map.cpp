#include "hbar/adjoint/design/affine_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

class AffineMap final : public DesignMap {
 public:
  AffineMap(DesignVariables variables, Eigen::VectorXd base, Eigen::MatrixXd slopes,
            std::vector<std::string> parameter_names)
      : variables_(std::move(variables)),
        base_(std::move(base)),
        slopes_(std::move(slopes)),
        parameter_names_(std::move(parameter_names)) {}

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Eigen::Index parameter_count() const override { return base_.size(); }
  [[nodiscard]] std::vector<std::string> parameter_names() const override {
    return parameter_names_;
  }
  [[nodiscard]] bool depends(Eigen::Index parameter, Eigen::Index variable) const override {
    return slopes_(parameter, variable) != 0.0;
  }
  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override {
    return base_ + slopes_ * d;
  }
  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd&) const override { return slopes_; }
  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd&) const override {
    return Eigen::MatrixXd::Zero(d.size(), d.size());
  }

 private:
  DesignVariables variables_;
  Eigen::VectorXd base_;
  Eigen::MatrixXd slopes_;
  std::vector<std::string> parameter_names_;
};

std::vector<std::string> names_of(const ParameterSet& set) {
  std::vector<std::string> out;
  for (const Parameter& parameter : set.parameters()) {
    out.push_back(parameter.name);
  }
  return out;
}

DesignVariables identity_variables(const ParameterSet& set) {
  DesignVariables out;
  out.names = names_of(set);
  for (const Parameter& parameter : set.parameters()) {
    out.units.push_back(parameter.unit);
  }
  out.start = set.nominal();
  out.lower = set.lower();
  out.upper = set.upper();
  out.scale = out.start.unaryExpr([](double x) { return x != 0.0 ? std::abs(x) : 1.0; });
  return out;
}

/// p = slopes d.
DesignMapPointer linear_map(const ParameterSet& set, DesignVariables variables,
                            Eigen::MatrixXd slopes) {
  return std::make_shared<AffineMap>(std::move(variables), Eigen::VectorXd::Zero(set.size()),
                                     std::move(slopes), names_of(set));
}

}  // namespace

DesignMapPointer affine_map(DesignVariables variables, Eigen::VectorXd base,
                            Eigen::MatrixXd slopes) {
  if (slopes.rows() != base.size() || slopes.cols() != variables.size()) {
    throw InvalidInput(concat("affine_map: slopes are ", slopes.rows(), " x ", slopes.cols(),
                              "; they must be ", base.size(), " x ", variables.size()));
  }
  if (!base.allFinite() || !slopes.allFinite()) {
    throw InvalidInput("affine_map: base and slopes must be finite");
  }
  return std::make_shared<AffineMap>(std::move(variables), std::move(base), std::move(slopes),
                                     std::vector<std::string>());
}

DesignMapPointer parameter_map(const ParameterSet& set,
                               const std::vector<ParameterBounds>& bounds) {
  DesignVariables variables = identity_variables(set);
  for (const ParameterBounds& own : bounds) {
    const int i = set.find(own.name);
    if (std::isfinite(own.lower) && own.lower < 0.0 && variables.lower[i] >= 0.0) {
      throw InvalidInput(concat("parameter_map: the lower bound of ", own.name, " is ", own.lower,
                                "; it must be ≥ 0"));
    }
    variables.lower[i] = std::max(variables.lower[i], own.lower);
    variables.upper[i] = std::min(variables.upper[i], own.upper);
    const double start = variables.start[i];
    if (!(variables.lower[i] <= start) || !(start <= variables.upper[i])) {
      throw InvalidInput(concat("parameter_map: ", own.name, " is ", start,
                                ", which is not within its bounds, ", variables.lower[i], " to ",
                                variables.upper[i]));
    }
    const double room = variables.upper[i] - variables.lower[i];
    if (room > 0.0 && std::isfinite(room)) {
      variables.scale[i] = 0.25 * room;
    }
  }
  return linear_map(set, std::move(variables), Eigen::MatrixXd::Identity(set.size(), set.size()));
}

DesignMapPointer inertia_chart(const ParameterSet& set, double least_share) {
  if (!(least_share > 0.0) || !(least_share < 0.5)) {
    throw InvalidInput(
        concat("inertia_chart: least_share is ", least_share, "; it must be in (0, 0.5)"));
  }
  DesignVariables variables = identity_variables(set);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Identity(set.size(), set.size());
  for (const ParameterBlock& block : set.blocks()) {
    if (block.kind != ParameterKind::kInertia) {
      continue;
    }
    if (block.size != 3) {
      throw InvalidInput(concat("inertia_chart: '", set[block.first].name,
                                "' is in the set without the body's other moments; name all three "
                                "or none"));
    }
    const Eigen::Vector3d I = variables.start.segment<3>(block.first);
    const double least = least_share * I.maxCoeff();
    for (int k = 0; k < 3; ++k) {
      std::string& name = variables.names[static_cast<std::size_t>(block.first + k)];
      name.replace(name.rfind("inertia"), 7, "second_moment");
    }
    variables.start.segment<3>(block.first) = (0.5 * I.sum() - I.array()).cwiseMax(least).matrix();
    variables.lower.segment<3>(block.first).setConstant(least);
    variables.scale.segment<3>(block.first).setConstant(0.5 * I.maxCoeff());
    slopes.block<3, 3>(block.first, block.first) =
        Eigen::Matrix3d::Ones() - Eigen::Matrix3d::Identity();
  }
  return linear_map(set, std::move(variables), std::move(slopes));
}

}  // namespace hbar
