#include "hbar/adjoint/trajectory/timeline.h"

#include <algorithm>

namespace hbar {

Timeline::Timeline() : stages_(1), step_ends_{0}, ends_{{0, 0.0}} {}

void Timeline::reserve(int stages, int steps) {
  stages_.reserve(static_cast<std::size_t>(stages));
  ends_.reserve(static_cast<std::size_t>(stages));
  step_ends_.reserve(static_cast<std::size_t>(steps) + 1);
}

void Timeline::append(const Integrator& integrator, int step, double h) {
  const std::size_t equal_steps = ends_.back().h == h ? 2 : 1;
  const Integrator& method = static_cast<std::size_t>(integrator.history) <= equal_steps
                                 ? integrator
                                 : find_integrator(integrator.starter);
  const int start = ends_.back().stage;
  const double start_time = stage(start).time;
  const int first = stage_count();
  for (const IntegratorStage& row : method.stages) {
    Stage next;
    next.step = step;
    next.time = start_time + row.time * h;
    next.rate = row.own / h;
    next.start = start;
    const auto look_back = [&](int at, double weight) {
      next.history[static_cast<std::size_t>(next.history_size++)] = {at, weight / h};
    };
    for (std::size_t i = 0; i < row.earlier.size(); ++i) {
      look_back(first + static_cast<int>(i), row.earlier[i]);
    }
    for (std::size_t i = 0; i < row.step_ends.size(); ++i) {
      look_back(ends_[ends_.size() - 1 - i].stage, row.step_ends[i]);
    }
    stages_.push_back(next);
  }
  ends_.push_back({last_stage(), h});
}

void Timeline::truncate(int stages) {
  stages_.resize(static_cast<std::size_t>(stages));
  while (ends_.back().stage >= stages) {
    ends_.pop_back();
  }
  while (step_ends_.back() >= stages) {
    step_ends_.pop_back();
  }
}

Timeline even_timeline(const Integrator& integrator, double h, int steps,
                       const std::vector<int>& restarts) {
  Timeline out;
  for (int step = 0; step < steps; ++step) {
    if (std::find(restarts.begin(), restarts.end(), step) != restarts.end()) {
      out.restart();
    }
    out.append(integrator, step, h);
    out.end_step();
  }
  return out;
}

}  // namespace hbar
