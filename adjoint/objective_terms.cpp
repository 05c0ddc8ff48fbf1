#include "hbar/adjoint/objective_terms.h"

#include <utility>

#include "hbar/core/error.h"

namespace hbar {
namespace {

using Value = std::function<double(const TrajectoryValues&)>;
using AddPartials = std::function<void(const TrajectoryValues&, TrajectoryPartials&)>;

class FunctionObjective final : public ObjectiveTerm {
 public:
  FunctionObjective(std::string name, Value value, AddPartials add)
      : name_(std::move(name)), value_(std::move(value)), add_(std::move(add)) {}

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    return value_(values);
  }
  void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const override {
    add_(values, partials);
  }

 private:
  std::string name_;
  Value value_;
  AddPartials add_;
};

void require_weight(std::string_view term, double weight) {
  if (!(weight >= 0.0) || !std::isfinite(weight)) {
    throw InvalidInput(concat(term, ": weight is ", weight, "; it must be ≥ 0"));
  }
}

/// Matrix of `values` minus targets over steps 1 … N; checks the target's shape.
Eigen::MatrixXd gap(std::string_view term, const Eigen::MatrixXd& values,
                    const Eigen::MatrixXd& target) {
  const Eigen::Index steps = values.cols() - 1;
  if (target.rows() != values.rows() || (target.cols() != steps && target.cols() != 1)) {
    throw InvalidInput(concat(term, ": target is ", target.rows(), " x ", target.cols(),
                              "; it must be ", values.rows(), " x ", steps, " or ", values.rows(),
                              " x 1"));
  }
  if (target.cols() == steps) {
    return values.rightCols(steps) - target;
  }
  return values.rightCols(steps).colwise() - target.col(0);
}

/// ½ weight Σ ‖field_k − target_k‖² over steps 1 … N of one member of the values.
TermPointer squared_gap(std::string name, Eigen::MatrixXd TrajectoryValues::*field,
                        Eigen::MatrixXd TrajectoryPartials::*partial, Eigen::MatrixXd target,
                        double weight) {
  require_weight(name, weight);
  auto value = [=](const TrajectoryValues& values) {
    return 0.5 * weight * gap(name, values.*field, target).squaredNorm();
  };
  auto add = [=](const TrajectoryValues& values, TrajectoryPartials& partials) {
    const Eigen::MatrixXd difference = gap(name, values.*field, target);
    (partials.*partial).rightCols(difference.cols()) += weight * difference;
  };
  return user_term(name, value, add);
}

/// ½ weight Σ ‖field_k‖² over steps 1 … N.
TermPointer squared_field(const char* name, Eigen::MatrixXd TrajectoryValues::*field,
                          Eigen::MatrixXd TrajectoryPartials::*partial, double weight) {
  require_weight(name, weight);
  return user_term(
      name,
      [=](const TrajectoryValues& values) {
        const Eigen::MatrixXd& all = values.*field;
        return 0.5 * weight * all.rightCols(all.cols() - 1).squaredNorm();
      },
      [=](const TrajectoryValues& values, TrajectoryPartials& partials) {
        const Eigen::Index steps = (values.*field).cols() - 1;
        (partials.*partial).rightCols(steps) += weight * (values.*field).rightCols(steps);
      });
}

}  // namespace

TermPointer user_term(std::string name, Value value, AddPartials add_partials) {
  return std::make_shared<FunctionObjective>(std::move(name), std::move(value),
                                             std::move(add_partials));
}

TermPointer squared_variables(double weight) {
  return squared_field("squared_variables", &TrajectoryValues::v, &TrajectoryPartials::v, weight);
}

TermPointer squared_tactile(double weight) {
  return squared_field("squared_tactile", &TrajectoryValues::tactile, &TrajectoryPartials::tactile,
                       weight);
}

TermPointer squared_final_position(double weight) {
  require_weight("squared_final_position", weight);
  return user_term(
      "squared_final_position",
      [weight](const TrajectoryValues& values) {
        return 0.5 * weight * values.q.rightCols<1>().squaredNorm();
      },
      [weight](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.q.rightCols<1>() += weight * values.q.rightCols<1>();
      });
}

TermPointer tracking(Eigen::MatrixXd target, double weight) {
  return squared_gap("tracking", &TrajectoryValues::q, &TrajectoryPartials::q, std::move(target),
                     weight);
}

TermPointer variable_tracking(Eigen::MatrixXd target, double weight) {
  return squared_gap("variable_tracking", &TrajectoryValues::v, &TrajectoryPartials::v,
                     std::move(target), weight);
}

TermPointer terminal_state(Eigen::VectorXd q, Eigen::VectorXd qdot, double weight_q,
                           double weight_qdot) {
  require_weight("terminal_state", weight_q);
  require_weight("terminal_state", weight_qdot);
  const auto check = [=](const TrajectoryValues& values) {
    if (q.size() != values.q.rows() || qdot.size() != values.qdot.rows()) {
      throw InvalidInput(concat("terminal_state: q has ", q.size(), " and qdot ", qdot.size(),
                                " entries; they must have ", values.q.rows()));
    }
  };
  return user_term(
      "terminal_state",
      [=](const TrajectoryValues& values) {
        check(values);
        return 0.5 * (weight_q * (values.q.rightCols<1>() - q).squaredNorm() +
                      weight_qdot * (values.qdot.rightCols<1>() - qdot).squaredNorm());
      },
      [=](const TrajectoryValues& values, TrajectoryPartials& partials) {
        check(values);
        partials.q.rightCols<1>() += weight_q * (values.q.rightCols<1>() - q);
        partials.qdot.rightCols<1>() += weight_qdot * (values.qdot.rightCols<1>() - qdot);
      });
}

TermPointer effort(double weight) {
  require_weight("effort", weight);
  return user_term(
      "effort",
      [weight](const TrajectoryValues& values) {
        return 0.5 * weight * values.h * values.u.squaredNorm();
      },
      [weight](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.u += weight * values.h * values.u;
      });
}

TermPointer squared_velocity(double weight) {
  require_weight("squared_velocity", weight);
  return user_term(
      "squared_velocity",
      [weight](const TrajectoryValues& values) {
        return 0.5 * weight * values.h *
               values.qdot.rightCols(values.qdot.cols() - 1).squaredNorm();
      },
      [weight](const TrajectoryValues& values, TrajectoryPartials& partials) {
        const Eigen::Index steps = values.qdot.cols() - 1;
        partials.qdot.rightCols(steps) += weight * values.h * values.qdot.rightCols(steps);
      });
}

}  // namespace hbar
