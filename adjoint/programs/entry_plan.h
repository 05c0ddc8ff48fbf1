#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

#include "hbar/solvers/nlp/nlp.h"

namespace hbar {

/// A sparse matrix to which contributions are added in an order that never changes. Set up once by
/// add(), entry by entry in that order; then filled any number of times by put(), without a search.
class EntryPlan {
 public:
  /// Declares a contribution to this place.
  void add(Eigen::Index row, Eigen::Index column) {
    added_.emplace_back(static_cast<int>(column), static_cast<int>(row));
  }
  /// The same for the lower triangle of a symmetric matrix: (row, column) in either order.
  void add_lower(Eigen::Index a, Eigen::Index b) { add(std::max(a, b), std::min(a, b)); }

  /// Ends the set-up: lists each place once, column by column.
  void finish() {
    std::vector<std::pair<int, int>> places = added_;
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    slots_.clear();
    for (const auto& place : added_) {
      slots_.push_back(
          static_cast<int>(std::lower_bound(places.begin(), places.end(), place) - places.begin()));
    }
    for (const auto& [column, row] : places) {
      pattern_.rows.push_back(row);
      pattern_.columns.push_back(column);
    }
    added_.clear();
    added_.shrink_to_fit();
  }
  [[nodiscard]] const solvers::SparsityPattern& pattern() const { return pattern_; }

  /// Starts filling: `values` gets one zero per place.
  void begin(Eigen::VectorXd& values) {
    values.setZero(static_cast<Eigen::Index>(pattern_.rows.size()));
    values_ = &values;
    next_ = 0;
  }
  /// The next contribution, in the order of add().
  void put(double value) { (*values_)[slots_[next_++]] += value; }
  /// Whether all contributions have been put.
  [[nodiscard]] bool is_full() const { return next_ == slots_.size(); }

 private:
  std::vector<std::pair<int, int>> added_;  // (column, row)
  std::vector<int> slots_;
  solvers::SparsityPattern pattern_;
  Eigen::VectorXd* values_ = nullptr;
  std::size_t next_ = 0;
};

}  // namespace hbar
