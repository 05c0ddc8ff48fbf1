#pragma once

#include <mutex>

namespace hbar::solvers {

/// What holds MUMPS, which has global variables, for one thread. Ipopt calls the same MUMPS: it
/// holds this during an optimisation, but for the callbacks.
[[nodiscard]] std::mutex& mumps_mutex();

/// Gives a lock back for as long as it lives.
class Unlocked {
 public:
  explicit Unlocked(std::unique_lock<std::mutex>& lock) : lock_(lock) { lock_.unlock(); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked() { lock_.lock(); }

 private:
  std::unique_lock<std::mutex>& lock_;
};

}  // namespace hbar::solvers
