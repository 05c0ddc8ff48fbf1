#include "hbar/adjoint/terms/constraint_terms.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "hbar/adjoint/terms/place.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model.h"
#include "hbar/core/parameters/parameters.h"

namespace hbar {
namespace {

/// Collects linear rows, then turns them into a term.
class RowBuilder {
 public:
  /// Adds a row lower ≤ Σ weight · number ≤ upper, unless it bounds nothing.
  void add(std::string name, double lower, double upper,
           const std::vector<std::pair<ValuePlace, double>>& numbers) {
    if (lower == -std::numeric_limits<double>::infinity() &&
        upper == std::numeric_limits<double>::infinity()) {
      return;
    }
    for (const auto& [place, weight] : numbers) {
      places_.push_back({static_cast<int>(names_.size()), place.field, place.step, place.index});
      weights_.push_back(weight);
    }
    names_.push_back(std::move(name));
    lower_.push_back(lower);
    upper_.push_back(upper);
  }
  [[nodiscard]] ConstraintPointer build() const {
    const auto vector = [](const std::vector<double>& x) {
      return Eigen::VectorXd(
          Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
    };
    return linear_constraint({names_, vector(lower_), vector(upper_)}, places_, vector(weights_));
  }

 private:
  std::vector<std::string> names_;
  std::vector<PartialPlace> places_;
  std::vector<double> lower_;
  std::vector<double> upper_;
  std::vector<double> weights_;
};

void require_coordinate(const char* term, const Model& model, int coordinate) {
  if (coordinate < 0 || coordinate >= model.dof()) {
    throw InvalidInput(
        concat(term, ": there is no coordinate ", coordinate, "; the model has ", model.dof()));
  }
}

void require_steps(const char* term, int steps) {
  if (steps < 1) {
    throw InvalidInput(concat(term, ": steps is ", steps, "; it must be ≥ 1"));
  }
}

}  // namespace

std::vector<int> step_range(int first, int last, int stride) {
  if (first < 0 || last < first || stride < 1) {
    throw InvalidInput(concat("step_range: ", first, " to ", last, " by ", stride,
                              "; it must be 0 ≤ first ≤ last and stride ≥ 1"));
  }
  std::vector<int> out;
  for (int k = first; k <= last; k += stride) {
    out.push_back(k);
  }
  return out;
}

ConstraintPointer value_limits(const std::string& name, ValueField field, int index,
                               const std::vector<int>& steps, double lower, double upper) {
  RowBuilder rows;
  if (field == ValueField::kP) {
    rows.add(name, lower, upper, {{{field, 0, index}, 1.0}});
    return rows.build();
  }
  for (const int step : steps) {
    rows.add(concat(name, " at step ", step), lower, upper, {{{field, step, index}, 1.0}});
  }
  return rows.build();
}

ConstraintPointer rate_limits(const Model& model, int coordinate, const std::vector<int>& steps,
                              double lower, double upper) {
  require_coordinate("rate_limits", model, coordinate);
  return value_limits(model.coordinate_name(coordinate) + " rate", ValueField::kQdot, coordinate,
                      steps, lower, upper);
}

ConstraintPointer variable_limits(const Model& model, const std::string& end_effector,
                                  const std::vector<int>& steps, const Eigen::Vector3d& lower,
                                  const Eigen::Vector3d& upper) {
  constexpr std::array<const char*, 3> kAxisNames = {".x at step ", ".y at step ", ".z at step "};
  const int first = place::end_effector(model, end_effector, kX, 0).index;
  RowBuilder rows;
  for (const int step : steps) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.add(concat(end_effector, kAxisNames[static_cast<std::size_t>(axis)], step), lower[axis],
               upper[axis], {{{ValueField::kMeasured, step, first + axis}, 1.0}});
    }
  }
  return rows.build();
}

ConstraintPointer control_rate(const Model& model, int steps, const Eigen::VectorXd& change) {
  require_steps("control_rate", steps);
  if ((change.size() != 1 && change.size() != model.control_count()) ||
      !(change.array() >= 0.0).all()) {
    throw InvalidInput(concat("control_rate: change is (", listed(change),
                              "); it must be one number or ", model.control_count(), ", each ≥ 0"));
  }
  RowBuilder rows;
  for (int k = 1; k < steps; ++k) {
    for (int i = 0; i < model.control_count(); ++i) {
      const double most = change[change.size() == 1 ? 0 : i];
      rows.add(concat(model.control_name(i), " change at step ", k), -most, most,
               {{{ValueField::kU, k, i}, 1.0}, {{ValueField::kU, k - 1, i}, -1.0}});
    }
  }
  return rows.build();
}

ConstraintPointer periodicity(const Model& model, int steps, std::vector<int> coordinates,
                              const Eigen::VectorXd& advance) {
  require_steps("periodicity", steps);
  if (coordinates.empty()) {
    coordinates.resize(static_cast<std::size_t>(model.dof()));
    std::iota(coordinates.begin(), coordinates.end(), 0);
  }
  const auto count = static_cast<Eigen::Index>(coordinates.size());
  if (advance.size() != 0 && (advance.size() != count || !advance.allFinite())) {
    throw InvalidInput(concat("periodicity: advance is (", listed(advance), "); it must be ", count,
                              " finite numbers or none"));
  }
  RowBuilder rows;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int c = coordinates[static_cast<std::size_t>(i)];
    require_coordinate("periodicity", model, c);
    const double gain = advance.size() == 0 ? 0.0 : advance[i];
    rows.add(model.coordinate_name(c) + " period", gain, gain,
             {{{ValueField::kQ, steps, c}, 1.0}, {{ValueField::kQ, 0, c}, -1.0}});
  }
  for (const int c : coordinates) {
    rows.add(model.coordinate_name(c) + " rate period", 0.0, 0.0,
             {{{ValueField::kQdot, steps, c}, 1.0}, {{ValueField::kQdot, 0, c}, -1.0}});
  }
  return rows.build();
}

ConstraintPointer parameter_tie(const ParameterSet& set, const std::string& a, double ratio,
                                const std::string& b, double offset) {
  const int first = set.find(a);
  const int second = set.find(b);
  if (first == second || !std::isfinite(ratio) || !std::isfinite(offset)) {
    throw InvalidInput(concat("parameter_tie: ", a, " = ", ratio, " ", b, " + ", offset,
                              "; it must be two parameters and finite numbers"));
  }
  RowBuilder rows;
  rows.add(concat(a, " tied to ", b), offset, offset,
           {{{ValueField::kP, 0, first}, 1.0}, {{ValueField::kP, 0, second}, -ratio}});
  return rows.build();
}

ConstraintPointer total_mass(const ParameterSet& set, const Model& model, double lower,
                             double upper) {
  std::vector<PartialPlace> places;
  double fixed = 0.0;
  for (int link = 0; link < model.link_count(); ++link) {
    const int index = set.index(ParameterKind::kMass, link, 0);
    if (index < 0) {
      fixed += model.link(link).body.mass;
    } else {
      places.push_back({0, ValueField::kP, 0, index});
    }
  }
  for (const Parameter& parameter : set.parameters()) {
    if (parameter.kind == ParameterKind::kSize) {
      throw InvalidInput(concat("total_mass: '", parameter.name,
                                "' is in the set, by which a mass is not linear; write it as a "
                                "generic_constraint"));
    }
  }
  if (places.empty()) {
    throw InvalidInput("total_mass: there is no mass in the parameter set");
  }
  const auto count = static_cast<Eigen::Index>(places.size());
  return linear_constraint(
      {{"total mass"}, Eigen::VectorXd::Constant(1, lower), Eigen::VectorXd::Constant(1, upper)},
      std::move(places), Eigen::VectorXd::Ones(count), Eigen::VectorXd::Constant(1, fixed));
}

}  // namespace hbar
