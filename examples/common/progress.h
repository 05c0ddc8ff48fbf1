#pragma once

#include <string>
#include <vector>

#include "hbar/solvers/nlp/ipopt.h"

namespace hbar::example {

/// One iterate on one line of at most 80 characters, without the line end.
[[nodiscard]] std::string progress_line(const solvers::IterationInfo& info);

/// The heading of progress_line's columns.
[[nodiscard]] std::string progress_heading();

/// A line per iterate; on a terminal one line that is overwritten, and kept every tenth time.
class Progress {
 public:
  Progress();
  void show(const solvers::IterationInfo& info);
  void end() const;
  /// All iterates shown.
  [[nodiscard]] const std::vector<solvers::IterationInfo>& iterations() const {
    return iterations_;
  }

 private:
  bool terminal_ = false;
  std::vector<solvers::IterationInfo> iterations_;
};

/// A row per iterate.
[[nodiscard]] std::string iterations_csv(const std::vector<solvers::IterationInfo>& iterations);

}  // namespace hbar::example
