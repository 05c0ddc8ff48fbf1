#include "hbar/solvers/linear/block_banded.h"

#include <Eigen/Dense>
#include <algorithm>
#include <new>
#include <numeric>
#include <utility>

#include "hbar/solvers/linear/band.h"
#include "hbar/solvers/linear/row_scaling.h"

namespace hbar::solvers {
namespace {

using Panel = Eigen::Map<Eigen::MatrixXd>;

/// LU of a tall panel in place, rows interchanged for the largest pivot; halves of the columns at a
/// time, so that most work is in products of matrices.
///
/// @param swaps  row that was interchanged with each pivot's  [columns]
void factorize_panel(MatrixSpan panel, int* swaps) {
  const Eigen::Index rows = panel.rows();
  const Eigen::Index columns = panel.cols();
  if (columns <= 8) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      Eigen::Index best = 0;
      panel.col(j).tail(rows - j).cwiseAbs().maxCoeff(&best);
      best += j;
      swaps[j] = static_cast<int>(best);
      if (best != j) {
        panel.row(j).swap(panel.row(best));
      }
      // A pivot of zero has zeros below it, and is detected at the end.
      if (panel(j, j) != 0.0) {
        panel.col(j).tail(rows - j - 1) /= panel(j, j);
      }
      panel.bottomRightCorner(rows - j - 1, columns - j - 1).noalias() -=
          panel.col(j).tail(rows - j - 1) * panel.row(j).tail(columns - j - 1);
    }
    return;
  }
  const Eigen::Index half = columns / 2;
  auto left = panel.leftCols(half);
  auto right = panel.rightCols(columns - half);
  factorize_panel(left, swaps);
  for (Eigen::Index j = 0; j < half; ++j) {
    if (swaps[j] != j) {
      right.row(j).swap(right.row(swaps[j]));
    }
  }
  auto top = right.topRows(half);
  left.topRows(half).triangularView<Eigen::UnitLower>().solveInPlace(top);
  auto bottom = right.bottomRows(rows - half);
  bottom.noalias() -= left.bottomRows(rows - half) * top;
  factorize_panel(bottom, swaps + half);
  for (Eigen::Index j = half; j < columns; ++j) {
    swaps[j] += static_cast<int>(half);
    if (swaps[j] != j) {
      left.row(j).swap(left.row(swaps[j]));
    }
  }
}

class BlockBanded final : public LinearSolver {
 public:
  explicit BlockBanded(std::vector<int> block_sizes) : block_sizes_(std::move(block_sizes)) {
    for (std::size_t b = 0; b < block_sizes_.size(); ++b) {
      if (block_sizes_[b] > 0) {
        continue;
      }
      throw InvalidInput(concat("block_banded: block ", b, " has size ", block_sizes_[b],
                                "; expected a positive number"));
    }
  }

  [[nodiscard]] std::string name() const override { return "block_banded"; }
  [[nodiscard]] FactorInfo factor_info() const override {
    const double entries = static_cast<double>(factors_.size());
    return {.entries = entries,
            .bytes = 8.0 * entries + 28.0 * static_cast<double>(size()),
            .flops = flops_,
            .inertia = {}};
  }

 private:
  /// One block column: rows first_row to end_row of it are kept, in columns begin to end.
  struct Column {
    int begin = 0;
    int end = 0;
    int first_row = 0;
    int end_row = 0;
    std::size_t offset = 0;  ///< of its panel in factors_

    [[nodiscard]] int size() const { return end - begin; }
    [[nodiscard]] int above() const { return begin - first_row; }
    [[nodiscard]] int height() const { return end_row - first_row; }
  };

  void do_analyze() override;
  void do_factorize() override;
  void do_solve(System system, MatrixSpan X) override;
  void place_blocks();
  void outline();
  void fill_panel(const Column& column, Panel panel) const;
  void eliminate(const Column& earlier, const Column& column, Panel panel);
  template <typename Solutions>
  void substitute(Solutions& X);
  template <typename Solutions>
  void substitute_transposed(Solutions& X);
  template <typename Solutions>
  void interchange(const Column& column, Solutions X, int first_row) const;
  [[nodiscard]] Panel panel_of(const Column& column) {
    return {factors_.data() + column.offset, column.height(), column.size()};
  }

  std::vector<int> block_sizes_;  // as asked for
  std::vector<Column> columns_;
  std::vector<double> factors_;  // panels, one after the other
  std::vector<int> swaps_;       // row interchanged with each row, in order  [n]
  std::vector<int> row_of_;      // row of A of each pivot                    [n]
  std::vector<int> column_of_;   // column of A of each pivot: its own        [n]
  std::vector<double> pivots_;
  Eigen::VectorXd scale_;  // rows are multiplied by this
  double flops_ = 0.0;
};

/// Blocks as requested, or of one size: a quarter of the bandwidth keeps the ragged edge of the
/// band small relative to the band, and matrix products large enough to be fast.
void BlockBanded::place_blocks() {
  std::vector<int> sizes = block_sizes_;
  if (sizes.empty()) {
    const int block = std::clamp(band_of(matrix()).width() / 4, 4, 48);
    for (int row = 0; row < size(); row += block) {
      sizes.push_back(std::min(block, size() - row));
    }
  }
  columns_.assign(sizes.size(), {});
  int begin = 0;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    columns_[b].begin = begin;
    begin += sizes[b];
    columns_[b].end = begin;
  }
  if (begin != size()) {
    throw InvalidInput(concat("block_banded: analyze: the blocks have ", begin,
                              " rows in all, the matrix has ", size()));
  }
}

/// Which rows of each block column the factors fill. Rows of block column k are interchanged down
/// to its last one, so whatever has entries there can get some from row k on.
void BlockBanded::outline() {
  std::vector<int> first(columns_.size());
  int lowest = 0;
  for (std::size_t b = 0; b < columns_.size(); ++b) {
    Column& column = columns_[b];
    first[b] = column.begin;
    lowest = std::max(lowest, column.end);
    for (int j = column.begin; j < column.end; ++j) {
      const int* rows = matrix().innerIndexPtr();
      first[b] = std::min(first[b], rows[matrix().outerIndexPtr()[j]]);
      lowest = std::max(lowest, rows[matrix().outerIndexPtr()[j + 1] - 1] + 1);
    }
    column.end_row = lowest;
  }
  std::size_t offset = 0;
  double bytes = 0.0;
  for (std::size_t b = 0; b < columns_.size(); ++b) {
    const auto reaches = [&](const Column& column) { return column.end_row <= first[b]; };
    columns_[b].first_row = std::partition_point(columns_.begin(), columns_.end(), reaches)->begin;
    columns_[b].offset = offset;
    const double entries = static_cast<double>(columns_[b].height()) * columns_[b].size();
    offset += static_cast<std::size_t>(entries);
    bytes += 8.0 * entries;
  }
  refuse_wide_band(name(), matrix(), bytes);
  factors_.clear();
  factors_.resize(offset);
}

void BlockBanded::do_analyze() {
  try {
    place_blocks();
    outline();
    const auto n = static_cast<std::size_t>(size());
    swaps_.resize(n);
    row_of_.resize(n);
    column_of_.resize(n);
    pivots_.resize(n);
    scale_.resize(size());
    std::iota(column_of_.begin(), column_of_.end(), 0);
  } catch (const std::bad_alloc&) {
    throw_out_of_memory("analyze");
  }
}

/// A block column of A, its rows scaled.
void BlockBanded::fill_panel(const Column& column, Panel panel) const {
  panel.setZero();
  for (int j = column.begin; j < column.end; ++j) {
    for (int k = matrix().outerIndexPtr()[j]; k < matrix().outerIndexPtr()[j + 1]; ++k) {
      const int row = matrix().innerIndexPtr()[k];
      panel(row - column.first_row, j - column.begin) = matrix().valuePtr()[k] * scale_[row];
    }
  }
}

/// Interchanges rows of X, whose first one is first_row, as the pivots of a block column did.
template <typename Solutions>
void BlockBanded::interchange(const Column& column, Solutions X, int first_row) const {
  for (int i = column.begin; i < column.end; ++i) {
    const int other = swaps_[static_cast<std::size_t>(i)];
    if (other != i) {
      X.row(i - first_row).swap(X.row(other - first_row));
    }
  }
}

/// Applies the elimination of an earlier block column to a later one.
void BlockBanded::eliminate(const Column& earlier, const Column& column, Panel panel) {
  interchange<Panel&>(earlier, panel, column.first_row);
  auto U = panel.middleRows(earlier.begin - column.first_row, earlier.size());
  if ((U.array() == 0.0).all()) {
    return;
  }
  const Panel factors = panel_of(earlier);
  const auto L = factors.middleRows(earlier.above(), earlier.size());
  L.triangularView<Eigen::UnitLower>().solveInPlace(U);
  const int below = earlier.end_row - earlier.end;
  panel.middleRows(earlier.end - column.first_row, below).noalias() -=
      factors.bottomRows(below) * U;
  const double products = static_cast<double>(earlier.size()) * column.size();
  flops_ += products * (earlier.size() - 1.0 + 2.0 * below);
}

void BlockBanded::do_factorize() {
  set_power_of_two_scales(row_scale(), scale_);
  std::iota(row_of_.begin(), row_of_.end(), 0);
  flops_ = 0.0;
  std::size_t first = 0;
  for (std::size_t b = 0; b < columns_.size(); ++b) {
    const Column& column = columns_[b];
    Panel panel = panel_of(column);
    fill_panel(column, panel);
    while (columns_[first].begin < column.first_row) {
      ++first;
    }
    for (std::size_t k = first; k < b; ++k) {
      eliminate(columns_[k], column, panel);
    }
    int* swaps = swaps_.data() + column.begin;
    factorize_panel(panel.bottomRows(column.height() - column.above()), swaps);
    for (int i = 0; i < column.size(); ++i) {
      swaps[i] += column.begin;
      std::swap(row_of_[static_cast<std::size_t>(column.begin + i)],
                row_of_[static_cast<std::size_t>(swaps[i])]);
      pivots_[static_cast<std::size_t>(column.begin + i)] = panel(column.above() + i, i);
    }
    const double m = column.end_row - column.begin;
    const double n = column.size();
    flops_ += n * n * (m - n / 3.0);
  }
  const int small = find_small_pivot(pivots_, column_of_);
  if (small >= 0) {
    const auto k = static_cast<std::size_t>(small);
    throw_singular(row_of_[k], small, pivots_[k]);
  }
}

template <typename Solutions>
void BlockBanded::substitute(Solutions& X) {
  X = scale_.asDiagonal() * X;
  for (const Column& column : columns_) {
    interchange<Solutions&>(column, X, 0);
    auto X_b = X.middleRows(column.begin, column.size());
    if ((X_b.array() == 0.0).all()) {
      continue;
    }
    const Panel panel = panel_of(column);
    const int below = column.end_row - column.end;
    panel.middleRows(column.above(), column.size())
        .template triangularView<Eigen::UnitLower>()
        .solveInPlace(X_b);
    X.middleRows(column.end, below).noalias() -= panel.bottomRows(below) * X_b;
  }
  for (auto column = columns_.rbegin(); column != columns_.rend(); ++column) {
    const Panel panel = panel_of(*column);
    auto X_b = X.middleRows(column->begin, column->size());
    panel.middleRows(column->above(), column->size())
        .template triangularView<Eigen::Upper>()
        .solveInPlace(X_b);
    X.middleRows(column->first_row, column->above()).noalias() -=
        panel.topRows(column->above()) * X_b;
  }
}

template <typename Solutions>
void BlockBanded::substitute_transposed(Solutions& X) {
  for (const Column& column : columns_) {
    const Panel panel = panel_of(column);
    auto X_b = X.middleRows(column.begin, column.size());
    X_b.noalias() -=
        panel.topRows(column.above()).transpose() * X.middleRows(column.first_row, column.above());
    if ((X_b.array() == 0.0).all()) {
      continue;
    }
    panel.middleRows(column.above(), column.size())
        .template triangularView<Eigen::Upper>()
        .transpose()
        .solveInPlace(X_b);
  }
  for (auto column = columns_.rbegin(); column != columns_.rend(); ++column) {
    const Panel panel = panel_of(*column);
    auto X_b = X.middleRows(column->begin, column->size());
    const int below = column->end_row - column->end;
    X_b.noalias() -= panel.bottomRows(below).transpose() * X.middleRows(column->end, below);
    panel.middleRows(column->above(), column->size())
        .template triangularView<Eigen::UnitLower>()
        .transpose()
        .solveInPlace(X_b);
    for (int i = column->end - 1; i >= column->begin; --i) {
      const int other = swaps_[static_cast<std::size_t>(i)];
      if (other != i) {
        X.row(i).swap(X.row(other));
      }
    }
  }
  X = scale_.asDiagonal() * X;
}

void BlockBanded::do_solve(System system, MatrixSpan X) {
  const auto solve_in_place = [&](auto solutions) {
    if (system == System::kPlain) {
      substitute(solutions);
    } else {
      substitute_transposed(solutions);
    }
  };
  // One column takes Eigen's faster path for vectors.
  if (X.cols() == 1) {
    solve_in_place(Eigen::Ref<Eigen::VectorXd>(X.col(0)));
  } else if (X.cols() > 1) {
    solve_in_place(X);
  }
}

}  // namespace

std::unique_ptr<LinearSolver> make_block_banded(const SolverOptions& options) {
  refuse_other_orderings("block_banded", options.ordering,
                         {Ordering::kDefault, Ordering::kNatural});
  return std::make_unique<BlockBanded>(options.block_sizes);
}

}  // namespace hbar::solvers
