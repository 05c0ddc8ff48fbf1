#include "hbar/adjoint/terms/check_terms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "hbar/adjoint/terms/value_access.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// One entry of a row's matrix of second partials, by numbers of places.
struct SecondEntry {
  int row = 0;
  Index a = 0;
  Index b = 0;
  double value = 0.0;
};

/// Where a partial stands: a row of the term, and the number of a place.
struct PartialEntry {
  int row = 0;
  Index number = 0;
  friend auto operator<=>(const PartialEntry&, const PartialEntry&) = default;
};

/// A term of either kind as rows of all numbers of the values.
struct TermRows {
  std::vector<std::string> names;
  std::vector<PartialEntry> entries;                               // of its partials
  std::function<VectorXd(const TrajectoryValues&)> values;         // [rows]
  std::function<VectorXd(const TrajectoryValues&)> partials;       // [entries]
  std::function<std::vector<SecondPlace>()> second_places;         // may throw InvalidInput
  std::function<VectorXd(const TrajectoryValues&, Index)> second;  // [count]
};

/// NaN, so that numbers that were not written show up.
VectorXd unwritten(Index count) {
  return VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN());
}

/// The number of a place in all_places(shape).
Index number_of(const TrajectoryValues& shape, const ValuePlace& place) {
  static_cast<void>(value_at(shape, place));  // refuses a place that is not there
  Index first = 0;
  for (int field = 0; field < static_cast<int>(place.field); ++field) {
    const auto before = static_cast<ValueField>(field);
    first += field_rows(shape, before) * field_columns(shape, before);
  }
  const Index column = place.field == ValueField::kP ? 0 : place.step;
  return first + column * field_rows(shape, place.field) + place.index;
}

class TermChecker {
 public:
  TermChecker(TermRows rows, const TrajectoryValues& at)
      : rows_(std::move(rows)), at_(at), places_(all_places(at)), scale_(scales()) {}

  TermCheck check() {
    const VectorXd partials = rows_.partials(at_);
    jacobian_.setZero(static_cast<Index>(rows_.names.size()), count());
    for (Index k = 0; k < partials.size(); ++k) {
      const PartialEntry& entry = rows_.entries[static_cast<std::size_t>(k)];
      jacobian_(entry.row, entry.number) += partials[k] * scale_[entry.number];
    }
    norms_ = jacobian_.rowwise().norm().unaryExpr([](double x) { return x == 0.0 ? 1.0 : x; });
    for (Index i = 0; i < count(); ++i) {
      const Difference expected = difference(i, rows_.values, norms_);
      for (Index row = 0; row < norms_.size(); ++row) {
        const double gap = std::abs(expected.value[row] - jacobian_(row, i)) / norms_[row];
        if (!is_unresolved(gap, expected.error[row] / norms_[row])) {
          note(gap, out_.gap, out_.gap_name,
               [&] { return concat(row_name(row), " by ", name(i)); });
        }
      }
    }
    read_second_places();
    if (out_.has_second) {
      check_second();
    }
    check_slopes();
    return out_;
  }

 private:
  [[nodiscard]] Index count() const { return static_cast<Index>(places_.size()); }
  [[nodiscard]] std::string name(Index i) const {
    return place_name(places_[static_cast<std::size_t>(i)]);
  }
  [[nodiscard]] const std::string& row_name(Index row) const {
    return rows_.names[static_cast<std::size_t>(row)];
  }

  /// Typical sizes of the numbers: a row's largest over time.
  [[nodiscard]] VectorXd scales() const {
    VectorXd out(count());
    for (Index i = 0; i < count(); ++i) {
      ValuePlace place = places_[static_cast<std::size_t>(i)];
      double largest = 0.0;
      for (place.step = 0; place.step < field_columns(at_, place.field); ++place.step) {
        largest = std::max(largest, std::abs(value_at(at_, place)));
      }
      out[i] = largest > 0.0 ? largest : 1.0;
    }
    return out;
  }

  template <typename Name>
  static void note(double gap, double& worst, std::string& worst_name, const Name& name) {
    // The first of equals; a gap of NaN stays.
    if (!std::isnan(worst) && !(gap <= worst * (1.0 + 1e-6))) {
      worst = gap;
      worst_name = name();
    }
  }

  /// Derivatives by differences, each with an estimate of its error.
  struct Difference {
    VectorXd value;
    VectorXd error;
  };

  /// With respect to number i in units of its scale: central, extrapolated once. Terms that
  /// saturate or grow fast need smaller steps than others: for each entry, the step counts whose
  /// result changes least with the next.
  ///
  /// @param norms  of the rows that f's entries belong to
  template <typename Function>
  [[nodiscard]] Difference difference(Index i, const Function& f, const VectorXd& norms) const {
    constexpr int kSteps = 7;
    constexpr double kLargest = 1e-3;
    constexpr double kRatio = 8.0;
    constexpr double kEnough = 1e-10;  // of an error, relative to the row
    const auto central = [&](double step) {
      TrajectoryValues ahead = at_;
      TrajectoryValues behind = at_;
      value_at(ahead, places_[static_cast<std::size_t>(i)]) += step * scale_[i];
      value_at(behind, places_[static_cast<std::size_t>(i)]) -= step * scale_[i];
      return VectorXd((f(ahead) - f(behind)) / (2.0 * step));
    };
    const auto extrapolated = [&](double step) {
      return VectorXd((4.0 * central(0.5 * step) - central(step)) / 3.0);
    };
    double step = kLargest;
    VectorXd last = extrapolated(step);
    Difference best{last, VectorXd::Constant(last.size(), std::numeric_limits<double>::infinity())};
    for (int k = 1; k < kSteps && !(best.error.array() <= kEnough * norms.array()).all(); ++k) {
      step /= kRatio;
      const VectorXd next = extrapolated(step);
      for (Index entry = 0; entry < next.size(); ++entry) {
        const double change = std::abs(next[entry] - last[entry]);
        if (change < best.error[entry]) {
          best.error[entry] = change;
          best.value[entry] = next[entry];
        }
      }
      last = next;
    }
    return best;
  }

  /// Counts a difference that is too coarse to tell, instead of its gap.
  [[nodiscard]] bool is_unresolved(double gap, double error) {
    constexpr double kCoarse = 1e-7;
    const bool coarse = error > kCoarse && gap <= 10.0 * error;
    out_.unresolved += coarse ? 1 : 0;
    return coarse;
  }

  /// Fills second_ with scaled entries, and counts what is repeated and idle.
  void read_second_places() {
    std::vector<SecondPlace> places;
    try {
      places = rows_.second_places();
    } catch (const InvalidInput&) {
      return;  // the term says that it has none
    }
    out_.has_second = true;
    const VectorXd values = rows_.second(at_, static_cast<Index>(places.size()));
    std::set<std::tuple<int, Index, Index>> known;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].row < 0 || places[k].row >= norms_.size()) {
        throw InvalidInput(concat("a second place names row ", places[k].row, "; there are ",
                                  norms_.size(), " rows"));
      }
      const Index a = number_of(at_, places[k].a);
      const Index b = number_of(at_, places[k].b);
      const double value = values[static_cast<Index>(k)];
      second_.push_back({places[k].row, a, b, value * scale_[a] * scale_[b]});
      out_.idle += value == 0.0 ? 1 : 0;
      out_.repeated += known.emplace(places[k].row, std::min(a, b), std::max(a, b)).second ? 0 : 1;
    }
  }

  void check_second() {
    VectorXd squares = VectorXd::Zero(norms_.size());
    for (const SecondEntry& entry : second_) {
      squares[entry.row] += (entry.a == entry.b ? 1.0 : 2.0) * entry.value * entry.value;
    }
    VectorXd norms(static_cast<Index>(rows_.entries.size()));
    for (Index k = 0; k < norms.size(); ++k) {
      norms[k] = norms_[rows_.entries[static_cast<std::size_t>(k)].row];
    }
    for (Index i = 0; i < count(); ++i) {
      for (const auto& [place, gap] : second_gaps(i, difference(i, rows_.partials, norms))) {
        const int row = place.row;
        const Index j = place.number;
        // Curvature that no difference of the partials can show counts as none.
        const double norm = squares[row] == 0.0
                                ? norms_[row]
                                : std::max(std::sqrt(squares[row]), 1e-6 * norms_[row]);
        const double share = std::abs(gap.value) / norm;
        if (!is_unresolved(share, gap.error / norm)) {
          note(share, out_.second_gap, out_.second_gap_name,
               [&] { return concat(row_name(row), " by ", name(i), " and ", name(j)); });
        }
      }
    }
  }

  /// How far second partials with number i are from differences, wherever there are any.
  struct Gap {
    double value = 0.0;
    double error = 0.0;
  };
  [[nodiscard]] std::map<PartialEntry, Gap> second_gaps(Index i,
                                                        const Difference& differences) const {
    std::map<PartialEntry, Gap> out;
    for (Index k = 0; k < differences.value.size(); ++k) {
      const PartialEntry& entry = rows_.entries[static_cast<std::size_t>(k)];
      Gap& gap = out[entry];
      gap.value += differences.value[k] * scale_[entry.number];
      gap.error += differences.error[k] * scale_[entry.number];
    }
    for (const SecondEntry& entry : second_) {
      if (entry.a == i) {
        out[{entry.row, entry.b}].value -= entry.value;
      } else if (entry.b == i) {
        out[{entry.row, entry.a}].value -= entry.value;
      }
    }
    return out;
  }

  /// The order of a remainder where ε is smallest and rounding does not count yet; infinite if it
  /// always does. Where the remainder vanishes in rounding within a step, it fell by so much at
  /// least.
  template <typename Remainder>
  [[nodiscard]] static double slope_of(const Remainder& remainder, double rounding) {
    constexpr int kSteps = 13;  // half decades from 1e-2
    constexpr double kDecades = 0.5;
    const double smallest = 30.0 * rounding;
    double slope = std::numeric_limits<double>::infinity();
    double last = remainder(1e-2);
    for (int k = 1; k < kSteps && last > smallest; ++k) {
      const double next = remainder(1e-2 * std::pow(10.0, -kDecades * k));
      const double order = std::log10(last / std::max(next, smallest)) / kDecades;
      slope = next > smallest || std::isinf(slope) ? order : std::max(slope, order);
      last = next;
    }
    return slope;
  }

  void check_slopes() {
    VectorXd direction(count());
    for (Index i = 0; i < count(); ++i) {
      direction[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
    }
    const VectorXd c = rows_.values(at_);
    const VectorXd first = jacobian_ * direction;
    VectorXd second = VectorXd::Zero(c.size());
    for (const SecondEntry& entry : second_) {
      second[entry.row] +=
          (entry.a == entry.b ? 0.5 : 1.0) * entry.value * direction[entry.a] * direction[entry.b];
    }
    const double rounding = 1e-13 * (1.0 + c.cwiseQuotient(norms_).norm());
    const auto order = [&](double quadratic) {
      const auto remainder = [&](double e) {
        TrajectoryValues moved = at_;
        for (Index i = 0; i < count(); ++i) {
          value_at(moved, places_[static_cast<std::size_t>(i)]) += e * scale_[i] * direction[i];
        }
        return (rows_.values(moved) - c - e * first - quadratic * e * e * second)
            .cwiseQuotient(norms_)
            .norm();
      };
      return slope_of(remainder, rounding);
    };
    out_.slope = order(0.0);
    if (out_.has_second) {
      out_.second_slope = order(1.0);
    }
  }

  TermRows rows_;
  const TrajectoryValues& at_;
  std::vector<ValuePlace> places_;
  VectorXd scale_;                   // of each number
  MatrixXd jacobian_;                // in units of the scale
  VectorXd norms_;                   // of its rows
  std::vector<SecondEntry> second_;  // in units of the scale
  TermCheck out_;
};

/// All partials in the order of all_places.
VectorXd flat(const TrajectoryPartials& partials) {
  VectorXd out(partials.q.size() + partials.qdot.size() + partials.measured.size() +
               partials.u.size() + partials.p.size());
  out << partials.q.reshaped(), partials.qdot.reshaped(), partials.measured.reshaped(),
      partials.u.reshaped(), partials.p;
  return out;
}

}  // namespace

bool TermCheck::passed() const {
  constexpr double kBound = 1e-6;
  const bool first = gap < kBound && slope >= 1.9;
  return first && (!has_second || (second_gap < kBound && second_slope >= 2.9 && repeated == 0));
}

TermCheck check_objective_term(const ObjectiveTerm& term, const TrajectoryValues& values) {
  TermRows rows;
  rows.names = {term.name()};
  rows.values = [&](const TrajectoryValues& at) { return VectorXd::Constant(1, term.value(at)); };
  for (Index number = 0; number < static_cast<Index>(all_places(values).size()); ++number) {
    rows.entries.push_back({0, number});
  }
  rows.partials = [&](const TrajectoryValues& at) {
    TrajectoryPartials partials(at);
    term.add_partials(at, partials);
    return flat(partials);
  };
  rows.second_places = [&] { return term.second_places(values); };
  rows.second = [&](const TrajectoryValues& at, Index count) {
    VectorXd second = unwritten(count);
    term.second_partials(at, second);
    return second;
  };
  return TermChecker(std::move(rows), values).check();
}

TermCheck check_constraint_term(const ConstraintTerm& term, const TrajectoryValues& values) {
  TermRows rows;
  rows.names = term.rows().names;
  rows.values = [&](const TrajectoryValues& at) {
    VectorXd c = unwritten(term.rows().size());
    term.values(at, c);
    return c;
  };
  for (const PartialPlace& place : term.places()) {
    rows.entries.push_back({place.row, number_of(values, place.place())});
  }
  rows.partials = [&](const TrajectoryValues& at) {
    VectorXd partials = unwritten(static_cast<Index>(term.places().size()));
    term.partials(at, partials);
    return partials;
  };
  rows.second_places = [&] { return term.second_places(); };
  rows.second = [&](const TrajectoryValues& at, Index count) {
    VectorXd second = unwritten(count);
    term.second_partials(at, second);
    return second;
  };
  return TermChecker(std::move(rows), values).check();
}

}  // namespace hbar
