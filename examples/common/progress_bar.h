#pragma once

#include <cstddef>
#include <string>

namespace hbar::example {

/// "[#######-------------] 7/20 what comes next", cut to a width.
///
/// @param colour  with the terminal's colours, which take no width
[[nodiscard]] std::string bar_line(std::size_t done, std::size_t total, const std::string& next,
                                   std::size_t width, bool colour);

/// A line on standard error that shows how far a program is, if that is a terminal; else nothing.
/// With NO_COLOR set in the environment it is plain.
class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// Removes the line.
  ~ProgressBar();

  /// @param next  the next task
  void show(std::size_t done, std::size_t total, const std::string& next);

 private:
  bool terminal_ = false;
  bool colour_ = false;
  bool shown_ = false;
};

}  // namespace hbar::example
