#include "hbar/adjoint/terms/generic_terms.h"

#include <map>
#include <set>
#include <tuple>

#include "hbar/adjoint/terms/value_access.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using PlaceKey = std::tuple<ValueField, int, int>;

PlaceKey key_of(const ValuePlace& place) { return {place.field, place.step, place.index}; }

void require_each_once(const std::string& name, const std::vector<ValuePlace>& places) {
  std::set<PlaceKey> known;
  for (const ValuePlace& place : places) {
    if (!known.insert(key_of(place)).second) {
      throw InvalidInput(concat("'", name, "': ", place_name(place), " is named twice"));
    }
  }
}

/// The numbers at some places as T.
template <typename T>
std::vector<T> numbers_at(const TrajectoryValues& values, const std::vector<ValuePlace>& places) {
  std::vector<T> x;
  x.reserve(places.size());
  for (const ValuePlace& place : places) {
    x.emplace_back(value_at(values, place));
  }
  return x;
}

double formula_value(const GenericFormula& f, const TrajectoryValues& values,
                     const std::vector<ValuePlace>& places) {
  const std::vector<double> x = numbers_at<double>(values, places);
  return f(std::span<const double>(x));
}

/// Calls out(i, ∂f/∂x_i).
template <typename Out>
void formula_partials(const GenericFormula& f, const TrajectoryValues& values,
                      const std::vector<ValuePlace>& places, const Out& out) {
  std::vector<Dual> x = numbers_at<Dual>(values, places);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i].slope = 1.0;
    out(i, f(std::span<const Dual>(x)).slope);
    x[i].slope = 0.0;
  }
}

/// Calls out(i, j, ∂²f/∂x_i∂x_j) for j ≤ i, row by row.
template <typename Out>
void formula_second_partials(const GenericFormula& f, const TrajectoryValues& values,
                             const std::vector<ValuePlace>& places, const Out& out) {
  std::vector<HyperDual> x = numbers_at<HyperDual>(values, places);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i].slope_1 = 1.0;
    for (std::size_t j = 0; j <= i; ++j) {
      x[j].slope_2 = 1.0;
      out(i, j, f(std::span<const HyperDual>(x)).cross);
      x[j].slope_2 = 0.0;
    }
    x[i].slope_1 = 0.0;
  }
}

class GenericSum final : public ObjectiveTerm {
 public:
  GenericSum(std::string name, std::vector<std::vector<ValuePlace>> groups, GenericFormula f,
             Eigen::VectorXd weights)
      : name_(std::move(name)),
        groups_(std::move(groups)),
        f_(std::move(f)),
        weights_(std::move(weights)) {
    // Groups may share pairs of places: each pair has one slot, into which all of them add.
    std::map<std::pair<PlaceKey, PlaceKey>, Eigen::Index> known;
    for (const std::vector<ValuePlace>& group : groups_) {
      for (std::size_t i = 0; i < group.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
          PlaceKey a = key_of(group[i]);
          PlaceKey b = key_of(group[j]);
          if (b < a) {
            std::swap(a, b);
          }
          const auto [slot, is_new] =
              known.emplace(std::pair(a, b), static_cast<Eigen::Index>(known.size()));
          slots_.push_back(slot->second);
          if (is_new) {
            second_places_.push_back({0, group[i], group[j]});
          }
        }
      }
    }
  }

  [[nodiscard]] std::string name() const override { return name_; }

  [[nodiscard]] double value(const TrajectoryValues& values) const override {
    double sum = 0.0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      sum += weight(g) * formula_value(f_, values, groups_[g]);
    }
    return sum;
  }

  void add_partials(const TrajectoryValues& values, TrajectoryPartials& partials) const override {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      formula_partials(f_, values, groups_[g], [&](std::size_t i, double slope) {
        partial_at(partials, groups_[g][i]) += weight(g) * slope;
      });
    }
  }

  [[nodiscard]] std::vector<SecondPlace> second_places(const TrajectoryValues&) const override {
    return second_places_;
  }

  void second_partials(const TrajectoryValues& values,
                       Eigen::Ref<Eigen::VectorXd> second) const override {
    second.setZero();
    auto slot = slots_.begin();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      formula_second_partials(f_, values, groups_[g], [&](std::size_t, std::size_t, double cross) {
        second[*slot++] += weight(g) * cross;
      });
    }
  }

 private:
  [[nodiscard]] double weight(std::size_t g) const {
    return weights_.size() == 0 ? 1.0 : weights_[static_cast<Eigen::Index>(g)];
  }

  std::string name_;
  std::vector<std::vector<ValuePlace>> groups_;
  GenericFormula f_;
  Eigen::VectorXd weights_;
  std::vector<SecondPlace> second_places_;
  std::vector<Eigen::Index> slots_;  // of each pair of each group, in order
};

ConstraintRows rows_of(const std::vector<GenericRow>& rows) {
  const auto count = static_cast<Eigen::Index>(rows.size());
  ConstraintRows out{{}, Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const GenericRow& row = rows[static_cast<std::size_t>(i)];
    require_each_once(row.name, row.places);
    out.names.push_back(row.name);
    out.lower[i] = row.lower;
    out.upper[i] = row.upper;
  }
  return out;
}

std::vector<PartialPlace> places_of(const std::vector<GenericRow>& rows) {
  std::vector<PartialPlace> out;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const ValuePlace& place : rows[row].places) {
      out.push_back({static_cast<int>(row), place.field, place.step, place.index});
    }
  }
  return out;
}

class GenericConstraint final : public ConstraintTerm {
 public:
  explicit GenericConstraint(std::vector<GenericRow> rows)
      : ConstraintTerm(rows_of(rows), places_of(rows)), formulas_(std::move(rows)) {}

  void values(const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) const override {
    Eigen::Index row = 0;
    for (const GenericRow& formula : formulas_) {
      c[row++] = formula_value(formula.f, values, formula.places);
    }
  }

  void partials(const TrajectoryValues& values,
                Eigen::Ref<Eigen::VectorXd> partials) const override {
    Eigen::Index at = 0;
    for (const GenericRow& formula : formulas_) {
      formula_partials(formula.f, values, formula.places,
                       [&](std::size_t, double slope) { partials[at++] = slope; });
    }
  }

  [[nodiscard]] std::vector<SecondPlace> second_places() const override {
    std::vector<SecondPlace> out;
    for (std::size_t row = 0; row < formulas_.size(); ++row) {
      const std::vector<ValuePlace>& places = formulas_[row].places;
      for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
          out.push_back({static_cast<int>(row), places[i], places[j]});
        }
      }
    }
    return out;
  }

  void second_partials(const TrajectoryValues& values,
                       Eigen::Ref<Eigen::VectorXd> second) const override {
    Eigen::Index at = 0;
    for (const GenericRow& formula : formulas_) {
      formula_second_partials(
          formula.f, values, formula.places,
          [&](std::size_t, std::size_t, double cross) { second[at++] = cross; });
    }
  }

 private:
  std::vector<GenericRow> formulas_;
};

}  // namespace

TermPointer generic_term(std::string name, std::vector<ValuePlace> places, GenericFormula f) {
  return generic_sum(std::move(name), {std::move(places)}, std::move(f));
}

TermPointer generic_sum(std::string name, std::vector<std::vector<ValuePlace>> groups,
                        GenericFormula f, Eigen::VectorXd weights) {
  if (weights.size() != 0 && weights.size() != static_cast<Eigen::Index>(groups.size())) {
    throw InvalidInput(concat("generic_sum '", name, "': ", groups.size(), " groups and ",
                              weights.size(), " weights; there must be as many of each"));
  }
  for (const std::vector<ValuePlace>& group : groups) {
    require_each_once(name, group);
  }
  return std::make_shared<GenericSum>(std::move(name), std::move(groups), std::move(f),
                                      std::move(weights));
}

ConstraintPointer generic_constraint(std::vector<GenericRow> rows) {
  return std::make_shared<GenericConstraint>(std::move(rows));
}

ConstraintPointer generic_constraint(const ConstraintRows& rows,
                                     const std::vector<std::vector<ValuePlace>>& places,
                                     const GenericFormula& f) {
  if (rows.names.size() != places.size() || rows.lower.size() != rows.upper.size() ||
      static_cast<std::size_t>(rows.size()) != places.size()) {
    throw InvalidInput(concat("generic_constraint: ", rows.names.size(), " names, ", rows.size(),
                              " lower and ", rows.upper.size(), " upper bounds, and places of ",
                              places.size(), " rows; there must be as many of each"));
  }
  std::vector<GenericRow> out;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    out.push_back({rows.names[i], rows.lower[k], rows.upper[k], places[i], f});
  }
  return generic_constraint(std::move(out));
}

}  // namespace hbar
