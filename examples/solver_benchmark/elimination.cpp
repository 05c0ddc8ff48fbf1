#include "elimination.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <iterator>

namespace hbar::solver_benchmark {

std::vector<std::vector<int>> symbolic_factor(const solvers::SparseMatrix& A) {
  const auto n = static_cast<std::size_t>(A.cols());
  std::vector<std::vector<int>> columns(n);
  for (int j = 0; j < A.cols(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      const auto upper = static_cast<std::size_t>(std::min<Eigen::Index>(entry.row(), j));
      columns[upper].push_back(static_cast<int>(std::max<Eigen::Index>(entry.row(), j)));
    }
    columns[static_cast<std::size_t>(j)].push_back(j);
  }
  std::vector<int> merged;
  for (std::size_t j = 0; j < n; ++j) {
    // Children of j have joined it already: they are eliminated earlier.
    std::vector<int>& own = columns[j];
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    if (own.size() > 1) {
      std::vector<int>& parent = columns[static_cast<std::size_t>(own[1])];
      merged.assign(parent.begin(), parent.end());
      merged.insert(merged.end(), own.begin() + 1, own.end());
      std::sort(merged.begin(), merged.end());
      merged.erase(std::unique(merged.begin(), merged.end()), merged.end());
      parent = merged;
    }
  }
  return columns;
}

std::vector<int> minimum_degree_order(const solvers::SparseMatrix& A) {
  Eigen::AMDOrdering<int> amd;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  amd(A, permutation);
  return {permutation.indices().begin(), permutation.indices().end()};
}

solvers::SparseMatrix reordered(const solvers::SparseMatrix& A, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < A.cols(); ++j) {
    for (solvers::SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      entries.emplace_back(place[static_cast<std::size_t>(entry.row())],
                           place[static_cast<std::size_t>(j)], entry.value());
    }
  }
  solvers::SparseMatrix out(A.rows(), A.cols());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace hbar::solver_benchmark
