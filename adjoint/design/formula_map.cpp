#include "hbar/adjoint/design/formula_map.h"

#include <cmath>
#include <limits>

#include "hbar/core/base/error.h"
#include "hbar/core/base/nearest_name.h"

namespace hbar {
namespace {

using Eigen::Index;

class FormulaMap final : public DesignMap {
 public:
  FormulaMap(DesignVariables variables, detail::MapFormula formula,
             std::vector<std::string> parameter_names)
      : variables_(std::move(variables)),
        formula_(std::move(formula)),
        parameter_names_(std::move(parameter_names)) {
    count_ = parameters(variables_.start).size();
    find_dependence();
  }

  [[nodiscard]] const DesignVariables& variables() const override { return variables_; }
  [[nodiscard]] Index parameter_count() const override { return count_; }
  [[nodiscard]] std::vector<std::string> parameter_names() const override {
    return parameter_names_;
  }
  [[nodiscard]] bool depends(Index parameter, Index variable) const override {
    return depends_(parameter, variable);
  }

  [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override {
    const std::vector<HyperDual> p = evaluate(d, -1, -1);
    Eigen::VectorXd out(static_cast<Index>(p.size()));
    for (Index k = 0; k < out.size(); ++k) {
      out[k] = p[static_cast<std::size_t>(k)].value;
    }
    return out;
  }

  [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const override {
    Eigen::MatrixXd J = differentiate(d);
    for (Index i = 0; i < J.cols(); ++i) {
      for (Index k = 0; k < J.rows(); ++k) {
        if (J(k, i) != 0.0 && !depends_(k, i)) {
          throw InvalidInput(concat("formula_map: parameter ", k, " depends on '",
                                    variables_.names[static_cast<std::size_t>(i)],
                                    "' here, but not at the start; avoid the branch"));
        }
      }
    }
    return J;
  }

  [[nodiscard]] Eigen::MatrixXd hessian(const Eigen::VectorXd& d,
                                        const Eigen::VectorXd& y) const override {
    Eigen::MatrixXd H(d.size(), d.size());
    for (Index j = 0; j < d.size(); ++j) {
      for (Index i = 0; i <= j; ++i) {
        const std::vector<HyperDual> p = evaluate(d, i, j);
        double sum = 0.0;
        for (Index k = 0; k < count_; ++k) {
          sum += y[k] * p[static_cast<std::size_t>(k)].cross;
        }
        H(i, j) = H(j, i) = sum;
      }
    }
    return H;
  }

 private:
  /// p with slopes along variables i and j; −1: none.
  [[nodiscard]] std::vector<HyperDual> evaluate(const Eigen::VectorXd& d, Index i, Index j) const {
    if (d.size() != variables_.size()) {
      throw InvalidInput(concat("formula_map: d has ", d.size(), " entries; the map has ",
                                variables_.size(), " variables"));
    }
    std::vector<HyperDual> at(d.begin(), d.end());
    if (i >= 0) {
      at[static_cast<std::size_t>(i)].slope_1 = 1.0;
    }
    if (j >= 0) {
      at[static_cast<std::size_t>(j)].slope_2 = 1.0;
    }
    std::vector<HyperDual> p;
    formula_(at, p);
    if (count_ >= 0 && static_cast<Index>(p.size()) != count_) {
      throw InvalidInput(concat("formula_map: the formula gives ", p.size(),
                                " parameters here; at the start it gave ", count_));
    }
    return p;
  }

  [[nodiscard]] Eigen::MatrixXd differentiate(const Eigen::VectorXd& d) const {
    Eigen::MatrixXd J(count_, d.size());
    for (Index i = 0; i < d.size(); i += 2) {  // two slopes at a time
      const bool pair = i + 1 < d.size();
      const std::vector<HyperDual> p = evaluate(d, i, pair ? i + 1 : -1);
      for (Index k = 0; k < count_; ++k) {
        J(k, i) = p[static_cast<std::size_t>(k)].slope_1;
        if (pair) {
          J(k, i + 1) = p[static_cast<std::size_t>(k)].slope_2;
        }
      }
    }
    return J;
  }

  /// A variable set to NaN makes everything that depends on it NaN.
  void find_dependence() {
    const Eigen::VectorXd& start = variables_.start;
    const Eigen::MatrixXd J = differentiate(start);
    if (!parameters(start).allFinite() || !J.allFinite()) {
      throw InvalidInput("formula_map: the formula or its derivative is not finite at the start");
    }
    depends_.setConstant(count_, start.size(), false);
    for (Index i = 0; i < start.size(); ++i) {
      Eigen::VectorXd marked = start;
      marked[i] = std::numeric_limits<double>::quiet_NaN();
      const Eigen::VectorXd p = parameters(marked);
      for (Index k = 0; k < count_; ++k) {
        depends_(k, i) = std::isnan(p[k]) || J(k, i) != 0.0;
      }
    }
  }

  DesignVariables variables_;
  detail::MapFormula formula_;
  std::vector<std::string> parameter_names_;
  Index count_ = -1;  // of parameters; −1: not known yet
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> depends_;
};

}  // namespace

NamedParameters::NamedParameters(const ParameterSet& set) {
  for (int i = 0; i < set.size(); ++i) {
    places_.emplace(set[i].name, i);
    values_.emplace_back(set[i].nominal);
    names_.push_back(set[i].name);
  }
}

HyperDual& NamedParameters::operator[](std::string_view name) {
  const auto found = places_.find(name);
  if (found == places_.end()) {
    std::vector<std::string> known;
    for (const auto& [other, place] : places_) {
      known.push_back(other);
    }
    throw InvalidInput(concat("formula_map: parameter '", name, "' is not in the set; ",
                              unknown_name_hint(name, known)));
  }
  return values_[static_cast<std::size_t>(found->second)];
}

DesignMapPointer detail::make_formula_map(DesignVariables variables, MapFormula formula,
                                          std::vector<std::string> parameter_names) {
  return std::make_shared<FormulaMap>(std::move(variables), std::move(formula),
                                      std::move(parameter_names));
}

}  // namespace hbar
