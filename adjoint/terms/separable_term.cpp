#include "hbar/adjoint/terms/separable_term.h"

#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "hbar/adjoint/terms/value_access.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

/// One x of a sum.
struct Summand {
  ValuePlace place;
  double weight = 0.0;
  double target = 0.0;
};

void check_shapes(const std::string& name, const StepSum& sum, const TrajectoryValues& values,
                  Eigen::Index rows, Eigen::Index steps) {
  const Eigen::MatrixXd& target = sum.target;
  if (target.size() > 0 &&
      (target.rows() != rows || (target.cols() != steps && target.cols() != 1))) {
    throw InvalidInput(concat(name, ": target of ", field_name(sum.field), " is ", target.rows(),
                              " x ", target.cols(), "; it must be ",
                              steps == 1 ? "" : concat(rows, " x ", steps, " or "), rows, " x 1"));
  }
  if (sum.steps.each.size() > 0 && sum.steps.each.size() != steps) {
    throw InvalidInput(concat(name, ": there are ", sum.steps.each.size(),
                              " weights of steps; there must be ", steps, " or none"));
  }
  for (const int row : sum.rows) {
    if (row < 0 || row >= field_rows(values, sum.field)) {
      throw InvalidInput(concat(name, ": there is no row ", row, " of ", field_name(sum.field),
                                "; it has ", field_rows(values, sum.field)));
    }
  }
}

/// The rows that a sum takes.
std::vector<int> rows_of(const StepSum& sum, const TrajectoryValues& values) {
  if (!sum.rows.empty()) {
    return sum.rows;
  }
  const MeasuredRows& measured = values.measured_rows;
  Eigen::Index first = 0;
  Eigen::Index count = field_rows(values, sum.field);
  switch (sum.choice) {
    case RowChoice::kAll:
      break;
    case RowChoice::kVariables:
      count = measured.variables;
      break;
    case RowChoice::kTactile:
      first = measured.variables;
      count = measured.tactile;
      break;
    case RowChoice::kDeclared:
      first = measured.variables + measured.tactile;
      count = values.declared_count();
      break;
  }
  std::vector<int> rows(static_cast<std::size_t>(count));
  std::iota(rows.begin(), rows.end(), static_cast<int>(first));
  return rows;
}

/// Visits the relevant numbers of a sum, one after the other: a list of them would be several times
/// as large as the values.
template <typename Visit>
void for_each_summand(const std::string& name, const StepSum& sum, const TrajectoryValues& values,
                      const Visit& visit) {
  const std::vector<int> rows = rows_of(sum, values);
  const auto last = static_cast<int>(field_columns(values, sum.field)) - 1;
  // What happens at k = 0 is given, not caused; the controls of step 1 are u_0.
  const int first = sum.final_only ? last : (sum.field == ValueField::kU ? 0 : 1);
  check_shapes(name, sum, values, static_cast<Eigen::Index>(rows.size()), last - first + 1);
  const double h = sum.times_h ? values.h : 1.0;
  for (int column = first; column <= last; ++column) {
    const double weight = sum.weight * sum.steps.of(column - first + 1);
    if (weight == 0.0) {
      continue;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double target = sum.target.size() == 0
                                ? 0.0
                                : sum.target(static_cast<Eigen::Index>(r),
                                             sum.target.cols() == 1 ? 0 : column - first);
      visit(Summand{{sum.field, column, rows[r]}, weight * h, target});
    }
  }
}

class SeparableTerm final : public ObjectiveTerm {
 public:
  SeparableTerm(std::string name, std::vector<StepSum> sums, std::function<Jet(double)> phi,
                bool linear)
      : name_(std::move(name)), sums_(std::move(sums)), phi_(std::move(phi)), linear_(linear) {}

  [[nodiscard]] std::string name() const override { return name_; }

  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    double total = 0.0;
    for_each(values, [&](const Summand& s) {
      total += s.weight * phi_(value_at(values, s.place) - s.target).value;
    });
    return total;
  }

  void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const override {
    for_each(values, [&](const Summand& s) {
      partial_at(partials, s.place) += s.weight * phi_(value_at(values, s.place) - s.target).slope;
    });
  }

  [[nodiscard]] std::vector<SecondPlace> second_places(
      const TrajectoryValues& shape) const override {
    std::vector<SecondPlace> out;
    if (!linear_) {
      for_each(shape, [&](const Summand& s) { out.push_back({0, s.place, s.place}); });
    }
    return out;
  }

  void second_partials(const TrajectoryValues& values,
                       Eigen::Ref<Eigen::VectorXd> second) const override {
    Eigen::Index at = 0;
    if (!linear_) {
      for_each(values, [&](const Summand& s) {
        second[at++] = s.weight * phi_(value_at(values, s.place) - s.target).curvature;
      });
    }
  }

 private:
  template <typename Visit>
  void for_each(const TrajectoryValues& values, const Visit& visit) const {
    for (const StepSum& sum : sums_) {
      for_each_summand(name_, sum, values, visit);
    }
  }

  std::string name_;
  std::vector<StepSum> sums_;
  std::function<Jet(double)> phi_;
  bool linear_ = false;
};

}  // namespace

StepWeights StepWeights::over_time(int steps, double h,
                                   const std::function<double(double)>& weight) {
  require_given("StepWeights", "function of time", weight);
  if (steps < 1) {
    throw InvalidInput(concat("StepWeights: steps is ", steps, "; it must be ≥ 1"));
  }
  StepWeights out{Eigen::VectorXd(steps)};
  for (int k = 1; k <= steps; ++k) {
    out.each[k - 1] = weight(k * h);
  }
  return out;
}

void StepWeights::check(const std::string& term) const {
  for (Eigen::Index k = 0; k < each.size(); ++k) {
    if (!(each[k] >= 0.0) || !std::isfinite(each[k])) {
      throw InvalidInput(
          concat(term, ": the weight of step ", k + 1, " is ", each[k], "; it must be ≥ 0"));
    }
  }
}

TermPointer separable_term(std::string name, std::vector<StepSum> sums,
                           std::function<Jet(double)> phi, bool linear) {
  for (const StepSum& sum : sums) {
    if (std::set<int>(sum.rows.begin(), sum.rows.end()).size() != sum.rows.size()) {
      throw InvalidInput(concat(name, ": a row of ", field_name(sum.field), " is named twice"));
    }
    sum.steps.check(name);
    if (sum.field == ValueField::kP) {
      throw InvalidInput(concat(name, ": p has no steps to sum over; use weighted_numbers"));
    }
    if (!std::isfinite(sum.weight) || !sum.target.allFinite()) {
      throw InvalidInput(concat(name, ": weight and target must be finite"));
    }
  }
  require_given(name, "function phi", phi);
  return std::make_shared<SeparableTerm>(std::move(name), std::move(sums), std::move(phi), linear);
}

}  // namespace hbar
