#include "hbar/adjoint/terms/objective_terms.h"

#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "hbar/adjoint/terms/value_access.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Value = std::function<double(const TrajectoryValues&)>;
using AddPartials = std::function<void(const TrajectoryValues&, TrajectoryPartials&)>;

class FunctionObjective final : public ObjectiveTerm {
 public:
  FunctionObjective(std::string name, Value value, AddPartials add, TermSecondPartials second)
      : name_(std::move(name)),
        value_(std::move(value)),
        add_(std::move(add)),
        second_(std::move(second)) {}

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    return value_(values);
  }
  void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const override {
    add_(values, partials);
  }
  [[nodiscard]] std::vector<SecondPlace> second_places(
      const TrajectoryValues& shape) const override {
    if (!second_.places) {
      throw InvalidInput(concat("objective term '", name_,
                                "' has no second partials; give user_term its second places and "
                                "partials, write it as a generic_term, or use the limited-memory "
                                "Hessian"));
    }
    return second_.places(shape);
  }
  void second_partials(const TrajectoryValues& values,
                       Eigen::Ref<Eigen::VectorXd> second) const override {
    if (!second_.partials) {
      static_cast<void>(second_places(values));  // says so
    }
    second_.partials(values, second);
  }

 private:
  std::string name_;
  Value value_;
  AddPartials add_;
  TermSecondPartials second_;
};

/// ½ weight Σ ‖u_k − u_{k−1}‖² / h
class ControlSmoothness final : public ObjectiveTerm {
 public:
  ControlSmoothness(double weight, StepWeights steps) : weight_(weight), steps_(std::move(steps)) {}

  [[nodiscard]] std::string name() const override { return "control_smoothness"; }

  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    double sum = 0.0;
    for (Eigen::Index k = 1; k < values.u.cols(); ++k) {
      sum += 0.5 * factor(values, k) / values.h *
             (values.u.col(k) - values.u.col(k - 1)).squaredNorm();
    }
    return sum;
  }

  void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const override {
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(values.u.rows(), values.u.cols());
    for (Eigen::Index k = 1; k < values.u.cols(); ++k) {
      const Eigen::VectorXd slope =
          factor(values, k) / values.h * (values.u.col(k) - values.u.col(k - 1));
      slopes.col(k) += slope;
      slopes.col(k - 1) -= slope;
    }
    partials.u += slopes;
  }

  [[nodiscard]] std::vector<SecondPlace> second_places(
      const TrajectoryValues& shape) const override {
    std::vector<SecondPlace> out;
    visit(shape, [&](int i, int k, int other, double) {
      out.push_back({0, {ValueField::kU, k, i}, {ValueField::kU, other, i}});
    });
    return out;
  }

  void second_partials(const TrajectoryValues& values,
                       Eigen::Ref<Eigen::VectorXd> second) const override {
    Eigen::Index at = 0;
    visit(values, [&](int, int, int, double curvature) { second[at++] = curvature / values.h; });
  }

 private:
  /// Weight of the change from u_{k−1} to u_k; none before the first step and after the last.
  [[nodiscard]] double factor(const TrajectoryValues& values, Eigen::Index k) const {
    if (steps_.each.size() != 0 && steps_.each.size() != values.u.cols()) {
      throw InvalidInput(concat(name(), ": there are ", steps_.each.size(),
                                " weights of steps; there must be ", values.u.cols(), " or none"));
    }
    return k < 1 || k >= values.u.cols() ? 0.0 : weight_ * steps_.of(k + 1);
  }

  /// Calls f(control, step, other step, h · second partial) for every one that is not zero.
  template <typename Function>
  void visit(const TrajectoryValues& values, const Function& f) const {
    for (int k = 0; k < values.u.cols(); ++k) {
      const double before = factor(values, k);
      const double after = factor(values, k + 1);
      for (int i = 0; i < values.u.rows(); ++i) {
        if (before + after > 0.0) {
          f(i, k, k, before + after);
        }
        if (before > 0.0) {
          f(i, k, k - 1, -before);
        }
      }
    }
  }

  double weight_ = 1.0;
  StepWeights steps_;
};

class WeightedNumbers final : public ObjectiveTerm {
 public:
  WeightedNumbers(std::string name, std::vector<ValuePlace> places, Eigen::VectorXd weights)
      : name_(std::move(name)), places_(std::move(places)), weights_(std::move(weights)) {}

  [[nodiscard]] std::string name() const override { return name_; }
  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    double sum = 0.0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      sum += weights_[static_cast<Eigen::Index>(i)] * value_at(values, places_[i]);
    }
    return sum;
  }
  void add_partials(const TrajectoryValues&, TrajectoryPartials& partials) const override {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      partial_at(partials, places_[i]) += weights_[static_cast<Eigen::Index>(i)];
    }
  }
  [[nodiscard]] std::vector<SecondPlace> second_places(const TrajectoryValues&) const override {
    return {};
  }
  void second_partials(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>) const override {}

 private:
  std::string name_;
  std::vector<ValuePlace> places_;
  Eigen::VectorXd weights_;
};

void require_weight(std::string_view term, double weight) {
  if (!(weight >= 0.0) || !std::isfinite(weight)) {
    throw InvalidInput(concat(term, ": weight is ", weight, "; it must be ≥ 0"));
  }
}

/// ½ Σ weight x².
TermPointer half_squares(const char* name, std::vector<StepSum> sums) {
  for (const StepSum& sum : sums) {
    require_weight(name, sum.weight);
  }
  return separable_term(name, std::move(sums), [](double x) { return Jet{0.5 * x * x, x, 1.0}; });
}

/// Σ weight x.
TermPointer plain_sum(const char* name, StepSum sum) {
  return separable_term(
      name, {std::move(sum)},
      [](double x) {
        return Jet{x, 1.0, 0.0};
      },
      true);
}

}  // namespace

TermPointer user_term(std::string name, Value value, AddPartials add_partials,
                      TermSecondPartials second) {
  require_given(concat("user_term '", name, "'"), "function of its value", value);
  require_given(concat("user_term '", name, "'"), "function of its partials", add_partials);
  if (static_cast<bool>(second.places) != static_cast<bool>(second.partials)) {
    throw InvalidInput(
        concat("user_term '", name, "': give second places and second partials, ", "or neither"));
  }
  return std::make_shared<FunctionObjective>(std::move(name), std::move(value),
                                             std::move(add_partials), std::move(second));
}

TermPointer squared_variables(double weight, const StepWeights& steps) {
  return half_squares("squared_variables", {{.field = ValueField::kMeasured,
                                             .choice = RowChoice::kVariables,
                                             .weight = weight,
                                             .steps = steps}});
}

TermPointer squared_tactile(double weight, const StepWeights& steps) {
  return half_squares("squared_tactile", {{.field = ValueField::kMeasured,
                                           .choice = RowChoice::kTactile,
                                           .weight = weight,
                                           .steps = steps}});
}

TermPointer squared_measured(double weight, const std::vector<int>& rows,
                             const StepWeights& steps) {
  return half_squares("squared_measured", {{.field = ValueField::kMeasured,
                                            .rows = rows,
                                            .choice = RowChoice::kDeclared,
                                            .weight = weight,
                                            .steps = steps}});
}

TermPointer squared_final_position(double weight) {
  return half_squares("squared_final_position",
                      {{.field = ValueField::kQ, .weight = weight, .final_only = true}});
}

TermPointer tracking(Eigen::MatrixXd target, double weight, const StepWeights& steps) {
  return half_squares(
      "tracking",
      {{.field = ValueField::kQ, .target = std::move(target), .weight = weight, .steps = steps}});
}

TermPointer variable_tracking(Eigen::MatrixXd target, double weight, const StepWeights& steps) {
  return half_squares("variable_tracking", {{.field = ValueField::kMeasured,
                                             .choice = RowChoice::kVariables,
                                             .target = std::move(target),
                                             .weight = weight,
                                             .steps = steps}});
}

TermPointer measured_tracking(const std::vector<int>& rows, Eigen::MatrixXd target, double weight,
                              const StepWeights& steps) {
  return half_squares("measured_tracking", {{.field = ValueField::kMeasured,
                                             .rows = rows,
                                             .choice = RowChoice::kDeclared,
                                             .target = std::move(target),
                                             .weight = weight,
                                             .steps = steps}});
}

TermPointer tracking_of(ValueField field, const std::vector<int>& rows, Eigen::MatrixXd target,
                        double weight, const StepWeights& steps) {
  return half_squares("tracking_of", {{.field = field,
                                       .rows = rows,
                                       .target = std::move(target),
                                       .weight = weight,
                                       .steps = steps}});
}

TermPointer terminal_state(Eigen::VectorXd q, Eigen::VectorXd qdot, double weight_q,
                           double weight_qdot) {
  return half_squares(
      "terminal_state",
      {{.field = ValueField::kQ, .target = std::move(q), .weight = weight_q, .final_only = true},
       {.field = ValueField::kQdot,
        .target = std::move(qdot),
        .weight = weight_qdot,
        .final_only = true}});
}

TermPointer effort(double weight, const StepWeights& steps) {
  return half_squares(
      "effort", {{.field = ValueField::kU, .weight = weight, .steps = steps, .times_h = true}});
}

TermPointer squared_velocity(double weight, const StepWeights& steps) {
  return half_squares(
      "squared_velocity",
      {{.field = ValueField::kQdot, .weight = weight, .steps = steps, .times_h = true}});
}

TermPointer control_smoothness(double weight, const StepWeights& steps) {
  require_weight("control_smoothness", weight);
  steps.check("control_smoothness");
  return std::make_shared<ControlSmoothness>(weight, steps);
}

TermPointer work(const std::vector<int>& rows, double smoothing, double weight,
                 const StepWeights& steps) {
  require_weight("work", weight);
  if (!(smoothing > 0.0) || !std::isfinite(smoothing)) {
    throw InvalidInput(concat("work: smoothing is ", smoothing,
                              "; it must be > 0 (net_work adds the powers up with their signs)"));
  }
  if (rows.empty()) {
    throw InvalidInput("work: name the measured rows that are powers");
  }
  const auto smooth_size = [smoothing](double x) {
    const double root = std::hypot(x, smoothing);
    const double share = smoothing / root;
    return Jet{root - smoothing, x / root, share * share / root};
  };
  return separable_term("work",
                        {{.field = ValueField::kMeasured,
                          .rows = rows,
                          .weight = weight,
                          .steps = steps,
                          .times_h = true}},
                        smooth_size);
}

TermPointer net_work(const std::vector<int>& rows, double weight, const StepWeights& steps) {
  require_weight("net_work", weight);
  if (rows.empty()) {
    throw InvalidInput("net_work: name the measured rows that are powers");
  }
  return plain_sum("net_work", {.field = ValueField::kMeasured,
                                .rows = rows,
                                .weight = weight,
                                .steps = steps,
                                .times_h = true});
}

TermPointer time_integral(ValueField field, const std::vector<int>& rows, double weight,
                          const StepWeights& steps) {
  return plain_sum(
      "time_integral",
      {.field = field, .rows = rows, .weight = weight, .steps = steps, .times_h = true});
}

TermPointer final_number(ValueField field, int index, double weight) {
  return plain_sum("final_number",
                   {.field = field, .rows = {index}, .weight = weight, .final_only = true});
}

TermPointer weighted_numbers(std::string name, std::vector<ValuePlace> places,
                             Eigen::VectorXd weights) {
  if (weights.size() != static_cast<Eigen::Index>(places.size()) || !weights.allFinite()) {
    throw InvalidInput(concat(name, ": ", places.size(), " places and ", weights.size(),
                              " weights; there must be as many of each, and all finite"));
  }
  std::set<std::tuple<ValueField, int, int>> known;
  for (const ValuePlace& place : places) {
    if (!known.emplace(place.field, place.step, place.index).second) {
      throw InvalidInput(concat(name, ": ", place_name(place), " is named twice"));
    }
  }
  return std::make_shared<WeightedNumbers>(std::move(name), std::move(places), std::move(weights));
}

}  // namespace hbar
