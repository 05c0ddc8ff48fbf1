#include "progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace hbar::example {
namespace {

constexpr std::size_t kBar = 20;

std::size_t terminal_width() {
  winsize size = {};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  return no_colour == nullptr || *no_colour == '\0';
}

}  // namespace

std::string bar_line(std::size_t done, std::size_t total, const std::string& next,
                     std::size_t width, bool colour) {
  const std::size_t filled = total == 0 ? 0 : kBar * std::min(done, total) / total;
  const std::string rest = "] " + std::to_string(done) + "/" + std::to_string(total) + " " + next;
  const std::size_t room = width > kBar + 1 ? width - kBar - 1 : 0;
  return std::string("[") + (colour ? "\033[32m" : "") + std::string(filled, '#') +
         (colour ? "\033[0m" : "") + std::string(kBar - filled, '-') + rest.substr(0, room);
}

ProgressBar::ProgressBar()
    : terminal_(::isatty(STDERR_FILENO) == 1), colour_(terminal_ && colour_wanted()) {}

ProgressBar::~ProgressBar() {
  if (shown_) {
    static_cast<void>(std::fputs("\r\033[K", stderr));
  }
}

void ProgressBar::show(std::size_t done, std::size_t total, const std::string& next) {
  if (terminal_) {
    shown_ = true;
    const std::string line =
        "\r\033[K" + bar_line(done, total, next, terminal_width() - 1, colour_);
    static_cast<void>(std::fputs(line.c_str(), stderr));
    static_cast<void>(std::fflush(stderr));
  }
}

}  // namespace hbar::example
