#include "hbar/adjoint/design/composed_map.h"

#include <utility>

#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class ComposedMap final : public DesignMap {
 public:
  ComposedMap(DesignMapPointer outer, DesignMapPointer inner)
      : outer_(std::move(outer)), inner_(std::move(inner)) {}

  [[nodiscard]] const DesignVariables& variables() const override { return inner_->variables(); }
  [[nodiscard]] Eigen::Index parameter_count() const override { return outer_->parameter_count(); }
  [[nodiscard]] std::vector<std::string> parameter_names() const override {
    return outer_->parameter_names();
  }
  [[nodiscard]] bool depends(Eigen::Index parameter, Eigen::Index variable) const override {
    for (Eigen::Index k = 0; k < inner_->parameter_count(); ++k) {
      if (outer_->depends(parameter, k) && inner_->depends(k, variable)) {
        return true;
      }
    }
    return false;
  }
  [[nodiscard]] VectorXd parameters(const VectorXd& d) const override {
    return outer_->parameters(inner_->parameters(d));
  }
  [[nodiscard]] MatrixXd jacobian(const VectorXd& d) const override {
    return outer_->jacobian(inner_->parameters(d)) * inner_->jacobian(d);
  }
  [[nodiscard]] MatrixXd hessian(const VectorXd& d, const VectorXd& y) const override {
    const VectorXd between = inner_->parameters(d);
    const MatrixXd J = inner_->jacobian(d);
    return J.transpose() * outer_->hessian(between, y) * J +
           inner_->hessian(d, outer_->jacobian(between).transpose() * y);
  }

 private:
  DesignMapPointer outer_;
  DesignMapPointer inner_;
};

}  // namespace

DesignMapPointer compose(DesignMapPointer outer, DesignMapPointer inner) {
  if (outer == nullptr || inner == nullptr) {
    throw InvalidInput("compose: a map is null");
  }
  if (outer->variables().size() != inner->parameter_count()) {
    throw InvalidInput(concat("compose: the outer map has ", outer->variables().size(),
                              " variables; the inner one gives ", inner->parameter_count()));
  }
  return std::make_shared<ComposedMap>(std::move(outer), std::move(inner));
}

}  // namespace hbar
