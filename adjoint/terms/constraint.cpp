#include "hbar/adjoint/terms/constraint.h"

#include <array>
#include <cmath>
#include <utility>

#include "hbar/adjoint/terms/place.h"
#include "hbar/adjoint/terms/value_access.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model.h"
#include "hbar/core/parameters/parameters.h"

namespace hbar {
namespace {

using Write = std::function<void(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>)>;

/// c_row = constant_row + Σ weight · number over the row's places.
class LinearTerm final : public ConstraintTerm {
 public:
  LinearTerm(ConstraintRows rows, std::vector<PartialPlace> places, Eigen::VectorXd weights,
             Eigen::VectorXd constants)
      : ConstraintTerm(std::move(rows), std::move(places)),
        weights_(std::move(weights)),
        constants_(std::move(constants)) {}

  void values(const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) const override {
    c = constants_;
    for (std::size_t k = 0; k < places().size(); ++k) {
      c[places()[k].row] +=
          weights_[static_cast<Eigen::Index>(k)] * value_at(values, places()[k].place());
    }
  }
  void partials(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd> partials) const override {
    partials = weights_;
  }

 private:
  Eigen::VectorXd weights_;
  Eigen::VectorXd constants_;
};

/// A term whose row i is the number at place i.
ConstraintPointer numbers_within(std::vector<std::string> names, std::vector<PartialPlace> places,
                                 const std::vector<double>& lower,
                                 const std::vector<double>& upper) {
  const auto count = static_cast<Eigen::Index>(places.size());
  ConstraintRows rows{std::move(names), Eigen::Map<const Eigen::VectorXd>(lower.data(), count),
                      Eigen::Map<const Eigen::VectorXd>(upper.data(), count)};
  return linear_constraint(std::move(rows), std::move(places), Eigen::VectorXd::Ones(count));
}

class FunctionConstraint final : public ConstraintTerm {
 public:
  FunctionConstraint(ConstraintRows rows, std::vector<PartialPlace> places, Write values,
                     Write partials, std::optional<RowSecondPartials> second)
      : ConstraintTerm(std::move(rows), std::move(places)),
        values_(std::move(values)),
        partials_(std::move(partials)),
        second_(std::move(second)) {}

  void values(const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) const override {
    values_(values, c);
  }
  void partials(const TrajectoryValues& values,
                Eigen::Ref<Eigen::VectorXd> partials) const override {
    partials_(values, partials);
  }
  [[nodiscard]] std::vector<SecondPlace> second_places() const override {
    if (!second_) {
      throw InvalidInput(concat("constraint '", rows().names.empty() ? "" : rows().names.front(),
                                "' has no second partials; give user_constraint its second places "
                                "and partials (or say that the rows are linear), write it as a "
                                "generic_constraint, or use the limited-memory Hessian"));
    }
    return second_->places;
  }
  void second_partials(const TrajectoryValues& values,
                       Eigen::Ref<Eigen::VectorXd> second) const override {
    if (!second_places().empty()) {
      second_->partials(values, second);
    }
  }

 private:
  Write values_;
  Write partials_;
  std::optional<RowSecondPartials> second_;
};

void require_step(const char* term, int step) {
  if (step < 0) {
    throw InvalidInput(concat(term, ": step is ", step, "; it must be ≥ 0"));
  }
}

}  // namespace

ConstraintTerm::ConstraintTerm(ConstraintRows rows, std::vector<PartialPlace> places)
    : rows_(std::move(rows)), places_(std::move(places)) {
  const Eigen::Index count = rows_.size();
  if (rows_.upper.size() != count || static_cast<Eigen::Index>(rows_.names.size()) != count) {
    throw InvalidInput(concat("constraint: ", rows_.names.size(), " names, ", count, " lower and ",
                              rows_.upper.size(), " upper bounds; there must be as many of each"));
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!(rows_.lower[i] <= rows_.upper[i])) {
      throw InvalidInput(concat("constraint '", rows_.names[static_cast<std::size_t>(i)],
                                "': the lower bound ", rows_.lower[i],
                                " must not exceed the upper one, ", rows_.upper[i]));
    }
  }
  for (const PartialPlace& place : places_) {
    if (place.row < 0 || place.row >= count || place.step < 0 || place.index < 0) {
      throw InvalidInput(concat("constraint: a place names row ", place.row, ", step ", place.step,
                                " and index ", place.index, "; there are ", count, " rows"));
    }
  }
}

void ConstraintTerm::second_partials(const TrajectoryValues&, Eigen::Ref<Eigen::VectorXd>) const {}

ConstraintPointer variable_at_step(const Model& model, const std::string& end_effector, int step,
                                   const Eigen::Vector3d& target, double half_width) {
  require_step("variable_at_step", step);
  if (!target.allFinite() || !(half_width >= 0.0)) {
    throw InvalidInput(concat("variable_at_step: target (", listed(target), ") ± ", half_width,
                              "; the target must be finite and the half width ≥ 0"));
  }
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  const int first = place::end_effector(model, end_effector, kX, step).index;
  std::vector<std::string> names;
  std::vector<PartialPlace> places;
  std::vector<double> lower;
  std::vector<double> upper;
  for (int k = 0; k < 3; ++k) {
    names.push_back(
        concat(end_effector, ".", kAxes[static_cast<std::size_t>(k)], " at step ", step));
    places.push_back({k, PartialPlace::Field::kMeasured, step, first + k});
    lower.push_back(target[k] - half_width);
    upper.push_back(target[k] + half_width);
  }
  return numbers_within(std::move(names), std::move(places), lower, upper);
}

ConstraintPointer joint_limits(const Model& model, const std::vector<int>& steps, double margin) {
  if (!(margin >= 0.0)) {
    throw InvalidInput(concat("joint_limits: margin is ", margin, "; it must be ≥ 0"));
  }
  std::vector<std::string> names;
  std::vector<PartialPlace> places;
  std::vector<double> lower;
  std::vector<double> upper;
  for (int i = 0; i < model.link_count(); ++i) {
    const auto& limits = model.link(i).joint.limits;
    if (!limits) {
      continue;
    }
    const CoordinateRange range = model.coordinates_of_link(i);
    for (int c = range.begin; c < range.end; ++c) {
      for (const int step : steps) {
        require_step("joint_limits", step);
        names.push_back(concat(model.coordinate_name(c), " at step ", step));
        places.push_back({static_cast<int>(places.size()), PartialPlace::Field::kQ, step, c});
        lower.push_back(limits->lower + margin);
        upper.push_back(limits->upper - margin);
      }
    }
  }
  return numbers_within(std::move(names), std::move(places), lower, upper);
}

ConstraintPointer coordinate_limits(const Model& model, int coordinate,
                                    const std::vector<int>& steps, double lower, double upper) {
  if (coordinate < 0 || coordinate >= model.dof()) {
    throw InvalidInput(concat("coordinate_limits: there is no coordinate ", coordinate,
                              "; the model has ", model.dof()));
  }
  std::vector<std::string> names;
  std::vector<PartialPlace> places;
  for (const int step : steps) {
    require_step("coordinate_limits", step);
    names.push_back(concat(model.coordinate_name(coordinate), " at step ", step));
    places.push_back({static_cast<int>(places.size()), PartialPlace::Field::kQ, step, coordinate});
  }
  return numbers_within(std::move(names), std::move(places),
                        std::vector<double>(steps.size(), lower),
                        std::vector<double>(steps.size(), upper));
}

ConstraintPointer parameter_sum(const ParameterSet& set, const std::string& name,
                                const std::vector<std::string>& names, double lower, double upper,
                                const Eigen::VectorXd& weights) {
  const auto count = static_cast<Eigen::Index>(names.size());
  if (weights.size() != 0 && weights.size() != count) {
    throw InvalidInput(concat("parameter_sum '", name, "': ", count, " parameters and ",
                              weights.size(), " weights; there must be as many of each"));
  }
  std::vector<PartialPlace> places;
  for (const std::string& parameter : names) {
    places.push_back({0, PartialPlace::Field::kP, 0, set.find(parameter)});
  }
  ConstraintRows rows{
      {name}, Eigen::VectorXd::Constant(1, lower), Eigen::VectorXd::Constant(1, upper)};
  return linear_constraint(
      std::move(rows), std::move(places),
      weights.size() > 0 ? weights : Eigen::VectorXd(Eigen::VectorXd::Ones(count)));
}

ConstraintPointer linear_constraint(ConstraintRows rows, std::vector<PartialPlace> places,
                                    Eigen::VectorXd weights, Eigen::VectorXd constants) {
  if (constants.size() == 0) {
    constants = Eigen::VectorXd::Zero(rows.size());
  }
  if (weights.size() != static_cast<Eigen::Index>(places.size()) ||
      constants.size() != rows.size() || !weights.allFinite() || !constants.allFinite()) {
    throw InvalidInput(concat("linear_constraint: ", rows.size(), " rows with ", constants.size(),
                              " constants, and ", places.size(), " places with ", weights.size(),
                              " weights; there must be as many of each, and all finite"));
  }
  return std::make_shared<LinearTerm>(std::move(rows), std::move(places), std::move(weights),
                                      std::move(constants));
}

ConstraintPointer user_constraint(ConstraintRows rows, std::vector<PartialPlace> places,
                                  Write values, Write partials,
                                  std::optional<RowSecondPartials> second) {
  require_given("user_constraint", "function of its values", values);
  require_given("user_constraint", "function of its partials", partials);
  if (second && !second->places.empty() && !second->partials) {
    throw InvalidInput("user_constraint: there are second places but no function for them");
  }
  for (const SecondPlace& place : second ? second->places : std::vector<SecondPlace>()) {
    if (place.row < 0 || place.row >= rows.size()) {
      throw InvalidInput(concat("user_constraint: a second place names row ", place.row,
                                "; there are ", rows.size(), " rows"));
    }
  }
  return std::make_shared<FunctionConstraint>(std::move(rows), std::move(places), std::move(values),
                                              std::move(partials), std::move(second));
}

}  // namespace hbar
